"""Terrains that users saved."""

from __future__ import annotations

import time

from sqlalchemy import func, select
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.orm import Session, sessionmaker

from stairwright.terrain.profile import Terrain

from .tables import SavedTerrain


class SavedTerrains:
    """Terrains by name."""

    def __init__(self, sessions: sessionmaker[Session]) -> None:
        self._sessions = sessions

    def all(self) -> list[Terrain]:
        """All of them, by name."""
        with self._sessions() as session:
            rows = session.scalars(select(SavedTerrain).order_by(SavedTerrain.name))
            return [Terrain.model_validate_json(row.document) for row in rows]

    def names(self) -> list[str]:
        """Their names in order."""
        with self._sessions() as session:
            return list(session.scalars(select(SavedTerrain.name).order_by(SavedTerrain.name)))

    def count(self) -> int:
        """How many there are."""
        with self._sessions() as session:
            return session.scalar(select(func.count()).select_from(SavedTerrain)) or 0

    def get(self, name: str) -> Terrain | None:
        """One of them, None if there is none of that name."""
        with self._sessions() as session:
            row = session.get(SavedTerrain, name)
            return None if row is None else Terrain.model_validate_json(row.document)

    def put(self, terrain: Terrain) -> bool:
        """Save it under its name; True if that name is new."""
        values = {"document": terrain.model_dump_json(), "updated": time.time()}
        statement = insert(SavedTerrain).values(name=terrain.name, **values)
        with self._sessions.begin() as session:
            new = session.get(SavedTerrain, terrain.name) is None
            session.execute(statement.on_conflict_do_update(index_elements=["name"], set_=values))
            return new

    def delete(self, name: str) -> bool:
        """Remove it; False if there is none of that name."""
        with self._sessions.begin() as session:
            row = session.get(SavedTerrain, name)
            if row is not None:
                session.delete(row)
            return row is not None
