"""Rollouts as jobs: queued, carried out by workers, cancelled, cached."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import secrets
from collections import OrderedDict
from dataclasses import dataclass, field

from stairwright.errors import Cancelled
from stairwright.storage.documents import Entry
from stairwright.storage.store import Store

from . import work
from .engine import rollout_engine
from .failures import problem, problem_of
from .gauge import Gauge
from .job import Job
from .live import LiveSeries
from .planning import shelve_plan
from .pool import WorkerPool
from .questions import PlanQuestion, RolloutQuestion
from .queue import FairQueue

logger = logging.getLogger(__name__)

LOOK_EVERY = 0.1  # s between looks at a worker's progress
COURTESY = 0.1  # s that a worker has to stop by itself before it is killed
REMEMBERED = 1000  # finished jobs in memory; older ones are read from the database
RESULT = "/api/v1/rollouts/{}"


@dataclass(eq=False)
class Run:
    """One simulation, and the jobs that wait for it: more than one if they asked the same."""

    question: RolloutQuestion
    owner: str
    gauge: Gauge
    live: LiveSeries
    jobs: list[Job] = field(default_factory=list)
    task: asyncio.Task[None] | None = None
    started: bool = False


class Rollouts:
    """All rollout jobs of one service. Belongs to one event loop."""

    def __init__(self, store: Store, pool: WorkerPool, queue_limit: int, deadline: float) -> None:
        self.queue = FairQueue(pool.workers, queue_limit, "rollouts")
        self._store = store
        self._pool = pool
        self._deadline = deadline
        self._jobs: OrderedDict[str, Job] = OrderedDict()
        self._runs: dict[str, Run] = {}
        self._stopping: set[asyncio.Task[None]] = set()
        self._writing = asyncio.Lock()  # a job's states reach the database in order

    async def submit(self, question: RolloutQuestion, owner: str) -> Job:
        """A new job; done at once where the answer is known.

        Raises:
            QueueFull: If too many wait.
        """
        job = Job(f"j-{secrets.token_hex(10)}", "rollout")
        stored = await asyncio.to_thread(
            self._store.documents.answer, "rollout", question.key, rollout_engine()
        )
        if stored is not None:
            job.finish("done", result=RESULT.format(stored.id))
        else:
            self._attach(job, question, owner)
        self._remember(job)
        await self._write_down(job)
        return job

    def _attach(self, job: Job, question: RolloutQuestion, owner: str) -> None:
        run = self._runs.get(question.key)
        if run is None:
            self.queue.check()
            run = Run(question, owner, Gauge.create(), LiveSeries())
            self._runs[question.key] = run
            run.task = asyncio.create_task(self._carry_out(run))
        elif run.started:
            job.start()
        job.live = run.live
        run.jobs.append(job)

    async def get(self, job_id: str) -> Job | None:
        """A job by its id."""
        if job_id in self._jobs:
            return self._jobs[job_id]
        record = await asyncio.to_thread(self._store.jobs.get, job_id)
        return None if record is None else Job.restored(record)

    async def cancel(self, job: Job) -> None:
        """Cancel a job; its worker stops unless another job waits for the same run."""
        if job.finished:
            return
        job.finish("cancelled", error=problem_of(Cancelled()))
        for key, run in list(self._runs.items()):
            if job in run.jobs:
                run.jobs.remove(job)
                if not run.jobs:
                    del self._runs[key]
                    if not run.started:
                        await self._abandon(run)  # its place in the queue is free at once
                        continue
                    stopping = asyncio.create_task(self._stop(run))
                    self._stopping.add(stopping)
                    stopping.add_done_callback(self._stopping.discard)
        await self._write_down(job)

    async def _stop(self, run: Run) -> None:
        """Ask the worker to stop, so that it stays warm; kill it if it does not listen."""
        assert run.task is not None
        run.gauge.cancel()
        await asyncio.wait({run.task}, timeout=COURTESY)
        await self._abandon(run)

    async def _abandon(self, run: Run) -> None:
        assert run.task is not None
        run.task.cancel()
        await asyncio.wait({run.task})

    async def stop(self) -> None:
        """End everything; what is unfinished fails."""
        for run in list(self._runs.values()):
            if run.task is not None:
                run.task.cancel()
                with contextlib.suppress(asyncio.CancelledError):
                    await run.task
        gone = problem(503, "interrupted", "the service was stopped; please ask again")
        for job in self._jobs.values():
            if not job.finished:
                job.finish("failed", error=gone)
                await self._write_down(job)

    async def _carry_out(self, run: Run) -> None:
        try:
            async with self.queue.slot(run.owner):
                run.started = True
                for job in run.jobs:
                    job.start()
                watcher = asyncio.create_task(_watch(run))
                try:
                    entry = await self._simulate(run)
                finally:
                    watcher.cancel()
        except asyncio.CancelledError:
            raise
        except Exception as error:  # whatever it is, the job must learn of it
            document = problem_of(error)
            if document["status"] == 500:
                logger.error("a rollout failed", exc_info=error)
            await self._finish(run, error=document)
        else:
            await self._finish(run, entry=entry)

    async def _simulate(self, run: Run) -> Entry:
        folder = str(self._store.artefacts.folder)
        product = await self._pool.run(
            work.simulate,
            run.question.data,
            folder,
            run.gauge.path,
            run.live.path,
            deadline=self._deadline,
        )
        return await asyncio.to_thread(self._shelve, run.question, product)

    def _shelve(self, question: RolloutQuestion, product: work.Product) -> Entry:
        if product.plan is not None and isinstance(question.source, PlanQuestion):
            shelve_plan(self._store, question.source, product.plan)
        return self._store.shelve(
            "rollout",
            product.id,
            question=question.key,
            engine=rollout_engine(),
            digest=product.digest,
            size=product.size,
            summary=product.summary,
        )

    async def _finish(
        self, run: Run, entry: Entry | None = None, error: dict[str, object] | None = None
    ) -> None:
        if self._runs.get(run.question.key) is run:
            del self._runs[run.question.key]
        for job in run.jobs:
            if entry is not None:
                job.finish("done", result=RESULT.format(entry.id))
            else:
                job.finish("failed", error=error)
            await self._write_down(job)

    def _remember(self, job: Job) -> None:
        self._jobs[job.id] = job
        finished = [old for old in self._jobs.values() if old.finished]
        for old in finished[: max(0, len(finished) - REMEMBERED)]:
            del self._jobs[old.id]

    async def _write_down(self, job: Job) -> None:
        async with self._writing:
            await asyncio.to_thread(self._store.jobs.put, job.record)

    def counts(self) -> dict[str, int]:
        """Jobs in memory by state."""
        counts: dict[str, int] = {}
        for job in self._jobs.values():
            counts[job.state] = counts.get(job.state, 0) + 1
        return counts


async def _watch(run: Run) -> None:
    while True:
        await asyncio.sleep(LOOK_EVERY)
        for job in run.jobs:
            job.advance(run.gauge.progress)
