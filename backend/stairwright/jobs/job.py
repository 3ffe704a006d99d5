"""A job as clients see it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Mapping
from typing import Any, Literal

from stairwright.storage.jobs import JobRecord

from .live import LiveSeries

State = Literal["queued", "running", "done", "failed", "cancelled"]
FINISHED = frozenset({"done", "failed", "cancelled"})
_LEAST_STEP = 0.005  # of progress that is worth an event


class Job:
    """State of one job and its changes; `revision` counts them. Belongs to one event loop."""

    def __init__(self, job_id: str, kind: str) -> None:
        self.id = job_id
        self.kind = kind
        self.state: State = "queued"
        self.progress = 0.0
        self.result: str | None = None
        self.error: Mapping[str, Any] | None = None
        self.live: LiveSeries | None = None  # while it runs
        self.revision = 1
        self._started: float | None = None
        self._changed = asyncio.Event()

    @classmethod
    def restored(cls, record: JobRecord) -> Job:
        """A job from before a restart."""
        job = cls(record.id, record.kind)
        job.state = record.state  # type: ignore[assignment]
        job.result, job.error = record.result, record.error
        job.progress = 1.0 if job.state == "done" else 0.0
        return job

    @property
    def finished(self) -> bool:
        """Whether nothing will change any more."""
        return self.state in FINISHED

    @property
    def record(self) -> JobRecord:
        """What is written down of it."""
        return JobRecord(self.id, self.kind, self.state, self.result, self.error)

    @property
    def eta(self) -> float | None:
        """Seconds that it will take still, as far as progress can tell."""
        if self.state != "running" or self._started is None or self.progress < 0.02:
            return None
        spent = time.monotonic() - self._started
        return round(spent * (1.0 - self.progress) / self.progress, 1)

    def start(self) -> None:
        """A worker has taken it."""
        self.state, self._started = "running", time.monotonic()
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
        self.live = None

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
