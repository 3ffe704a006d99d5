"""Rollouts and sets of trials as jobs: queued, carried out by workers, cancelled, cached.

What was accepted is done: a job outlives workers and the service itself (`resume`).
"""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections import OrderedDict
from collections.abc import Mapping
from functools import partial
from typing import cast

from stairwright.errors import Cancelled
from stairwright.storage.documents import Entry, Kind
from stairwright.storage.store import Store

from . import work
from .engine import rollout_engine
from .failures import GivenUp, Interrupted, WorkerDied, is_lost, problem_of
from .job import Job
from .journal import Journal
from .planning import shelve, shelve_plan
from .questions import PlanQuestion, RolloutQuestion
from .queue import FairQueue
from .run import Run, forecast
from .simulators import Simulators

logger = logging.getLogger(__name__)

COURTESY = 0.1  # s that a worker has to stop by itself before it is killed
REMEMBERED = 1000  # finished jobs in memory; older ones are read from the database
MOST_DEATHS = 3  # of workers at one job: then it is the job that kills them
MOST_LOSSES = 20  # of the service while a job ran: it may have nothing to do with it, or all
RESULT = {  # by kind
    "rollout": "/api/v1/rollouts/{}",
    "trials": "/api/v1/trials/{}",
    "margins": "/api/v1/margins/{}",
}


