"""Idempotency keys: a request that is sent twice does its work once."""

from __future__ import annotations

import time
from enum import Enum

from sqlalchemy import delete
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.orm import Session, sessionmaker

from .tables import IdempotencyRecord


class Verdict(Enum):
    """What to do with a request that brings a key."""

    NEW = "do the work"
    SEEN = "answer as the first time"
    BUSY = "the first request is still at work"
    OTHER = "the key was used for another request"


class IdempotencyKeys:
    """Keys by scope (the route) and key."""

    def __init__(self, sessions: sessionmaker[Session]) -> None:
        self._sessions = sessions

    def begin(self, scope: str, key: str, fingerprint: str) -> tuple[Verdict, str | None]:
        """Claim a key; if it was claimed before, say with what result."""
        values = {"fingerprint": fingerprint, "created": time.time()}
        claim = insert(IdempotencyRecord).values(scope=scope, key=key, **values)
        with self._sessions.begin() as session:
            claimed = session.execute(
                claim.on_conflict_do_nothing().returning(IdempotencyRecord.key)
            ).first()
            if claimed is not None:
                return Verdict.NEW, None
            row = session.get_one(IdempotencyRecord, (scope, key))
            if row.fingerprint != fingerprint:
                return Verdict.OTHER, None
            return (Verdict.BUSY, None) if row.result is None else (Verdict.SEEN, row.result)

    def finish(self, scope: str, key: str, result: str) -> None:
        """Remember what the request led to."""
        with self._sessions.begin() as session:
            row = session.get(IdempotencyRecord, (scope, key))
            if row is not None:
                row.result = result

    def release(self, scope: str, key: str) -> None:
        """Forget a key whose request failed, so that it can be tried again."""
        with self._sessions.begin() as session:
            row = session.get(IdempotencyRecord, (scope, key))
            if row is not None and row.result is None:
                session.delete(row)

    def release_unfinished(self) -> None:
        """Forget claims of a process that has died."""
        with self._sessions.begin() as session:
            session.execute(delete(IdempotencyRecord).where(IdempotencyRecord.result.is_(None)))
