"""Plans, rollouts and sets of trials: found by id or by the question that they answer."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, cast, get_args

from sqlalchemy import Engine, Select, Table, bindparam, delete, func, or_, select, update
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.orm import sessionmaker

from .artefacts import Artefacts
from .clock import UseClock
from .tables import StoredDocument

Kind = Literal["plan", "rollout", "trials", "margins"]
_SEARCHED = ("terrain", "robot", "method", "status", "outcome")  # of summaries
_FRESH = 3600.0  # s; a use is written down again only after this time


# Built once, without the session's bookkeeping: somebody waits for these.
_ROWS = cast(Table, StoredDocument.__table__)
_BY_ID = select(_ROWS).where(_ROWS.c.id == bindparam("id"), _ROWS.c.kind == bindparam("kind"))
_BY_QUESTION = (
    select(_ROWS)
    .where(*(_ROWS.c[name] == bindparam(name) for name in ("question", "engine", "kind")))
    .limit(1)
)
_USERS = ("name", "note", "pinned")  # what users say of it: not part of the answer
_ANSWER = [column.name for column in _ROWS.c if column.name not in _USERS]
_NEW = insert(_ROWS).values({name: bindparam(name) for name in _ANSWER})
_PUT = _NEW.on_conflict_do_update(
    index_elements=["id"],
    set_={name: _NEW.excluded[name] for name in _ANSWER if name != "id"},
)


@dataclass(frozen=True)
class Entry:
    """What is known of a document without opening it."""

    id: str
    kind: str
    digest: str
    size: int
    summary: Mapping[str, Any]
    created: float
    name: str = ""
    note: str = ""
    pinned: bool = False


def _entry(row: Any) -> Entry:
    summary = json.loads(row.summary)
    users = (getattr(row, name) for name in _USERS)
    return Entry(row.id, row.kind, row.digest, row.size, summary, row.created, *users)


class Documents:
    """The shelf of plans and rollouts."""

    def __init__(self, engine: Engine, artefacts: Artefacts, *, fixed: bool = False) -> None:
        """`fixed`: nothing can be written, not even that something was used."""
        self._fixed = fixed
        self._engine = engine
        self._sessions = sessionmaker(engine, expire_on_commit=False)
        self._artefacts = artefacts
        with engine.connect() as connection:
            newest = connection.execute(select(func.max(_ROWS.c.used))).scalar()
        self._clock = UseClock(newest or 0.0)

    def get(self, kind: Kind, document_id: str) -> Entry | None:
        """The document of this id, None if there is none (any more)."""
        return self._find(_BY_ID, id=document_id, kind=kind)

    def answer(self, kind: Kind, question: str, engine: str) -> Entry | None:
        """A stored answer to the same question by the same code, its content undamaged."""
        entry = self._find(_BY_QUESTION, question=question, engine=engine, kind=kind)
        return entry if entry is not None and self._artefacts.intact(entry.digest) else None

    def content(self, kind: Kind, question: str, engine: str) -> tuple[Entry, bytes] | None:
        """The same with its gzipped JSON, which is read only once."""
        entry = self._find(_BY_QUESTION, question=question, engine=engine, kind=kind)
        try:
            return None if entry is None else (entry, self._artefacts.packed(entry.digest))
        except FileNotFoundError:  # damaged, or removed this very moment
            return None

    def _find(self, statement: Select[Any], **values: str) -> Entry | None:
        with self._engine.connect() as connection:
            row = connection.execute(statement, values).first()
            if row is None or not self._artefacts.has(row.digest):
                return None
            now = self._clock.now()
            if now - row.used > _FRESH and not self._fixed:
                used = update(_ROWS).where(_ROWS.c.id == row.id).values(used=now)
                connection.execute(used)
                connection.commit()
            return _entry(row)

    def put(
        self,
        kind: Kind,
        document_id: str,
        *,
        question: str,
        engine: str,
        digest: str,
        size: int,
        summary: Mapping[str, Any],
    ) -> Entry:
        """Write down a document whose content is among the artefacts already."""
        now = time.time()
        values: dict[str, Any] = {
            "id": document_id,
            "kind": kind,
            "question": question,
            "engine": engine,
            "digest": digest,
            "size": size,
            "summary": json.dumps(dict(summary)),
            "created": now,
            "used": self._clock.now(),
        }
        with self._engine.begin() as connection:
            connection.execute(_PUT, values)
        return Entry(document_id, kind, digest, size, dict(summary), now)

    def resize(self, sizes: Mapping[str, int]) -> None:
        """Correct what artefacts take on disk [bytes], by digest."""
        with self._sessions.begin() as session:
            for digest, size in sizes.items():
                mine = StoredDocument.digest == digest
                session.execute(update(StoredDocument).where(mine).values(size=size))

    def annotate(self, kind: Kind, document_id: str, **said: str | bool) -> Entry | None:
        """Note `name`, `note` or `pinned`; the entry as it is then, None if there is none."""
        mine = (StoredDocument.id == document_id, StoredDocument.kind == kind)
        with self._sessions.begin() as session:
            row = session.scalar(select(StoredDocument).where(*mine))
            if row is None:
                return None
            for name in said.keys() & set(_USERS):
                setattr(row, name, said[name])
            return _entry(row)

    def page(
        self,
        kind: Kind,
        limit: int,
        offset: int,
        search: str = "",
        pinned: bool | None = None,
    ) -> tuple[Sequence[Entry], int]:
        """Newest first: `limit` entries after `offset`, and how many there are in all.

        Each word of `search` stands in a name, a note, or one of the summary's words.
        """
        mine = [StoredDocument.kind == kind]
        if pinned is not None:
            mine.append(StoredDocument.pinned == pinned)
        for word in search.split():
            places: list[Any] = [StoredDocument.name, StoredDocument.note]
            places += [func.json_extract(StoredDocument.summary, f"$.{key}") for key in _SEARCHED]
            mine.append(or_(*(place.icontains(word, autoescape=True) for place in places)))
        newest = (StoredDocument.created.desc(), StoredDocument.id)
        with self._sessions() as session:
            query = select(StoredDocument).where(*mine).order_by(*newest)
            query = query.limit(limit).offset(offset)
            counted = select(func.count()).select_from(StoredDocument).where(*mine)
            total = session.scalar(counted) or 0
            return [_entry(row) for row in session.scalars(query)], total

    def totals(self) -> tuple[dict[str, int], int]:
        """How many there are of each kind, and what they take on disk [bytes]."""
        mine = (StoredDocument.kind, func.count(), func.sum(StoredDocument.size))
        with self._sessions() as session:
            rows = session.execute(select(*mine).group_by(StoredDocument.kind)).all()
        counts = dict.fromkeys(get_args(Kind), 0) | {kind: number for kind, number, _ in rows}
        return counts, sum(size for _, _, size in rows)

    def delete(self, kind: Kind, document_id: str) -> str | None:
        """Remove one; returns the digest of its content, None if there is none of that id."""
        mine = (StoredDocument.id == document_id, StoredDocument.kind == kind)
        statement = delete(StoredDocument).where(*mine).returning(StoredDocument.digest)
        with self._sessions.begin() as session:
            digest: str | None = session.scalar(statement)
            return digest

    def digests(self) -> set[str]:
        """Artefacts that are referred to."""
        with self._sessions() as session:
            return set(session.scalars(select(StoredDocument.digest)))
