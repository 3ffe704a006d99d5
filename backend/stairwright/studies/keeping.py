"""Which store answers a study: its own, a shorter one of the same family, or a new one."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from stairwright.errors import InputError
from stairwright.resources import default_data_folder
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

from .document import Study
from .store import SUFFIX, ResultStore

FOLDER = "studies"
_GIVEN = (
    "friction", "method", "weights", "compute", "diagnose", "controller", "seed", "trials",
)  # fmt: skip


def studies_folder() -> Path:
    """Where studies are kept that name no place."""
    named = os.environ.get("STAIRWRIGHT_DATA")
    if named:
        return Path(named).expanduser() / FOLDER
    try:
        return default_data_folder() / FOLDER
    except InputError:  # a user without a home
        return Path(tempfile.gettempdir()) / "stairwright" / FOLDER


def kept_store(study: Study, name: str, engine: str, path: Path | None) -> ResultStore:
    """The store of the study called `name`, in the data folder or at `path`.

    A new one takes over every cell that a study of the same family, by the same code, knows.

    Raises:
        InputError: If `path` holds something else; says what is out of date, if that is why.
    """
    if path is None:
        folder = studies_folder()
        own = folder / f"{name}{SUFFIX}"
        if own.exists():
            return ResultStore(own)
        made = ResultStore.create(own, study, engine)
        for other in relatives(folder, study, engine, own):
            made.adopt(other)
        return made
    if path.suffix.lower() != SUFFIX:
        raise InputError(f"must end in {SUFFIX}", ("store",))
    if not path.exists():
        return ResultStore.create(path, study, engine)
    there = ResultStore(path)
    if there.id == name:
        return there
    if there.study.family != study.family or there.engine != engine:
        why = outdated(there, study, engine) or ["it is another study"]
        raise InputError(f"{path} does not fit: {'; '.join(why)}. Remove it, or name another place")
    aside = path.with_name(f".{path.name}.extended")
    shutil.rmtree(aside, ignore_errors=True)
    ResultStore.create(aside, study, engine).adopt(there)
    shutil.rmtree(path)
    aside.rename(path)
    return ResultStore(path)


def relatives(folder: Path, study: Study, engine: str, own: Path) -> Iterator[ResultStore]:
    """Other stores that share cells with a study."""
    for path in sorted(folder.glob(f"*{SUFFIX}")):
        if path == own:
            continue
        try:
            other = ResultStore(path)
        except InputError:
            continue
        if other.study.family == study.family and other.engine == engine:
            yield other


def outdated(store: ResultStore, study: Study, engine: str) -> list[str]:
    """What has changed since the results of a study like this were made, a sentence each."""
    old, out = store.study, []
    if [axis.name for axis in old.axes] != [axis.name for axis in study.axes]:
        return []
    before, now = _robots(old), _robots(study)
    if before != now:
        changed = [name for name, mark in now.items() if before.get(name, mark) != mark]
        out.append(f"the robot {', '.join(changed)} is out of date" if changed else
                   f"it is about {', '.join(before)}, not {', '.join(now)}")  # fmt: skip
    if _ground(old) != _ground(study):
        out.append("the terrain is out of date")
    given = [name for name in _GIVEN if getattr(old, name) != getattr(study, name)]
    if given:
        out.append(f"other values of {', '.join(given)} were asked for")
    if store.engine != engine:
        out.append("it was made by another version of the planner")
    return out


def _robots(study: Study) -> dict[str, str]:
    assert isinstance(study.robot, Robot)
    robots = {study.robot.name: study.robot.hash}
    return robots | {name: robot.hash for name, robot in study.robots.items()}


def _ground(study: Study) -> object:
    return study.terrain.hash if isinstance(study.terrain, Terrain) else study.terrain
