"""Documents that users saved under names of their own: terrains and robots."""

from __future__ import annotations

import time
from typing import Any, Generic, TypeVar

from sqlalchemy import func, select
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.orm import Session, sessionmaker

from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

from .tables import SavedRobot, SavedTerrain

D = TypeVar("D", Terrain, Robot)


class Saved(Generic[D]):
    """Documents of one kind by name."""

    def __init__(self, sessions: sessionmaker[Session], table: Any, model: type[D]) -> None:
        self._sessions = sessions
        self._table = table
        self._model: type[D] = model

    def all(self) -> list[D]:
        """All of them, by name."""
        with self._sessions() as session:
            rows = session.scalars(select(self._table).order_by(self._table.name))
            return [self._model.model_validate_json(row.document) for row in rows]

    def names(self) -> list[str]:
        """Their names in order."""
        with self._sessions() as session:
            return list(session.scalars(select(self._table.name).order_by(self._table.name)))

    def count(self) -> int:
        """How many there are."""
        with self._sessions() as session:
            return session.scalar(select(func.count()).select_from(self._table)) or 0

    def get(self, name: str) -> D | None:
        """One of them, None if there is none of that name."""
        with self._sessions() as session:
            row = session.get(self._table, name)
            return None if row is None else self._model.model_validate_json(row.document)

    def put(self, document: D) -> bool:
        """Save it under its name; True if that name is new."""
        values = {"document": document.model_dump_json(), "updated": time.time()}
        statement = insert(self._table).values(name=document.name, **values)
        with self._sessions.begin() as session:
            new = session.get(self._table, document.name) is None
            session.execute(statement.on_conflict_do_update(index_elements=["name"], set_=values))
            return new

    def delete(self, name: str) -> bool:
        """Remove it; False if there is none of that name."""
        with self._sessions.begin() as session:
            row = session.get(self._table, name)
            if row is not None:
                session.delete(row)
            return row is not None


def saved_terrains(sessions: sessionmaker[Session]) -> Saved[Terrain]:
    """Terrains by name."""
    return Saved(sessions, SavedTerrain, Terrain)


def saved_robots(sessions: sessionmaker[Session]) -> Saved[Robot]:
    """Robots by name."""
    return Saved(sessions, SavedRobot, Robot)
