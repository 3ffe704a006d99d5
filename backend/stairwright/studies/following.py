"""How far a study has come, for who follows it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import orjson

from stairwright.jobs.job import Job
from stairwright.storage.studies import StudyRecord

from .progress import Progress


class Following:
    """One study or search in memory: its job, and the cells that came since it is followed."""

    def __init__(self, record: StudyRecord) -> None:
        self.record = record
        self.job = Job(record.id, "design" if record.is_search else "study", owner=record.owner)
        self.progress = Progress(record.done, record.total)
        self.stage = ""  # what is done before its work begins
        self.blocks: list[bytes] = []  # JSON, in the order in which they came
        self.deaths = 0
        self.retry = False
        if record.state not in ("queued", "running"):
            self.job.finish(record.state, error=record.error)  # type: ignore[arg-type]

    def hear(self, report: Mapping[str, Any]) -> None:
        """Take in what the runner tells while it is at it."""
        total = report["total"] or self.progress.total
        self.progress = Progress(report["done"], total, report["left"], report["partly"])
        if report["cells"] is not None:
            self.blocks.append(orjson.dumps(report["cells"]))
        self.job.advance(self.progress.share)

    @property
    def eta(self) -> float | None:
        """Seconds until it is done, as far as its own pace can tell."""
        left = self.progress.left if self.job.state == "running" else None
        return None if left is None else round(left, 1)

    def as_record(self) -> StudyRecord:
        """What is written down of it now."""
        job, done, total = self.job, self.progress.done, self.progress.total
        return replace(self.record, state=job.state, error=job.error, done=done, total=total)
