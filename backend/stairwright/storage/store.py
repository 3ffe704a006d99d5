"""One object for all that is kept, made of one shelf a kind."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from sqlalchemy import Engine, text
from sqlalchemy.orm import sessionmaker

from .artefacts import Artefacts
from .clock import last_written
from .documents import Documents, Entry, Kind
from .housekeeping import make_room, trim_records
from .idempotency import IdempotencyKeys
from .jobs import JobLog
from .opening import open_soundly
from .salvage import was_set_aside
from .saved import saved_robots, saved_terrains
from .studies import StudyShelf

DATABASE = "stairwright.sqlite"


class Store:
    """The data folder. Thread-safe; every call is one transaction.

    Raises:
        InputError: If the folder cannot be used.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.last_written = last_written(folder / DATABASE)  # [s], None for a new folder
        self.engine: Engine
        self.engine, self.read_only = open_soundly(folder / DATABASE)  # why nothing can be saved
        self._sessions = sessions = sessionmaker(self.engine, expire_on_commit=False)
        self.artefacts = Artefacts(folder / "artefacts")
        self.terrains = saved_terrains(sessions)
        self.robots = saved_robots(sessions)
        self.documents = Documents(self.engine, self.artefacts, fixed=self.read_only is not None)
        self._unsettled = set(self.artefacts.unsettled())  # a process that died may leave some
        self.jobs = JobLog(sessions)
        self.studies = StudyShelf(sessions, folder / "studies")
        self.observe: Callable[[Entry], None] = lambda _: None  # called with each new result
        self.idempotency = IdempotencyKeys(sessions)

    def ready(self) -> bool:
        """Whether the database answers."""
        with self.engine.connect() as connection:
            return bool(connection.execute(text("SELECT 1")).scalar())

    def collect(self, keep_bytes: int) -> int:
        """Remove what is too much; returns how many results went. Age is no reason."""
        trim_records(self._sessions)
        studies = self.studies.make_room(keep_bytes)
        removed = make_room(self._sessions, keep_bytes)
        needed = self.jobs.needed()
        for digest in removed:
            if digest not in needed:
                self.artefacts.remove(digest)
        if not was_set_aside(self.folder / DATABASE):  # which may refer to any of them
            self.artefacts.sweep(self.documents.digests() | needed)
        return len(removed) + studies

    def delete(self, kind: Kind, document_id: str) -> bool:
        """Remove a plan or a rollout; False if there is none of that id.

        Its content goes at once, unless another document or an unfinished job needs it still.
        """
        digest = self.documents.delete(kind, document_id)
        if digest is not None and digest not in self.documents.digests() | self.jobs.needed():
            self._unsettled.discard(digest)
            self.artefacts.remove(digest)
        return digest is not None

    def shelve(self, kind: Kind, document_id: str, **values: Any) -> Entry:
        """Write down a document whose content was put among the artefacts; it will be settled.

        Keywords as in `Documents.put`.
        """
        entry = self.documents.put(kind, document_id, **values)
        self.observe(entry)
        self._unsettled.add(entry.digest)
        return entry

    def settle(self) -> int:
        """Compress new artefacts and force them to the disk; how many there were."""
        sizes: dict[str, int] = {}
        while self._unsettled:
            digest = self._unsettled.pop()
            try:
                size = self.artefacts.settle(digest)
            except OSError:
                self._unsettled.add(digest)  # next time
                raise
            if size is not None:
                sizes[digest] = size
        if sizes:
            self.documents.resize(sizes)
        return len(sizes)

    def close(self) -> None:
        """Close all connections; SQLite folds its log into the file."""
        self.engine.dispose()
