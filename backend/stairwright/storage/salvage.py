"""What can be read of a damaged database."""

from __future__ import annotations

import contextlib
import json
import sqlite3
from collections.abc import Iterator, Mapping
from pathlib import Path

from sqlalchemy import Engine

from stairwright.documents import Model
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

from .tables import Base, SavedRobot, SavedTerrain

SET_ASIDE = ".damaged-"
_SUFFIXES = ("", "-wal", "-shm")
_MODELS: dict[str, type[Model]] = {
    SavedTerrain.__tablename__: Terrain,
    SavedRobot.__tablename__: Robot,
}
_JSON = frozenset({"document", "summary", "error"})  # columns


def set_aside(database: Path) -> Path:
    """Rename a database and what belongs to it; returns its new name."""
    number = 1
    while (kept := database.with_name(f"{database.name}{SET_ASIDE}{number}")).exists():
        number += 1
    for suffix in _SUFFIXES:
        with contextlib.suppress(FileNotFoundError):
            database.with_name(database.name + suffix).rename(kept.with_name(kept.name + suffix))
    return kept


def was_set_aside(database: Path) -> bool:
    """Whether a damaged one still lies beside it."""
    return any(database.parent.glob(f"{database.name}{SET_ASIDE}*"))


def salvage(damaged: Path, into: Engine) -> dict[str, int]:
    """Copy the rows that can be read into a new database; how many, by table."""
    taken: dict[str, int] = {}
    source = sqlite3.connect(damaged)
    with contextlib.closing(source), into.begin() as target:
        for table in Base.metadata.sorted_tables:
            known = {column.name for column in table.columns}
            taken[table.name] = 0
            for row in _rows(source, table.name):
                if not _is_whole(table.name, row):
                    continue
                fitting = {name: value for name, value in row.items() if name in known}
                insert = table.insert().prefix_with("OR IGNORE").values(fitting)
                taken[table.name] += target.execute(insert).rowcount
    return taken


def _is_whole(table: str, row: Mapping[str, object]) -> bool:
    """Whether what should be JSON is JSON, a terrain a terrain, and a robot a robot."""
    try:
        for name in _JSON & row.keys():
            if row[name] is not None:
                json.loads(str(row[name]))
        if table in _MODELS:
            _MODELS[table].model_validate_json(str(row["document"]))
    except ValueError:
        return False
    return True


def _rows(source: sqlite3.Connection, table: str) -> Iterator[dict[str, object]]:
    """From the front up to the first damage, then from the back."""
    for order in ("", " ORDER BY rowid DESC"):
        try:
            cursor = source.execute(f'SELECT * FROM "{table}"{order}')  # noqa: S608 - our own name
            names = [column[0] for column in cursor.description]
            for row in cursor:
                yield dict(zip(names, row, strict=True))
        except sqlite3.DatabaseError:
            continue
        return
