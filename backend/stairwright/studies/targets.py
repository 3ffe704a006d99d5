"""What an axis may vary: names of quantities, their units, and where each goes in a question."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, get_args

from pydantic import BaseModel

from stairwright.control.settings import ControllerSettings
from stairwright.errors import InputError
from stairwright.planning.plan import FacingChoice, Method
from stairwright.planning.tolerance import Tolerance
from stairwright.planning.weights import MODELS
from stairwright.robot.description import Robot
from stairwright.simulation.disturbance import Disturbance
from stairwright.terrain.generation import FlatParameters, RampParameters, StairParameters

Part = Literal[
    "terrain", "friction", "payload", "weights", "method", "robot", "robot_file", "controller",
    "disturbance", "seed", "tolerance", "facing",
]  # fmt: skip
Generated = StairParameters | RampParameters | FlatParameters

GROUPS: Mapping[str, Generated] = {
    "stairs": StairParameters(kind="stair", rise=0.17, run=0.28, count=3),
    "step": StairParameters(kind="stair", rise=0.17),
    "ramp": RampParameters(kind="ramp", rise=0.25, slope=0.35),
    "flat": FlatParameters(kind="flat"),
}
"""Groups of measures, and the terrain that they imply where none is given."""
_OTHER_NAMES = {
    "stairs": {"tread": "run", "going": "run", "steps": "count", "height": "rise"},
    "step": {"height": "rise"},
    "ramp": {"height": "rise", "angle": "slope"},
    "flat": {},
}
_UNIT = re.compile(r"\[([^\[\]]+)\]\s*$")


@dataclass(frozen=True)
class Target:
    """Where the values of an axis go.

    Attributes:
        part: Of the question.
        path: Inside that part.
        unit: Of the values; 1 where they have none.
        words: Whether the values are words.
    """

    part: Part
    path: tuple[str, ...] = ()
    unit: str = "1"
    words: bool = False


def target(name: str, method: Method = "path") -> Target:
    """The target that an axis of this name has.

    Raises:
        InputError: If there is none; says which there are.
    """
    head, _, rest = name.partition(".")
    path = tuple(rest.split(".")) if rest else ()
    if head in GROUPS and len(path) == 1:
        key = _OTHER_NAMES[head].get(path[0], path[0])
        model: type[BaseModel] = type(GROUPS[head])
        if key in model.model_fields and key not in ("kind", "name", "friction", "direction"):
            unit = _described_unit(model, key) or ("1" if key == "count" else "m")
            return Target("terrain", (key,), unit)
        raise InputError(f"no such measure of {head}; there are: {', '.join(measures(head))}")
    if head == "robot":
        return (
            Target("robot_file", path, _robot_unit(path)) if path else Target("robot", words=True)
        )
    tuned: dict[Part, type[BaseModel]] = {
        "weights": MODELS[method],
        "controller": ControllerSettings,
        "disturbance": Disturbance,
        "tolerance": Tolerance,
    }
    for part, fields in tuned.items():
        if part == head and len(path) == 1:
            if path[0] not in fields.model_fields:
                raise InputError(f"no such name; {head} has: {', '.join(fields.model_fields)}")
            return Target(part, path, _described_unit(fields, path[0]) or "1")
    if not path:
        if head == "speed":
            return Target("weights", ("speed",), "m/s")
        plain: dict[Part, str] = {"friction": "1", "payload": "kg", "seed": "1"}
        for part, unit in plain.items():
            if part == head:
                return Target(part, unit=unit)
        worded: tuple[Part, ...] = ("method", "facing")
        for part in worded:
            if part == head:
                return Target(part, words=True)
    groups = ", ".join(f"{group}.{measures(group)[0]}" for group in GROUPS)
    raise InputError(
        f"nothing is called {name[:60]!r}; there are: {groups} and their other measures, "
        "friction, payload, speed, method, facing, weights.NAME, robot, robot.PATH, "
        "controller.NAME, disturbance.NAME, tolerance.NAME, seed"
    )


def measures(group: str) -> list[str]:
    """Names of the measures of a group of terrains."""
    skipped = ("kind", "name", "friction", "direction")
    return [name for name in type(GROUPS[group]).model_fields if name not in skipped]


def group_of(name: str) -> str | None:
    """The group of terrains that an axis belongs to, if it is one of terrain."""
    head, _, rest = name.partition(".")
    return head if head in GROUPS and rest else None


def implied_terrain(names: Sequence[str]) -> Generated:
    """The terrain of a study that names none: the one that its axes measure.

    Raises:
        InputError: If the axes measure none, or different ones.
    """
    groups = {group for name in names if (group := group_of(name)) is not None}
    if len(groups) > 1:
        raise InputError(f"the axes measure different terrains: {', '.join(sorted(groups))}",
                         ("axes",))  # fmt: skip
    if not groups:
        raise InputError("Field required where no axis measures a terrain", ("terrain",))
    return GROUPS[groups.pop()]


def check_value(where: Target, value: float | str) -> None:
    """Refuse words where numbers belong, and the other way round.

    Raises:
        InputError: If it is so.
    """
    if where.words != isinstance(value, str):
        raise InputError(f"must be {'words' if where.words else 'numbers'}")
    for part, known in (("method", Method), ("facing", FacingChoice)):
        if where.part == part and value not in get_args(known):
            raise InputError(f"unknown {part}; there are: {', '.join(get_args(known))}")


def _described_unit(model: type[BaseModel], field: str) -> str | None:
    info = model.model_fields[field]
    extra = info.json_schema_extra
    if isinstance(extra, dict) and "unit" in extra:
        return str(extra["unit"])
    found = _UNIT.search(info.description or "")
    return found[1] if found else None


@lru_cache(maxsize=256)
def _robot_unit(path: tuple[str, ...]) -> str:
    """The unit that the robot's schema tells for a number in its file."""
    schema: dict[str, Any] = Robot.model_json_schema(by_alias=True)
    here, unit = schema, "1"
    for key in path:
        here = _entered(here, schema)
        found = here.get("properties", {}).get(key)
        if found is None:
            return unit
        words = _UNIT.search(str(found.get("description", "")))
        unit = words[1] if words else unit
        here = found
    return unit


def _entered(here: dict[str, Any], schema: dict[str, Any]) -> dict[str, Any]:
    """The object that a schema's node stands for."""
    for each in (here, *here.get("anyOf", ()), *here.get("allOf", ())):
        if "$ref" in each:
            found: dict[str, Any] = schema["$defs"][each["$ref"].rpartition("/")[2]]
            return found
    return here
