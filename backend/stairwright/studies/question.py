"""From a place in a study to the whole question that it stands for."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel, ValidationError

from stairwright.arguments import as_friction
from stairwright.complaints import wording
from stairwright.control.settings import parse_settings
from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.planning.courses import Courses
from stairwright.planning.plan import FacingChoice, Method, PlanTiming, usual_facing
from stairwright.planning.tolerance import Tolerance, parse_tolerance
from stairwright.planning.weights import parse_weights
from stairwright.robot.description import Robot
from stairwright.terrain.generation import generate
from stairwright.terrain.profile import Terrain

from .axes import Value
from .document import Study
from .targets import Target, check_value, target

_ROBOTS_KEPT = 64  # what is derived from a robot is derived once for neighbouring cells
_SCHEMA_2 = "stairwright/robot/2"


@dataclass(frozen=True)
class CellQuestion:
    """Everything that the answer of one cell depends on."""

    terrain: Terrain
    robot: Robot
    friction: float
    method: Method
    weights: Mapping[str, Any]
    controller: Mapping[str, Any] = field(default_factory=dict)
    disturbance: Mapping[str, float] = field(default_factory=dict)
    seed: int = 0
    tolerance: Tolerance | None = None
    timing: PlanTiming = "steady"
    facing: FacingChoice = "forward"

    @property
    def plan(self) -> dict[str, Any]:
        """The body of POST /plans that asks for this cell's plan."""
        body = {
            "terrain": self.terrain.model_dump(mode="json"),
            "robot": self.robot.model_dump(mode="json"),
            "friction": self.friction,
            "method": self.method,
            "weights": dict(self.weights),
        }
        if self.tolerance is not None:
            body["tolerance"] = self.tolerance.asked
        if self.timing != "steady":
            body["timing"] = self.timing
        if self.facing != usual_facing(self.timing):
            body["facing"] = self.facing
        return body


_SIMULATED: Mapping[str, tuple[str, ...]] = {
    "plan": ("controller", "disturbance", "seed"),
    "trials": ("disturbance",),  # each trial draws its own
}


class Questions:
    """All questions of one study."""

    def __init__(self, study: Study) -> None:
        """`study` has documents, no names; see `resolve`.

        Raises:
            InputError: If an axis stands for nothing, or nowhere has a value that can be asked.
        """
        self.study = study
        parse_settings(study.controller)
        parse_weights(study.method, study.weights)
        if study.timing == "fast" and study.method != "path":
            raise InputError("fast belongs to the method path", ("timing",))
        self.targets: list[Target] = []
        for i, axis in enumerate(study.axes):
            where = target(axis.name, study.method)
            self.targets.append(where)
            if where.part in _SIMULATED.get(study.compute, ()):
                raise InputError(
                    f"has no effect on what is computed, {study.compute}", ("axes", i, "name")
                )
            if where.part == "terrain" and not hasattr(study.terrain, "kind"):
                raise InputError(
                    "the terrain has fixed points: give a kind with its measures instead, or none",
                    ("axes", i, "name"),
                )
            try:
                for value in axis.points:
                    check_value(where, value)
            except InputError as error:
                raise error.within("axes", i, "values") from None
        self.courses = Courses()
        self._robots: OrderedDict[tuple[Any, ...], Robot] = OrderedDict()

    def at(self, point: Sequence[Value]) -> CellQuestion:
        """The question at these values of the axes.

        Raises:
            InputError: If these values make none, e.g. legs too short for the robot's height.
        """
        study = self.study
        given = list(zip(self.targets, point, strict=True))
        terrain = self._terrain({t.path[0]: v for t, v in given if t.part == "terrain"})
        plain = {t.part: v for t, v in given if not t.path}
        friction = plain.get("friction", study.friction)
        method: Method = plain.get("method", study.method)  # type: ignore[assignment]
        weights = dict(study.weights) | {t.path[0]: v for t, v in given if t.part == "weights"}
        robot = self._robot([(t, v) for t, v in given if t.part in _OF_ROBOT])
        mu = terrain.friction if friction is None else as_friction(friction)
        tolerance = study.tolerance.asked if study.tolerance else {}
        tolerance |= {t.path[0]: float(v) for t, v in given if t.part == "tolerance"}
        return CellQuestion(
            terrain,
            robot,
            mu,
            method,
            parse_weights(method, weights).model_dump(mode="json"),
            dict(study.controller) | {t.path[0]: v for t, v in given if t.part == "controller"},
            {t.path[0]: float(v) for t, v in given if t.part == "disturbance"},
            _whole(plain.get("seed", study.seed), "seed"),
            parse_tolerance(tolerance, method, mu),
            study.timing,
            plain.get("facing", study.facing) or usual_facing(study.timing),  # type: ignore[arg-type]
        )

    def _terrain(self, measures: dict[str, Value]) -> Terrain:
        ground = self.study.terrain
        assert ground is not None
        assert not isinstance(ground, str)
        if isinstance(ground, Terrain):
            return ground
        data = ground.model_dump() | measures
        if "count" in measures:
            data["count"] = _whole(measures["count"], "count")
        try:
            return generate(parse(type(ground), data))
        except ValidationError as error:
            raise InputError(wording(error.errors()[0])) from None

    def _robot(self, given: Sequence[tuple[Target, Value]]) -> Robot:
        key = tuple(value for _, value in given)
        known = self._robots.get(key)
        if known is not None:
            self._robots.move_to_end(key)
            return known
        made = _made(self.study, given)
        self._robots[key] = made
        if len(self._robots) > _ROBOTS_KEPT:
            self._robots.popitem(last=False)
        return made


