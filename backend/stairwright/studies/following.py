"""How far a study has come, for who follows it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import orjson

from stairwright.jobs.job import Job
from stairwright.storage.studies import StudyRecord


class Following:
    """One study or search in memory: its job, and the cells that came since it is followed."""

    def __init__(self, record: StudyRecord) -> None:
        self.record = record
        self.job = Job(record.id, "design" if record.is_search else "study", owner=record.owner)
        self.done, self.total = record.done, record.total
        self.share = record.done / record.total if record.total else 0.0  # of all the work
        self.left: float | None = None
        self.stage = ""  # what is done before its work begins
        self.blocks: list[bytes] = []  # JSON, in the order in which they came
        self.deaths = 0
        self.retry = False
        if record.state not in ("queued", "running"):
            self.job.finish(record.state, error=record.error)  # type: ignore[arg-type]

    def hear(self, report: Mapping[str, Any]) -> None:
        """Take in what the runner tells while it is at it."""
        self.done = int(report["done"])
        self.total = int(report["total"]) or self.total
        self.left = report["left"]
        self.share = report.get("share", self.done / self.total if self.total else 0.0)
        if report["cells"] is not None:
            self.blocks.append(orjson.dumps(report["cells"]))
        self.job.advance(self.share)

    @property
    def eta(self) -> float | None:
        """Seconds until it is done, as far as its own pace can tell."""
        running = self.job.state == "running"
        return round(self.left, 1) if running and self.left is not None else None

    def as_record(self) -> StudyRecord:
        """What is written down of it now."""
        job = self.job
        return replace(
            self.record, state=job.state, error=job.error, done=self.done, total=self.total
        )
