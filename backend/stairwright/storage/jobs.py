"""Jobs: their last known state and, while unfinished, what they ask, so that they outlive us."""

from __future__ import annotations

import json
import time
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy import ColumnElement, delete, exists, func, select
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.orm import Session, sessionmaker

from .tables import JobQuestion, StoredJob

UNFINISHED = ("queued", "running")


@dataclass(frozen=True)
class JobRecord:
    """A job as it was last written down.

    Attributes:
        question: Key of what it asks, while it is unfinished.
        owner: Who asked.
        deaths: How many workers have died at it.
        losses: How often the service was gone while it ran.
        revision: How often it had changed.
        created: Seconds since 1970.
    """

    id: str
    kind: str
    state: str
    result: str | None
    error: Mapping[str, Any] | None
    question: str | None = None
    owner: str = ""
    deaths: int = 0
    losses: int = 0
    revision: int = 1
    created: float = field(default_factory=time.time, compare=False)


class JobLog:
    """Jobs by id."""

    def __init__(self, sessions: sessionmaker[Session]) -> None:
        self._sessions = sessions

    def question(self, key: str) -> dict[str, Any] | None:
        """What was asked under a key, None if it is not known (any more)."""
        with self._sessions() as session:
            row = session.get(JobQuestion, key)
            return None if row is None else json.loads(row.document)

    def needed(self) -> set[str]:
        """Digests of artefacts that unfinished jobs refer to."""
        with self._sessions() as session:
            found = session.scalars(select(JobQuestion.needs).where(JobQuestion.needs.is_not(None)))
            return {digest for digest in found if digest is not None}

    def put(
        self, job: JobRecord, asks: Mapping[str, Any] | None = None, needs: str | None = None
    ) -> None:
        """Write a job's state down; a question that no unfinished job asks goes.

        Args:
            job: The job.
            asks: The whole question, the first time.
            needs: Digest of the artefact that the question refers to.
        """
        values: dict[str, Any] = {
            "kind": job.kind,
            "state": job.state,
            "result": job.result,
            "error": None if job.error is None else json.dumps(dict(job.error)),
            "updated": time.time(),
            "question": job.question if job.state in UNFINISHED else None,
            "owner": job.owner,
            "deaths": job.deaths,
            "losses": job.losses,
            "revision": job.revision,
        }
        statement = insert(StoredJob).values(id=job.id, created=job.created, **values)
        with self._sessions.begin() as session:
            if asks is not None:
                row = {"key": job.question, "document": json.dumps(dict(asks)), "needs": needs}
                session.execute(insert(JobQuestion).values(row).on_conflict_do_nothing())
            session.execute(statement.on_conflict_do_update(index_elements=["id"], set_=values))
            if job.question is not None and job.state not in UNFINISHED:
                asked = exists().where(StoredJob.question == job.question)
                session.execute(delete(JobQuestion).where(JobQuestion.key == job.question, ~asked))

    def get(self, job_id: str) -> JobRecord | None:
        """A job, None if it is not known (any more)."""
        with self._sessions() as session:
            row = session.get(StoredJob, job_id)
            return None if row is None else _record(row)

    def unfinished(self) -> list[JobRecord]:
        """Jobs that a process before this one left unfinished: those that ran, then the oldest."""
        order = (StoredJob.state.desc(), StoredJob.created, StoredJob.id)
        query = select(StoredJob).where(StoredJob.state.in_(UNFINISHED)).order_by(*order)
        with self._sessions() as session:
            return [_record(row) for row in session.scalars(query)]

    def page(
        self, limit: int, offset: int, states: Collection[str] = (), kinds: Collection[str] = ()
    ) -> tuple[Sequence[JobRecord], int]:
        """Newest first: `limit` jobs after `offset`, and how many there are in all.

        Of the given states and kinds, where some are given.
        """
        wanted: list[ColumnElement[bool]] = []
        if states:
            wanted.append(StoredJob.state.in_(states))
        if kinds:
            wanted.append(StoredJob.kind.in_(kinds))
        newest = (StoredJob.created.desc(), StoredJob.id)
        query = select(StoredJob).where(*wanted).order_by(*newest).limit(limit).offset(offset)
        counted = select(func.count()).select_from(StoredJob).where(*wanted)
        with self._sessions() as session:
            return [_record(row) for row in session.scalars(query)], session.scalar(counted) or 0


def _record(row: StoredJob) -> JobRecord:
    return JobRecord(
        row.id,
        row.kind,
        row.state,
        row.result,
        None if row.error is None else json.loads(row.error),
        row.question,
        row.owner,
        row.deaths,
        row.losses,
        row.revision,
        row.created,
    )