_OF_ROBOT = ("robot", "robot_file", "payload")


def _made(study: Study, given: Sequence[tuple[Target, Value]]) -> Robot:
    named = next((v for t, v in given if t.part == "robot"), None)
    robot = study.robot if named is None else study.robots[str(named)]
    assert isinstance(robot, Robot)
    return varied_robot(robot, [(t, v) for t, v in given if t.part != "robot"])


def varied_robot(robot: Robot, changes: Sequence[tuple[Target, Value]]) -> Robot:
    """The robot with its payload or numbers of its file changed.

    Raises:
        InputError: If there is no such number, or they make no robot.
    """
    if not changes:
        return robot
    data = robot.model_dump(mode="json")
    for where, value in changes:
        if where.part == "payload":
            _load(data, float(value))
        else:
            _replace(robot, data, where.path, value)
    try:
        return parse(Robot, data)
    except InputError as error:
        raise error.within("robot") from None


def _load(data: dict[str, Any], mass: float) -> None:
    """A payload of `mass` [kg] where the robot's own sits; none at 0."""
    if mass < 0.0:
        raise InputError("must not be negative", ("payload",))
    if mass == 0.0:
        data.pop("payload", None)
    else:
        data["payload"] = {**(data.get("payload") or {}), "mass": mass}
        data["schema"] = _SCHEMA_2


def _replace(robot: Robot, data: dict[str, Any], path: Sequence[str], value: Value) -> None:
    """One number of a robot's file, `data`; `robot` says what the file leaves out.

    Raises:
        InputError: If the path leads to no number.
    """
    shown = "robot." + ".".join(path)
    here: Any = data
    for depth, key in enumerate(path[:-1]):
        if isinstance(here, dict) and here.get(key) is None:
            known = _left_out(robot, path[: depth + 1])
            there = sorted(name for name, part in here.items() if part is not None)
            if depth and there and not known:
                raise InputError(f"no such part; the robot has: {', '.join(there)}", (shown,))
            here[key] = known  # validation says whether there may be such a thing
            data["schema"] = _SCHEMA_2
        here = _entered(here, key, shown)
    last = path[-1]
    old: Any = None
    if isinstance(here, list):
        old = _entered(here, last, shown)
        here[int(last)] = value
    elif isinstance(here, dict):
        if last not in here:
            data["schema"] = _SCHEMA_2
        old = here.get(last, 0.0)
        here[last] = value
    if isinstance(old, bool) or not isinstance(old, (int, float)):
        raise InputError("is no number", (shown,))


def _left_out(robot: Robot, path: Sequence[str]) -> Any:
    """What a part stands for that the file leaves out: its default, or what it takes after."""
    rear, actuators = robot.rear, robot.actuators
    like: Any = robot
    if path[0] == "rear" and rear is None and len(path) == 2:
        path = path[1:]  # rear legs are as the front ones
    elif path[0] == "actuators" and getattr(actuators, path[-1], 0) is None:
        path = ("actuators", "leg")
    for key in path:
        like = getattr(like, key, None)
    if isinstance(like, BaseModel):
        return like.model_dump(mode="json")
    return list(like) if isinstance(like, (tuple, list)) else {}


def _entered(here: Any, key: str, shown: str) -> Any:
    if isinstance(here, list) and key.isdigit() and int(key) < len(here):
        return here[int(key)]
    if isinstance(here, dict) and key in here:
        return here[key]
    raise InputError("the robot's file has no such number", (shown,))


def _whole(value: Value, field: str) -> int:
    if isinstance(value, str) or value != int(value):
        raise InputError("must be a whole number", (field,))
    return int(value)


def check_axes(questions: Questions) -> None:
    """Refuse a study in which an axis has no value that makes a question.

    Each axis is tried alone, with the others at each of two of their values; what only some
    combinations make impossible is an answer of those cells.

    Raises:
        InputError: With the first reason; its path names the axis.
    """
    axes = questions.study.axes
    for i, axis in enumerate(axes):
        failure: InputError | None = None
        for ends in (0, -1):
            point = [other.points[ends] for other in axes]
            for value in axis.points:
                point[i] = value
                try:
                    questions.at(point)
                    break
                except InputError as error:
                    failure = failure or error
            else:
                continue
            break
        else:
            assert failure is not None
            shown = ".".join(map(str, failure.field))
            why = f"{shown}: {failure.message}" if shown else failure.message
            raise InputError(f"no value makes a question: {why}", ("axes", i))