class Rollouts:
    """All such jobs of one service. Belongs to one event loop."""

    def __init__(self, store: Store, simulators: Simulators, queue_limit: int) -> None:
        self.queue = FairQueue(
            simulators.workers, queue_limit, "rollouts", reserve=simulators.spares
        )
        self.journal = Journal(store.jobs)
        self._store = store
        self._simulators = simulators
        self._jobs: OrderedDict[str, Job] = OrderedDict()
        self._runs: dict[str, Run] = {}
        self._stopping: set[asyncio.Task[None]] = set()

    async def submit(self, question: RolloutQuestion, owner: str) -> Job:
        """A new job; done at once where the answer is known.

        Raises:
            QueueFull: If too many wait.
        """
        job = Job(f"j-{secrets.token_hex(10)}", question.kind, owner=owner, question=question.key)
        if not await self._answer(job):
            if question.key not in self._runs:
                self.queue.check(owner)
            self._attach(job, question)
        self._remember(job)
        try:
            await self.journal.write(job, question)
        except BaseException:  # it was not accepted, so nobody waits for it
            await self._leave(job)
            del self._jobs[job.id]
            raise
        return job

    async def resume(self) -> int:
        """Go on with what an earlier process left unfinished; returns how many jobs that is."""
        unfinished = await self.journal.unfinished()
        for job in unfinished:
            self._remember(job)
            if await self._answer(job):
                await self.journal.note(job)
                continue
            question = await self.journal.question(job)
            if question is None:
                error = Interrupted("the service ended and cannot go on with this: ask again")
                job.finish("failed", error=problem_of(error))
            elif job.losses >= MOST_LOSSES:
                error = Interrupted(f"given up: the service ended {job.losses} times meanwhile")
                job.finish("failed", error=problem_of(error))
            else:
                self._attach(job, question)
            await self.journal.note(job)
        return len(unfinished)

    async def _answer(self, job: Job) -> bool:
        """Finish the job if what it asks is known already."""
        find = self._store.documents.answer
        stored = await asyncio.to_thread(
            find, cast(Kind, job.kind), str(job.question), rollout_engine()
        )
        if stored is not None:
            job.finish("done", result=RESULT[job.kind].format(stored.id))
        return stored is not None

    def _attach(self, job: Job, question: RolloutQuestion) -> None:
        run = self._runs.get(question.key)
        if run is None:
            run = self._runs[question.key] = Run(question, job.owner)
            run.task = asyncio.create_task(self._carry_out(run))
        run.join(job)
        job.forecast = partial(self._forecast, run)

    def _forecast(self, run: Run) -> float | None:
        running = [other for other in self._runs.values() if other.started]
        if self.queue.typical is None and not any(other.left for other in running):
            return None
        mine = [other for other in self._runs.values() if other.owner == run.owner]
        waiting = [other for other in mine if not other.started]
        ahead = self.queue.ahead(run.owner, waiting.index(run)) if run in waiting else 0
        return forecast(running, ahead, self.queue.capacity, self.queue.typical)

    async def get(self, job_id: str) -> Job | None:
        """A job by its id."""
        if job_id in self._jobs:
            return self._jobs[job_id]
        record = await asyncio.to_thread(self._store.jobs.get, job_id)
        return None if record is None else Job.restored(record)

    async def lost(self, job: Job) -> bool:
        """Whether there is nothing to be had of it, by no fault of the question's."""
        if job.state == "done" and job.result is not None:
            result = job.result.rpartition("/")[2]
            find = self._store.documents.get
            return await asyncio.to_thread(find, cast(Kind, job.kind), result) is None
        return job.state == "failed" and is_lost(job.error)

    def known(self, job_id: str) -> Job | None:
        """A job in memory."""
        return self._jobs.get(job_id)

    async def cancel(self, job: Job) -> None:
        """Cancel a job; its worker stops unless another job waits for the same run."""
        if job.finished:
            return
        job.finish("cancelled", error=problem_of(Cancelled()))
        await self._leave(job)
        await self.journal.write(job)

    async def _leave(self, job: Job) -> None:
        for key, run in list(self._runs.items()):
            if job in run.jobs:
                run.jobs.remove(job)
                if not run.jobs:
                    del self._runs[key]
                    if not run.started:
                        await _abandon(run)  # its place in the queue is free at once
                        continue
                    stopping = asyncio.create_task(_stop(run))
                    self._stopping.add(stopping)
                    stopping.add_done_callback(self._stopping.discard)

    async def stop(self) -> None:
        """End everything; what is unfinished goes on after the next start."""
        for run in list(self._runs.values()):
            await _abandon(run)
        for job in self._jobs.values():
            if not job.finished:
                job.requeue()
                await self.journal.note(job)
        await self.journal.catch_up()

    async def _carry_out(self, run: Run) -> None:
        try:
            entry = await self._persist(run)
        except asyncio.CancelledError:
            raise
        except Exception as error:  # whatever it is, the job must learn of it
            document = problem_of(error)
            if document["status"] == 500:
                logger.error("a rollout failed", exc_info=error)
            await self._finish(run, error=document)
        else:
            await self._finish(run, entry=entry)

    async def _persist(self, run: Run) -> Entry:
        """Simulate, again and again where workers die at it."""
        while True:
            try:
                return await self._simulate(run)
            except WorkerDied as error:
                run.begin_anew()
                if isinstance(error, GivenUp):
                    raise
                if run.deaths >= MOST_DEATHS:
                    message = f"given up: {run.deaths} workers have died at it (out of memory?)"
                    raise GivenUp(message) from error
                logger.warning("a rollout begins anew: its worker died")
                await self._note(run)

    async def _simulate(self, run: Run) -> Entry:
        async with self.queue.slot(run.owner, accepted=True):
            await self._simulators.ready()  # nothing runs before there is somebody to do it
            run.begin()
            await self._note(run)
            watcher = asyncio.create_task(run.watch())
            try:
                product = await self._simulators.carry_out(run)
            finally:
                watcher.cancel()
        return await asyncio.to_thread(self._shelve, run.question, product)

    def _shelve(self, question: RolloutQuestion, product: work.Product) -> Entry:
        if product.plan is not None and isinstance(question.source, PlanQuestion):
            shelve_plan(self._store, question.source, product.plan)
        return shelve(self._store, question.kind, question.key, rollout_engine(), product)

    async def _finish(
        self, run: Run, entry: Entry | None = None, error: Mapping[str, object] | None = None
    ) -> None:
        if self._runs.get(run.question.key) is run:
            del self._runs[run.question.key]
        for job in run.jobs:
            if entry is not None:
                job.finish("done", result=RESULT[job.kind].format(entry.id))
            else:
                job.finish("failed", error=error)
        await self._note(run)

    async def _note(self, run: Run) -> None:
        for job in list(run.jobs):
            await self.journal.note(job)

    def _remember(self, job: Job) -> None:
        self._jobs[job.id] = job
        finished = [old for old in self._jobs.values() if old.finished]
        for old in finished[: max(0, len(finished) - REMEMBERED)]:
            del self._jobs[old.id]

    def counts(self) -> dict[str, int]:
        """Jobs in memory by state."""
        counts: dict[str, int] = {}
        for job in self._jobs.values():
            counts[job.state] = counts.get(job.state, 0) + 1
        return counts


async def _stop(run: Run) -> None:
    """Ask the worker to stop, so that it stays warm; kill it if it does not listen."""
    assert run.task is not None
    run.gauge.cancel()
    await asyncio.wait({run.task}, timeout=COURTESY)
    await _abandon(run)


async def _abandon(run: Run) -> None:
    assert run.task is not None
    run.task.cancel()
    await asyncio.wait({run.task})
