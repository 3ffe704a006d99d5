"""Rollouts and trials of a service on a Dask cluster that runs elsewhere."""

from __future__ import annotations

import asyncio
import contextlib
import importlib
import logging
import math
import secrets
import zlib
from collections.abc import Callable
from concurrent.futures import CancelledError
from typing import Any

from stairwright.errors import Cancelled
from stairwright.jobs import live, work
from stairwright.jobs.engine import rollout_engine
from stairwright.jobs.failures import GivenUp, Unreachable, WorkerDied
from stairwright.jobs.run import Run
from stairwright.storage.artefacts import Artefacts

from . import tasks
from .connection import CONNECT_LIMIT, configured_security, dask_plugin, knock

logger = logging.getLogger(__name__)

PATIENCE = 60.0  # s that a job waits for a scheduler with workers
_PREPARE_LIMIT = 300.0  # s for workers to load the core
_RETRY = 2.0  # s between attempts to connect
_LOOK = 1.0  # s between looks at the cluster
_PRIORITY = 10  # of Dask's: somebody waits for a job, and cells of studies come by the thousand
_PART = 8  # trials at most in one task: a second or two, so that none is dear to lose
_PARTS = 2  # a worker: all end together


class Shares:
    """How far a run is, from what its tasks tell."""

    def __init__(self, run: Run, parts: int) -> None:
        """`parts` is the number of tasks besides the plan."""
        self._run = run
        self._parts = parts
        self._plan = work.PLANNING_SHARE if run.question.data.get("ask") else 0.0
        self._done: dict[str, float] = {}  # of the parts, by key

    def hear(self, news: dict[str, Any]) -> None:
        """Take in what a worker tells."""
        if "series" in news:
            live.append(self._run.live.path, zlib.decompress(news["series"]))
            return
        if not news["task"].startswith("plan-"):
            self._done[news["task"]] = news["share"]
        share = sum(self._done.values()) / self._parts
        with contextlib.suppress(Cancelled):  # who cancels also ends `carry_out`
            self._run.gauge.report(self._plan + (1.0 - self._plan) * share)


