"""Studies and searches for designs: what was asked, how far it is; results have a folder each."""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from sqlalchemy import func, select, update
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.orm import Session, sessionmaker

from .jobs import UNFINISHED
from .tables import StoredStudy

SUFFIX = ".zarr"
SEARCH = "d-"  # begins ids of searches for designs; those of studies begin with s-
SHARE = 0.25  # of the room for results that studies may take


@dataclass(frozen=True)
class StudyRecord:
    """A study, or a search for designs, as it was last written down.

    Attributes:
        document: Its JSON, names resolved.
        engine: Fingerprint of the code that its cells are by.
        error: A problem document, where it failed.
        done, total: Cells; of a search, designs.
        losses: How often whoever was at it was gone.
        created: Seconds since 1970.
    """

    id: str
    name: str
    document: str
    engine: str
    state: str = "queued"
    error: Mapping[str, Any] | None = None
    owner: str = ""
    done: int = 0
    total: int = 0
    size: int = 0
    losses: int = 0
    created: float = field(default_factory=time.time)

    @property
    def is_search(self) -> bool:
        """Whether it looks for designs."""
        return self.id.startswith(SEARCH)


class StudyShelf:
    """Studies by id."""

    def __init__(self, sessions: sessionmaker[Session], folder: Path) -> None:
        self._sessions = sessions
        self.folder = folder

    def path(self, study_id: str) -> Path:
        """Where its cells, or a search's studies and result, lie or would lie."""
        return self.folder / (study_id if study_id.startswith(SEARCH) else f"{study_id}{SUFFIX}")

    def put(self, record: StudyRecord) -> None:
        """Write one down as it is now."""
        error = None if record.error is None else json.dumps(dict(record.error))
        values = asdict(record) | {"error": error, "used": time.time()}
        statement = insert(StoredStudy).values(values)
        with self._sessions.begin() as session:
            session.execute(statement.on_conflict_do_update(index_elements=["id"], set_=values))

    def measure(self, study_id: str) -> None:
        """Note what its cells take on disk."""
        size = sum(each.stat().st_size for each in self.path(study_id).rglob("*") if each.is_file())
        with self._sessions.begin() as session:
            mine = StoredStudy.id == study_id
            session.execute(update(StoredStudy).where(mine).values(size=size))

    def get(self, study_id: str) -> StudyRecord | None:
        """One, None if there is none (any more)."""
        with self._sessions() as session:
            row = session.get(StoredStudy, study_id)
            return None if row is None else _record(row)

    def unfinished(self) -> list[StudyRecord]:
        """Those that a process before this one left unfinished, the oldest first."""
        order = (StoredStudy.state.desc(), StoredStudy.created)
        query = select(StoredStudy).where(StoredStudy.state.in_(UNFINISHED)).order_by(*order)
        with self._sessions() as session:
            return [_record(row) for row in session.scalars(query)]

    def page(self, limit: int, offset: int) -> tuple[Sequence[StudyRecord], int]:
        """Studies, newest first: `limit` after `offset`, and how many there are in all."""
        newest = (StoredStudy.created.desc(), StoredStudy.id)
        asked = ~StoredStudy.id.startswith(SEARCH)
        query = select(StoredStudy).where(asked).order_by(*newest).limit(limit).offset(offset)
        with self._sessions() as session:
            count = select(func.count()).select_from(StoredStudy).where(asked)
            return [_record(row) for row in session.scalars(query)], session.scalar(count) or 0

    def searches(self) -> list[StudyRecord]:
        """All searches for designs."""
        query = select(StoredStudy).where(StoredStudy.id.startswith(SEARCH))
        with self._sessions() as session:
            return [_record(row) for row in session.scalars(query)]

    def delete(self, study_id: str) -> bool:
        """Remove one with its folder; False if there is none."""
        with self._sessions.begin() as session:
            row = session.get(StoredStudy, study_id)
            if row is not None:
                session.delete(row)
        shutil.rmtree(self.path(study_id), ignore_errors=True)
        return row is not None

    def make_room(self, keep_bytes: int) -> int:
        """Remove finished studies that were not used for longest until the rest fits; how many."""
        room, gone = SHARE * keep_bytes, []
        with self._sessions() as session:
            latest = select(StoredStudy).order_by(StoredStudy.used.desc())
            for row in session.scalars(latest):
                room -= row.size
                if room < 0 and row.state not in UNFINISHED:
                    gone.append(row.id)
        for study_id in gone:
            self.delete(study_id)
        return len(gone)


def _record(row: StoredStudy) -> StudyRecord:
    names = [name for name in StudyRecord.__dataclass_fields__ if name != "error"]
    error = None if row.error is None else json.loads(row.error)
    return StudyRecord(**{name: getattr(row, name) for name in names}, error=error)
