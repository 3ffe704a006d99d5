"""Worker processes of one kind, kept alive, each at one task at a time."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from typing import Any, TypeVar, cast

from .failures import DeadlineExceeded, OutOfMemory
from .process import WorkerProcess
from .stopwatch import Observer, Stopwatch, ignore
from .worker import Limits

T = TypeVar("T")
logger = logging.getLogger(__name__)

RESPITE = 0.1  # s until a worker that died by itself is replaced, lest it dies again and again
RETRY = 1.0  # s until it is tried again where none could be started


class WorkerPool:
    """Some processes of one kind.

    Workers are forked from a server process that has imported and compiled everything
    (`preload`), so one that was given up is replaced within milliseconds. `spares` are further
    processes that take over meanwhile, and that serve others where one client has all workers.
    """

    def __init__(self, name: str, workers: int, limits: Limits, spares: int = 0) -> None:
        self.name = name
        self.workers = workers
        self.spares = spares
        self.deaths = 0
        self.observe: Observer = ignore
        self.prepared = asyncio.Event()  # set when the first worker is there, or cannot be
        self._processes = workers + spares
        self._limits = limits
        # The one that worked last works next: what it needs is still in the processor's cache.
        self._idle: asyncio.LifoQueue[WorkerProcess] = asyncio.LifoQueue()
        self._keepers: list[asyncio.Task[None]] = []

    async def start(self) -> None:
        """Start the workers, without waiting for them, and keep them alive until `stop`.

        The first task starts them too.
        """
        self._keepers = [asyncio.create_task(self._keep_one()) for _ in range(self._processes)]

    async def stop(self) -> None:
        """Kill the workers."""
        for keeper in self._keepers:
            keeper.cancel()
        await asyncio.gather(*self._keepers, return_exceptions=True)

    async def run(self, function: Callable[..., T], *args: Any, deadline: float) -> T:
        """Carry out `function(*args)` in a worker; cancelling the caller kills that worker.

        Raises:
            DeadlineExceeded: After `deadline` [s], counted from when there are workers.
            WorkerDied: If the process is gone.
            OutOfMemory: If it needs more memory than a worker may have.
            Exception: Whatever the function raises.
        """
        if not self._keepers:
            await self.start()
        watch = Stopwatch()
        with watch.measured(self.observe):
            return await self._run(watch, function, *args, deadline=deadline)

    async def _run(
        self, watch: Stopwatch, function: Callable[..., T], *args: Any, deadline: float
    ) -> T:
        await self.prepared.wait()  # compiling may take minutes, which are no fault of the task's
        try:
            async with asyncio.timeout(deadline):
                worker = await self._ready()
                watch.start()
                full = False
                try:
                    returned, outcome = await worker.ask(function, *args)
                    full = isinstance(outcome, MemoryError)
                finally:
                    self._let_go(worker, full)
        except TimeoutError:
            raise DeadlineExceeded(f"stopped after {deadline:g} s, the longest allowed") from None
        if full:
            raise OutOfMemory(self._limits.memory) from outcome
        if not returned:
            raise outcome
        return cast(T, outcome)

    async def _ready(self) -> WorkerProcess:
        while True:
            worker = await self._idle.get()
            if not worker.gone.is_set():
                return worker

    def _let_go(self, worker: WorkerProcess, full: bool) -> None:
        """Ready for the next task; one that was full may be in pieces, and a new one is at hand."""
        if worker.busy or full:
            worker.kill()
        elif not worker.gone.is_set():
            self._idle.put_nowait(worker)

    async def _keep_one(self) -> None:
        """One process after another."""
        while True:
            try:
                worker = await WorkerProcess.start(self._limits)
            except (OSError, EOFError):
                logger.exception("a worker of the pool %s cannot be started", self.name)
                self.prepared.set()  # nobody shall wait for ever
                await asyncio.sleep(RETRY)
                continue
            try:
                self._idle.put_nowait(worker)
                self.prepared.set()
                await worker.gone.wait()
            except asyncio.CancelledError:
                worker.kill()
                raise
            if not worker.given_up:
                self.deaths += 1
                logger.error("a worker of the pool %s died", self.name)
                await asyncio.sleep(RESPITE)