class DaskSimulators:
    """`Simulators` over a cluster. Connects by itself, again where the scheduler was gone."""

    def __init__(self, address: str, artefacts: Artefacts, deadline: float) -> None:
        """`deadline` [s] is for one rollout."""
        self.workers, self.spares = 1, 1
        self.resized: Callable[[int], None] = lambda _: None
        self._address = address
        self._artefacts = artefacts
        self._deadline = deadline
        self._topic = f"stairwright-{secrets.token_hex(8)}"
        self._trouble = "it was not asked yet"
        self._client: Any = None
        self._preparing = False  # workers load the core
        self._connected = asyncio.Event()
        self._heard: dict[str, Shares] = {}  # by run
        self._working: set[asyncio.Task[Any]] = set()
        self._keeper: asyncio.Task[None] | None = None
        self._leaving = False

    async def start(self) -> None:
        """Begin to connect, without waiting for it."""
        self._keeper = asyncio.create_task(self._keep())

    async def stop(self) -> None:
        """Leave the cluster."""
        self._leaving = True
        if self._keeper is not None:
            self._keeper.cancel()
            await asyncio.gather(self._keeper, return_exceptions=True)

    async def ready(self) -> None:
        """See `Simulators`.

        Raises:
            Unreachable: If there is no scheduler with workers for too long.
        """
        while not self._connected.is_set():
            try:
                async with asyncio.timeout(PATIENCE):
                    await self._connected.wait()
            except TimeoutError:
                if not self._preparing:
                    why = f"{self._address}: {self._trouble}"
                    raise Unreachable(why, retry_after=PATIENCE) from None

    async def carry_out(self, run: Run) -> work.Product:
        """See `Simulators`."""
        client = self._client
        if client is None:
            raise WorkerDied("the scheduler is gone")
        source = await asyncio.to_thread(self._source, run)
        name = f"{run.question.key[-12:]}-{secrets.token_hex(4)}"
        futures = self._submit(client, name, run, source)
        result = asyncio.create_task(_result(futures[-1]))
        self._working.add(result)
        try:
            product = await result
        except asyncio.CancelledError:
            mine = asyncio.current_task()
            if mine is None or mine.cancelling():  # our caller does not want it any more
                raise
            raise WorkerDied("the scheduler is gone") from None
        finally:
            self._working.discard(result)
            del self._heard[name]
            with contextlib.suppress(Exception):  # nobody may be there any more
                # Also what is done: nobody needs it from now on.
                await client.cancel(futures, asynchronous=True, force=True)
        return await asyncio.to_thread(work.keep, product, self._artefacts)

    def _source(self, run: Run) -> dict[str, Any]:
        """Where the plan comes from; workers share no disk."""
        data = run.question.data
        if "plan_digest" in data:
            return {"content": work.stored_plan(data, self._artefacts)}
        return {name: data[name] for name in ("ask", "plan") if name in data}

    def _submit(self, client: Any, name: str, run: Run, source: dict[str, Any]) -> list[Any]:
        """Ask for everything that the run takes; the last future is its outcome.

        Keys are of this attempt alone: one that was cancelled may still be at work.
        """
        engine, question = rollout_engine(), run.question.data
        question = {key: question[key] for key in question if key not in ("plan", "plan_digest")}
        futures: list[Any] = []

        def ask(what: str, function: Callable[..., Any], *args: Any, runs: int = 1) -> Any:
            key = f"{what}-{name}"
            order = tasks.Order(name, self._topic, key, engine, self._deadline * runs)
            futures.append(client.submit(function, *args, order, key=key, priority=_PRIORITY))
            return futures[-1]

        margins = run.question.kind == "margins"  # one task: where it ends depends on what it finds
        count = 1 if margins else run.question.runs
        size = max(1, min(_PART, math.ceil(count / (_PARTS * self.workers))))
        firsts = range(0, count, size)
        self._heard[name] = Shares(run, len(firsts))
        plan = ask("plan", tasks.make_plan, source)
        if run.question.kind == "rollout":
            ask("rollout", tasks.roll_out, plan, question)
        elif margins:
            ask("margins", tasks.find_margins, plan, question, runs=run.question.runs)
        else:
            parts = [
                ask(f"trials{first}", tasks.try_part, plan, question, first,
                    min(count, first + size))
                for first in firsts
            ]  # fmt: skip
            ask("summary", tasks.sum_up, plan, question, parts)
        return futures

    async def _keep(self) -> None:
        """Connected, again and again."""
        while not self._leaving:  # a client of Dask's that is closing swallows who cancels it
            try:
                client = await self._connect()
            except (OSError, RuntimeError, TypeError, ValueError, ImportError) as error:
                self._note(str(error).split("\n")[0] or type(error).__name__)
                await asyncio.sleep(_RETRY)
                continue
            try:
                await self._stay(client)
            finally:
                self._connected.clear()
                self._client = None
                for task in list(self._working):
                    task.cancel()
                with contextlib.suppress(Exception):  # nobody may be there any more
                    await client.close(timeout=2)

    async def _connect(self) -> Any:
        distributed = await asyncio.to_thread(importlib.import_module, "distributed")
        await asyncio.to_thread(knock, self._address)
        client = await distributed.Client(
            self._address,
            security=configured_security(),
            timeout=CONNECT_LIMIT,
            asynchronous=True,
            set_as_default=False,
        )
        self._preparing = True
        try:
            await asyncio.wait_for(client.register_plugin(dask_plugin()), _PREPARE_LIMIT)
        except BaseException:
            await client.close(timeout=2)
            raise
        finally:
            self._preparing = False
        client.subscribe_topic(self._topic, self._hear)
        return client

    async def _stay(self, client: Any) -> None:
        """Until the scheduler is gone, or has had no workers for too long."""
        idle = 0.0
        while client.status == "running" and idle < PATIENCE:
            try:
                threads = await asyncio.wait_for(client.nthreads(), CONNECT_LIMIT)
            except (OSError, TimeoutError, CancelledError):
                break
            count = sum(threads.values())
            idle = 0.0 if count else idle + _LOOK
            if count:
                self._client = client
                self._connected.set()
                if count != self.workers:
                    self.workers = count
                    self.resized(count)
            else:
                self._note("it has no workers")
                self._connected.clear()
            await asyncio.sleep(_LOOK)
        if not idle:
            self._note("it is gone")

    def _note(self, trouble: str) -> None:
        """Say what is the matter, once."""
        if trouble != self._trouble:
            self._trouble = trouble
            logger.warning("the cluster at %s: %s", self._address, trouble)

    def _hear(self, event: tuple[float, dict[str, Any]]) -> None:
        news = event[1]
        shares = self._heard.get(news["run"])
        if shares is not None:
            shares.hear(news)


async def _result(future: Any) -> work.Product:
    """What comes of it, in our words.

    Raises:
        WorkerDied: If the cluster has lost it.
        Failure, InputError: What the task raised.
    """
    try:
        product: work.Product = await future
    except CancelledError as error:  # of Dask's: the scheduler is gone, or forgot it
        raise WorkerDied("the cluster has lost it") from error
    except Cancelled as error:  # nobody of ours did
        raise WorkerDied("it was cancelled on the cluster") from error
    except Exception as error:
        if type(error).__name__ == "KilledWorker":
            why = "given up: workers of the cluster have died at it, or took too long"
            raise GivenUp(why) from error
        raise
    return product
