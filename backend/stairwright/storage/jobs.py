"""Jobs: their last known state, so that a link to one works after a restart."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import select, update
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.orm import Session, sessionmaker

from .tables import StoredJob

UNFINISHED = ("queued", "running")


@dataclass(frozen=True)
class JobRecord:
    """A job as it was last written down."""

    id: str
    kind: str
    state: str
    result: str | None
    error: Mapping[str, Any] | None


class JobLog:
    """Jobs by id."""

    def __init__(self, sessions: sessionmaker[Session]) -> None:
        self._sessions = sessions

    def put(self, job: JobRecord) -> None:
        """Write a job's state down."""
        now = time.time()
        values: dict[str, Any] = {
            "kind": job.kind,
            "state": job.state,
            "result": job.result,
            "error": None if job.error is None else json.dumps(dict(job.error)),
            "updated": now,
        }
        statement = insert(StoredJob).values(id=job.id, created=now, **values)
        with self._sessions.begin() as session:
            session.execute(statement.on_conflict_do_update(index_elements=["id"], set_=values))

    def get(self, job_id: str) -> JobRecord | None:
        """A job, None if it is not known (any more)."""
        with self._sessions() as session:
            row = session.get(StoredJob, job_id)
            if row is None:
                return None
            error = None if row.error is None else json.loads(row.error)
            return JobRecord(row.id, row.kind, row.state, row.result, error)

    def interrupt(self, error: Mapping[str, Any]) -> int:
        """Fail what a process that has died left unfinished; returns how many."""
        unfinished = StoredJob.state.in_(UNFINISHED)
        values = {"state": "failed", "error": json.dumps(dict(error)), "updated": time.time()}
        with self._sessions.begin() as session:
            ids = session.scalars(select(StoredJob.id).where(unfinished)).all()
            session.execute(update(StoredJob).where(unfinished).values(**values))
            return len(ids)
