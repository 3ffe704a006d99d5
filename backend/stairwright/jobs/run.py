"""One simulation and the jobs that wait for it, and how long it will take."""

from __future__ import annotations

import asyncio
import heapq
from collections.abc import Sequence
from dataclasses import dataclass, field

from .gauge import Gauge
from .job import Job
from .live import LiveSeries
from .questions import RolloutQuestion

LOOK_EVERY = 0.1  # s between looks at a worker's progress


@dataclass(eq=False)
class Run:
    """One simulation, and the jobs that wait for it: more than one if they asked the same."""

    question: RolloutQuestion
    owner: str
    gauge: Gauge = field(default_factory=Gauge.create)
    live: LiveSeries = field(default_factory=LiveSeries)
    jobs: list[Job] = field(default_factory=list)
    task: asyncio.Task[None] | None = None
    started: bool = False
    deaths: int = 0  # of workers at it

    def join(self, job: Job) -> None:
        """One more job waits for this."""
        self.deaths = max(self.deaths, job.deaths)
        if self.started:
            job.start()
        job.live = self.live
        self.jobs.append(job)

    def begin(self) -> None:
        """A worker has taken it."""
        self.started = True
        for job in self.jobs:
            job.start()

    def begin_anew(self) -> None:
        """Its worker has died: what that one reported means nothing to the next."""
        self.started, self.deaths = False, self.deaths + 1
        self.gauge, self.live = Gauge.create(), LiveSeries()
        for job in self.jobs:
            job.deaths, job.live = self.deaths, self.live
            job.requeue()

    async def watch(self) -> None:
        """Hand the worker's progress on, until cancelled."""
        while True:
            await asyncio.sleep(LOOK_EVERY)
            for job in self.jobs:
                job.advance(self.gauge.progress)

    @property
    def spent(self) -> float:
        """Seconds that a worker has been at it."""
        return max((job.spent for job in self.jobs), default=0.0)

    @property
    def left(self) -> float | None:
        """Seconds until it is done, None while that cannot be told."""
        return next((job.eta for job in self.jobs if job.eta is not None), None)


def forecast(running: Sequence[Run], ahead: int, workers: int, typical: float | None) -> float:
    """Seconds until a run that waits is done.

    Args:
        running: What the workers are at.
        ahead: How many others begin before it.
        workers: How many there are.
        typical: Seconds that one took lately, None if none has ended yet.
    """
    known = [run.spent + left for run in running if (left := run.left) is not None]
    known += [run.spent for run in running]
    each = max(known, default=0.0) if typical is None else typical
    ends = [max(0.0, each - run.spent) if run.left is None else run.left for run in running]
    ends = sorted(ends + [0.0] * (workers - len(ends)))  # a sorted list is a heap
    for _ in range(ahead):
        heapq.heapreplace(ends, ends[0] + each)
    return ends[0] + each
