"""A job as clients see it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Mapping
from typing import Any, Literal

from stairwright.storage.jobs import JobRecord

from .live import LiveSeries

State = Literal["queued", "running", "done", "failed", "cancelled"]
FINISHED = frozenset({"done", "failed", "cancelled"})
_LEAST_STEP = 0.005  # of progress that is worth an event
_UNWRITTEN = 10_000  # more changes than a job can have had since it was last written down


class Job:
    """State of one job and its changes; `revision` counts them. Belongs to one event loop."""

    def __init__(
        self, job_id: str, kind: str, *, owner: str = "", question: str | None = None
    ) -> None:
        self.id = job_id
        self.kind = kind
        self.owner = owner
        self.question = question  # the key of what it asks
        self.state: State = "queued"
        self.progress = 0.0
        self.result: str | None = None
        self.error: Mapping[str, Any] | None = None
        self.live: LiveSeries | None = None  # while it runs
        self.forecast: Callable[[], float | None] | None = None  # s left, while it is queued
        self.deaths = 0  # of workers at it
        self.losses = 0  # of the service while it ran
        self.revision = 1
        self.created = time.time()
        self._started: float | None = None
        self._changed = asyncio.Event()

    @classmethod
    def restored(cls, record: JobRecord) -> Job:
        """A job from before a restart; one that is unfinished is queued again."""
        job = cls(record.id, record.kind, owner=record.owner, question=record.question)
        job.result, job.error, job.created = record.result, record.error, record.created
        job.deaths, job.losses, job.revision = record.deaths, record.losses, record.revision
        if record.state in FINISHED:
            job.state = record.state  # type: ignore[assignment]
            job.progress = 1.0 if job.state == "done" else 0.0
        else:  # whoever saw it change before must not take what comes for old
            job.revision += _UNWRITTEN
            job.losses += record.state == "running"
        return job

    @property
    def finished(self) -> bool:
        """Whether nothing will change any more."""
        return self.state in FINISHED

    @property
    def record(self) -> JobRecord:
        """What is written down of it."""
        return JobRecord(
            self.id,
            self.kind,
            self.state,
            self.result,
            self.error,
            self.question,
            self.owner,
            self.deaths,
            self.losses,
            self.revision,
            self.created,
        )

    @property
    def spent(self) -> float:
        """Seconds that a worker has been at it."""
        return 0.0 if self._started is None else time.monotonic() - self._started

    @property
    def eta(self) -> float | None:
        """Seconds until it is done, as far as progress, or its place in the queue, can tell."""
        if self.state == "queued" and self.forecast is not None:
            left = self.forecast()
            return None if left is None else round(left, 1)
        if self.state != "running" or self._started is None or self.progress < 0.02:
            return None
        return round(self.spent * (1.0 - self.progress) / self.progress, 1)

    def start(self) -> None:
        """A worker has taken it."""
        self.state, self._started = "running", time.monotonic()
        self._notify()

    def requeue(self) -> None:
        """Its worker is gone: from the beginning, when there is another one."""
        if self.finished:
            return
        self.state, self._started, self.progress = "queued", None, 0.0
        self._notify()

    def advance(self, progress: float) -> None:
        """Note progress, 0..1; small steps make no event."""
        if progress - self.progress >= _LEAST_STEP:
            self.progress = progress
            self._notify()

    def finish(
        self,
        state: State,
        *,
        result: str | None = None,
        error: Mapping[str, Any] | None = None,
    ) -> None:
        """Reach a final state; the first one stays."""
        if self.finished:
            return
        self.state, self.result, self.error = state, result, error
        if state == "done":
            self.progress = 1.0
        self._notify()
        self.live = self.forecast = None

    def _notify(self) -> None:
        self.revision += 1
        self._changed.set()
        self._changed = asyncio.Event()

    async def changes(self, seen: int = 0) -> AsyncIterator[int]:
        """Revisions newer than `seen`, now and as they come, until the job is finished."""
        while True:
            changed = self._changed
            if self.revision > seen:
                seen = self.revision
                yield seen
                continue
            if self.finished:
                return
            await changed.wait()
