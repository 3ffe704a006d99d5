"""What is removed, and why: for room only, never for age. Terrains that users saved always stay."""

from __future__ import annotations

from sqlalchemy import Integer, delete, literal_column, select
from sqlalchemy.orm import Session, sessionmaker

from .jobs import UNFINISHED
from .tables import IdempotencyRecord, StoredDocument, StoredJob

KEPT_JOBS = 20_000  # finished ones, about 10 MB
KEPT_KEYS = 20_000  # a client repeats a request within minutes
_ORDER = literal_column("rowid", Integer)  # in which rows came, whatever the clock said


def make_room(sessions: sessionmaker[Session], keep_bytes: int) -> set[str]:
    """Remove the results that were not used for longest until the rest fits; pinned ones stay.

    Returns the digests of their contents that nobody refers to any more.
    """
    gone: list[StoredDocument] = []
    kept = 0
    with sessions.begin() as session:
        latest = select(StoredDocument).order_by(
            StoredDocument.pinned.desc(), StoredDocument.used.desc()
        )
        rows = session.scalars(latest).all()
        for row in rows:
            if kept + row.size > keep_bytes and not row.pinned:
                session.delete(row)
                gone.append(row)
            else:
                kept += row.size
        return {row.digest for row in gone} - {row.digest for row in rows if row not in gone}


def trim_records(
    sessions: sessionmaker[Session], jobs: int = KEPT_JOBS, keys: int = KEPT_KEYS
) -> None:
    """Remove the oldest finished jobs and idempotency keys beyond so many."""
    finished = StoredJob.state.not_in(UNFINISHED)
    with sessions.begin() as session:
        old_jobs = select(_ORDER).where(finished).order_by(_ORDER.desc()).offset(jobs)
        newest = session.scalar(old_jobs.select_from(StoredJob).limit(1))
        if newest is not None:
            session.execute(delete(StoredJob).where(finished, newest >= _ORDER))
        old_keys = select(_ORDER).order_by(_ORDER.desc()).offset(keys)
        newest = session.scalar(old_keys.select_from(IdempotencyRecord).limit(1))
        if newest is not None:
            session.execute(delete(IdempotencyRecord).where(newest >= _ORDER))
