"""Worker processes that can be killed: pebble's pool, kept alive, seen from an event loop."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from typing import Any, TypeVar, cast

from pebble import CONSTS, ProcessExpired, ProcessPool

from . import launch
from .board import Board, carry_out
from .failures import DeadlineExceeded, WorkerDied
from .worker import Limits, initialise

T = TypeVar("T")
logger = logging.getLogger(__name__)

GRACE = 5.0  # s beyond a deadline after which the pool itself is thought to hang
CHECK_EVERY = 0.5  # s between looks at idle pools


class WorkerPool:
    """Some processes of one kind. Callers must not run more at once than there are workers.

    Workers are forked from a server process that has imported and compiled everything
    (`preload`), so one that died is replaced within milliseconds. `spares` are further processes
    that take over while one that was given up is still being replaced.
    """

    def __init__(self, name: str, workers: int, limits: Limits, spares: int = 0) -> None:
        self.name = name
        self.workers = workers
        self._spares = spares
        self.deaths = 0
        self._limits = limits
        self._board = Board()
        self._lock = threading.Lock()
        self._pool: ProcessPool | None = None
        self._keeper: asyncio.Task[None] | None = None

    async def start(self) -> None:
        """Start the workers, without waiting for them, and keep them alive until `stop`."""
        self._keeper = asyncio.create_task(self._keep_alive())

    async def stop(self) -> None:
        """Kill the workers."""
        if self._keeper is not None:
            self._keeper.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._keeper
        if not self._lock.acquire(timeout=0.1):
            return  # still starting: what comes of it ends with this process
        pool, self._pool = self._pool, None
        self._lock.release()
        if pool is not None:
            await _in_thread(_end, pool)

    async def run(self, function: Callable[..., T], *args: Any, deadline: float) -> T:
        """Carry out `function(*args)` in a worker; cancelling the caller kills that worker.

        Raises:
            DeadlineExceeded: After `deadline` [s].
            WorkerDied: If the process is gone.
            Exception: Whatever the function raises.
        """
        ready = self._pool
        pool = ready if ready and ready.active else await _in_thread(self._healthy_pool)
        line = self._board.take()
        task = [line, function, *args]
        try:
            future = pool.schedule(carry_out, args=task, timeout=deadline)
        except RuntimeError:  # broke in the last moment
            pool = await _in_thread(self._healthy_pool)
            future = pool.schedule(carry_out, args=task, timeout=deadline)
        outcome: asyncio.Future[T] = asyncio.wrap_future(future)
        outcome.add_done_callback(partial(self._over, line))
        try:
            return await asyncio.wait_for(asyncio.shield(outcome), deadline + GRACE)
        except asyncio.CancelledError:
            self._board.give_up(line)
            raise
        except TimeoutError:
            if not outcome.done():
                logger.error("the pool %s hangs and is replaced", self.name)
                await _in_thread(self._replace, pool)
            raise DeadlineExceeded(f"stopped after {deadline:g} s, the longest allowed") from None
        except (ProcessExpired, BrokenProcessPool) as error:
            self.deaths += 1
            logger.error("a worker of the pool %s died: %s", self.name, error)
            raise WorkerDied("the process that did the work died (out of memory?)") from None

    def _over(self, line: int, outcome: asyncio.Future[Any]) -> None:
        self._board.give_back(line)
        if not outcome.cancelled():
            outcome.exception()  # the caller may have gone

    def _healthy_pool(self) -> ProcessPool:
        with self._lock:
            if self._pool is None or not self._pool.active:
                if self._pool is not None:
                    logger.error("the pool %s broke and is replaced", self.name)
                    self.deaths += 1
                    threading.Thread(target=_end, args=(self._pool,), daemon=True).start()
                self._pool = self._new_pool()
            return self._pool

    def _replace(self, broken: ProcessPool) -> None:
        with self._lock:
            if self._pool is broken:
                self._pool = self._new_pool()
        _end(broken)

    def _new_pool(self) -> ProcessPool:
        CONSTS.sleep_unit = 0.02  # s between looks at deadlines and dead workers
        CONSTS.term_timeout = 0.5  # s from SIGTERM to SIGKILL
        pool = ProcessPool(
            max_workers=self.workers + self._spares,
            initializer=initialise,
            initargs=[self._limits, self._board.path],
            context=launch.context(),
        )
        assert pool.active  # asking starts the workers
        return pool

    async def _keep_alive(self) -> None:
        """An idle worker that dies may take pebble's pool along: replace it before it is needed."""
        while True:
            try:
                await _in_thread(self._healthy_pool)
            except OSError:
                logger.exception("the pool %s cannot be started", self.name)
            await asyncio.sleep(CHECK_EVERY)


async def _in_thread(function: Callable[..., T], *args: Any) -> T:
    """Like `asyncio.to_thread`, but a server that ends does not wait for the thread.

    Workers cannot be started before everything is imported and compiled, which takes seconds.
    """
    loop = asyncio.get_running_loop()
    answer: asyncio.Future[T] = loop.create_future()

    def settle(result: T | None, error: Exception | None) -> None:
        if answer.done():
            return
        if error is None:
            answer.set_result(cast(T, result))
        else:
            answer.set_exception(error)

    def work() -> None:
        result, problem = None, None
        try:
            result = function(*args)
        except Exception as error:  # noqa: BLE001 - handed on to the caller
            problem = error
        with contextlib.suppress(RuntimeError):  # the loop has ended meanwhile
            loop.call_soon_threadsafe(settle, result, problem)

    threading.Thread(target=work, daemon=True).start()
    return await answer


def _end(pool: ProcessPool) -> None:
    pool.stop()  # type: ignore[no-untyped-call]
    pool.join()
