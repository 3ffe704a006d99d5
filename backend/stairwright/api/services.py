"""Everything that lives as long as the application: store, pools, jobs, scenes, figures."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import logging
from functools import partial

from fastapi.concurrency import run_in_threadpool

from stairwright.jobs.engine import planning_engine, rollout_engine
from stairwright.jobs.memory import give_memory_back
from stairwright.jobs.planning import Planning
from stairwright.jobs.pool import WorkerPool
from stairwright.jobs.rollouts import Rollouts
from stairwright.jobs.simulators import PoolSimulators, Simulators
from stairwright.jobs.worker import Limits
from stairwright.library import load_robot, load_terrain, robots, terrains
from stairwright.storage.lock import FolderLock
from stairwright.storage.store import Store
from stairwright.studies.service import Studies

from .clock_watch import watch_clock
from .figures import Figures
from .metrics import Metrics
from .readiness import Readiness
from .replanning import Replanning
from .sessions import Sessions, load_scenes
from .settings import Settings
from .trouble import Trouble

logger = logging.getLogger(__name__)

COLLECT_EVERY = 3600.0  # s
SETTLE_EVERY = 2.0  # s
TRIM_EVERY = 60.0  # s
FIRST_SECOND = 1.0  # s
UPLOAD_MEMORY = 2048  # MiB
EXPORT_DEADLINE = 60.0  # s
ROLLOUT_NICENESS = 10


def _read_what_questions_need() -> None:
    """Presets and fingerprints of the code, which the first question would wait for."""
    for name in terrains():
        load_terrain(name)
    for name in robots():
        load_robot(name)
    planning_engine()
    rollout_engine()


class Services:
    """Made with the application, started and stopped with it."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.metrics = Metrics()
        self._lock = FolderLock(settings.data)
        self.store = Store(settings.data)
        memory = settings.worker_memory
        self.plan_pool = WorkerPool("plans", settings.plan_workers, Limits(memory=memory), spares=1)
        self.readiness = Readiness(self.plan_pool)
        self.upload_pool = WorkerPool("uploads", 1, Limits(memory=UPLOAD_MEMORY, sealed=True))
        self.planning = Planning(
            self.store, self.plan_pool, settings.plan_queue_limit, settings.plan_deadline
        )
        self.pools = [self.plan_pool, self.upload_pool]
        self.simulators = self._make_simulators()
        self.rollouts = Rollouts(self.store, self.simulators, settings.queue_limit)
        self.simulators.resized = self.rollouts.queue.resize
        self.studies = Studies(
            self.store,
            settings.study_workers,
            settings.scheduler,
            settings.study_queue_limit,
            settings.studies_setup,
        )
        self.uploading = asyncio.Semaphore(1)
        self.sessions = Sessions(
            settings.session_limit, settings.session_idle, Replanning(self.planning)
        )
        self._tasks: list[asyncio.Task[None]] = []
        self._show_gauges()

    def _make_simulators(self) -> Simulators:
        """The cluster's, or processes of this machine."""
        settings, artefacts = self.settings, self.store.artefacts
        if settings.scheduler:
            from stairwright.jobs.cluster.simulators import DaskSimulators

            return DaskSimulators(settings.scheduler, artefacts, settings.rollout_deadline)
        limits = Limits(memory=settings.worker_memory, nice=ROLLOUT_NICENESS)
        pool = WorkerPool("rollouts", settings.rollout_workers, limits, spares=1)
        self.pools.append(pool)
        return PoolSimulators(pool, artefacts, settings.rollout_deadline)

    async def start(self) -> None:
        """Take over from an earlier process, then start workers and housekeeping."""
        if self.store.read_only:
            logger.error("%s", self.store.read_only)
        else:
            await self._take_over()
        await self.plan_pool.start()
        self._tasks = [
            asyncio.create_task(self._start_the_rest()),
            asyncio.create_task(watch_clock(self.store.last_written)),
            asyncio.create_task(self.sessions.close_idle_forever()),
            asyncio.create_task(self._stay_small()),
        ]
        if not self.store.read_only:
            self._tasks += [
                asyncio.create_task(self._collect()),
                asyncio.create_task(self._settle()),
            ]

    async def _take_over(self) -> None:
        """Go on with what an earlier process left unfinished."""
        await asyncio.to_thread(self.store.idempotency.release_unfinished)
        unfinished = await self.rollouts.resume()
        await self.studies.start()
        if unfinished:
            logger.info("%d jobs from before the restart go on", unfinished)

    async def _start_the_rest(self) -> None:
        """What nobody waits for in the first second must not compete with what somebody does."""
        await run_in_threadpool(_read_what_questions_need)  # which warms FastAPI's threads too
        self._tasks.append(asyncio.create_task(self.readiness.rehearse()))
        await self.readiness.tried.wait()  # what plans cannot, others may
        await asyncio.sleep(FIRST_SECOND)
        # The pool for uploads, which is large, waits until it is needed.
        await self.simulators.start()
        load_scenes()
        gc.freeze()  # a collector that looks at all that was imported holds every request up

    async def stop(self) -> None:
        """End everything in order."""
        for task in self._tasks:
            task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await task
        await self.rollouts.stop()
        await self.studies.stop()
        await self.simulators.stop()
        await self.sessions.close_all()
        await asyncio.gather(*(pool.stop() for pool in self.pools))
        self.store.close()
        self._lock.release()

    async def _collect(self) -> None:
        trouble = Trouble(logger, "making room for new results")
        while True:
            try:
                removed = await asyncio.to_thread(self.store.collect, self.settings.keep_bytes)
                if removed:
                    logger.info("removed %d results for want of room", removed)
            except Exception as error:  # noqa: BLE001 - housekeeping goes on
                trouble.failed(error)
            else:
                trouble.worked()
            await asyncio.sleep(COLLECT_EVERY)

    async def _stay_small(self) -> None:
        while True:
            await asyncio.sleep(TRIM_EVERY)
            await asyncio.to_thread(give_memory_back)

    async def _settle(self) -> None:
        trouble = Trouble(logger, "compressing new results")
        while True:
            await asyncio.sleep(SETTLE_EVERY)
            try:
                await self.rollouts.journal.catch_up()
                await asyncio.to_thread(self.store.settle)
            except Exception as error:  # noqa: BLE001 - housekeeping goes on
                trouble.failed(error)
            else:
                trouble.worked()

    def _show_gauges(self) -> None:
        show = self.metrics.gauge
        self.metrics.registry.register(
            Figures(self.store, self.pools, lambda: self.readiness.ready)
        )
        for pool in self.pools:
            pool.observe = partial(self.metrics.worked, pool.name)
        self.store.observe = self.metrics.resulted
        for queue in (self.planning.queue, self.rollouts.queue):
            queue.observe = partial(self.metrics.waited, queue.name)
            show(f"{queue.name}_waiting", "Waiting tasks", partial(getattr, queue, "length"))
            show(f"{queue.name}_running", "Running tasks", partial(getattr, queue, "running"))
        show("simulators", "Rollouts at once", lambda: self.simulators.workers)
        show("sessions", "Open 3D scenes", self.sessions.__len__)
