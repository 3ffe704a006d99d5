"""Names become documents, so that a study means the same everywhere and for ever."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from stairwright import library
from stairwright.documents import load_document, parse
from stairwright.errors import InputError
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

from .document import Study
from .targets import implied_terrain, target

FindTerrain = Callable[[Any], Terrain]
FindRobot = Callable[[Any], Robot]


def load_study(source: str | Path | Mapping[str, Any] | Study) -> Study:
    """A study from a file, a mapping or a `Study`, its names resolved and every axis checked.

    Raises:
        InputError: If it is none; its path names the field.
    """
    if isinstance(source, Study):
        study = source
    elif isinstance(source, Mapping):
        study = parse(Study, dict(source))
    elif not isinstance(source, (str, Path)):
        raise InputError("must be a study's document, or the name of its file", ("study",))
    else:
        study = load_document(Study, Path(source))
    return resolve(study, library.load_terrain, library.load_robot)


def resolve(
    study: Study, find_terrain: FindTerrain, find_robot: FindRobot, names: Sequence[str] = ()
) -> Study:
    """The study with documents instead of names; `names` are of axes, further ones too.

    Raises:
        InputError: If a name is unknown; its path names the field.
    """
    changes: dict[str, Any] = {}
    for i, axis in enumerate(study.axes):
        try:
            target(axis.name, study.method)
        except InputError as error:
            raise error.within("axes", i, "name") from None
    if study.terrain is None:
        changes["terrain"] = implied_terrain(names or [axis.name for axis in study.axes])
    elif isinstance(study.terrain, str):
        changes["terrain"] = _named("terrain", find_terrain, study.terrain)
    robots = dict(study.robots)
    if isinstance(study.robot, str):
        known = robots.get(study.robot)
        changes["robot"] = known or _named("robot", find_robot, study.robot)
    for i, axis in enumerate(study.axes):
        if axis.name == "robot":
            for k, name in enumerate(axis.points):
                if name not in robots:
                    try:
                        robots[str(name)] = find_robot(str(name))
                    except InputError as error:
                        raise InputError(error.message, ("axes", i, "values", k)) from None
    changes["robots"] = dict(sorted(robots.items()))
    return study.model_copy(update=changes)


def _named(field: str, find: Callable[[Any], Any], name: str) -> Any:
    try:
        return find(name)
    except InputError as error:
        raise error.within(field) from None
