"""What stops the robot: the single change that would open the way, where, and how large.

Each candidate quantity is raised alone. Those that open the way are bisected to the least value
that does; the one with the smallest relative change names the problem. The value is confirmed by
planning again with it, so the answer is physically true, not a guess from the search's front.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from stairwright.robot.description import Robot

from .path.solve import QUICK, STRICT, Blocked, Course, Solved
from .plan import Limit, Problem

Kind = Literal["reach", "clearance", "statics", "torque", "joint_limit"]

_NEAR = 1.5  # a friction this many times the given one is believed without asking the others
_STEPS = 5  # bisections
_CONFIRM = (1.01, 1.06, 1.15, 1.3, 1.6)  # factors tried on the bisected value


@dataclass(frozen=True)
class Candidate:
    """One quantity that may be raised (or, for `lower`, reduced)."""

    kind: Kind
    quantity: str
    unit: str
    available: float
    limit: float
    change: Callable[[Course, float], Course]

    def at(self, share: float) -> float:
        """The value a `share` (0..1) of the way from what there is to the limit, geometrically."""
        return float(self.available * (self.limit / self.available) ** share)


def explain(course: Course, blocked: Blocked) -> Problem:
    """Name what stops `course`.

    Args:
        course: The question without an answer.
        blocked: What its solution attempt returned.
    """
    found: list[tuple[float, Candidate, float]] = []
    for candidate in _candidates(course):
        value = _least(course, candidate)
        if value is None:
            continue
        ratio = max(value / candidate.available, candidate.available / value)
        found.append((ratio, candidate, value))
        if candidate.kind == "statics" and ratio <= _NEAR:
            break
    found.sort(key=lambda item: item[0])
    for _, candidate, value in found:
        confirmed = _confirm(course, candidate, value)
        if confirmed is not None:
            return _problem(course, blocked, candidate, confirmed)
    return _hopeless(course, blocked)


def _candidates(course: Course) -> list[Candidate]:
    """Quantities in the order in which they are asked: cheap and likely first."""
    robot = course.robot
    legs = robot.thigh.length + robot.calf.length
    joints = (robot.joints.front, robot.joints.rear)
    ranges = {
        part: min(getattr(leg, part)[1] - getattr(leg, part)[0] for leg in joints)
        for part in ("thigh", "calf")
    }
    return [
        Candidate("statics", "friction", "1", course.friction, max(2.0, 2.5 * course.friction),
                  lambda c, v: replace(c, friction=v)),
        Candidate("reach", "leg length", "m", legs, 1.8 * legs,
                  lambda c, v: _with_robot(c, _longer(robot, v / legs))),
        Candidate("clearance", "trunk height", "m", robot.trunk.size[2], 0.1 * robot.trunk.size[2],
                  lambda c, v: _with_robot(c, _flatter(robot, v))),
        Candidate("joint_limit", "calf range", "rad", ranges["calf"], ranges["calf"] + 0.8,
                  lambda c, v: _with_robot(c, _wider(robot, "calf", v - ranges["calf"]))),
        Candidate("joint_limit", "thigh range", "rad", ranges["thigh"], ranges["thigh"] + 1.0,
                  lambda c, v: _with_robot(c, _wider(robot, "thigh", v - ranges["thigh"]))),
        Candidate("torque", "leg torque", "Nm", robot.actuators.leg.torque,
                  10 * robot.actuators.leg.torque,
                  lambda c, v: _with_robot(c, _stronger(robot, v))),
    ]  # fmt: skip


def _with_robot(course: Course, robot: Robot) -> Course:
    return replace(course, robot=robot)


def _changed(robot: Robot, changes: dict[str, dict[str, Any]]) -> Robot:
    """A new robot (nothing cached) with some fields of some of its parts replaced."""
    data = robot.model_dump()
    for part, fields in changes.items():
        data[part] |= fields
    return Robot.model_validate(data)


def _longer(robot: Robot, factor: float) -> Robot:
    """The robot with thighs and calves longer by `factor`."""
    return _changed(
        robot,
        {part: {"length": getattr(robot, part).length * factor} for part in ("thigh", "calf")},
    )


def _flatter(robot: Robot, height: float) -> Robot:
    size = (robot.trunk.size[0], robot.trunk.size[1], height)
    return _changed(robot, {"trunk": {"size": size}})


def _wider(robot: Robot, part: str, extra: float) -> Robot:
    """The robot with the range of `part` (thigh, calf) `extra` rad wider, half at each end."""
    legs: dict[str, Any] = {}
    for name in ("front", "rear"):
        leg = getattr(robot.joints, name).model_dump()
        low, high = leg[part]
        wide = [max(low - extra / 2, -6.28), min(high + extra / 2, 6.28)]
        if part == "calf":  # the knee keeps its side and does not fold onto itself
            wide = [
                max(wide[0], 0.05 if low > 0 else -3.1),
                min(wide[1], 3.1 if low > 0 else -0.05),
            ]
        legs[name] = leg | {part: tuple(wide)}
    return _changed(robot, {"joints": legs})


def _stronger(robot: Robot, torque: float) -> Robot:
    leg = robot.actuators.leg.model_dump() | {"torque": torque}
    return _changed(robot, {"actuators": {"leg": leg}})


def _opens(course: Course) -> bool:
    """Whether the quick, strict search comes through: then there is a plan as a rule."""
    return course.find(1.0, STRICT, cheap=False).quality > 0


def _least(course: Course, candidate: Candidate) -> float | None:
    """Least value of the candidate's quantity that opens the way; None if its limit does not."""
    if candidate.kind == "torque":
        return _least_torque(course, candidate)

    def opens(value: float) -> bool:
        return _opens(candidate.change(course, value))

    if not opens(candidate.limit):
        return None
    low, high = 0.0, 1.0
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        if opens(candidate.at(middle)):
            high = middle
        else:
            low = middle
    return candidate.at(high)


def _least_torque(course: Course, candidate: Candidate) -> float | None:
    """The torque that the path needs if only torque stands in the way."""
    if not _opens(course):
        return None
    strong = candidate.change(course, candidate.limit)
    solved = strong.solve(QUICK)
    if not isinstance(solved, Solved):
        return None
    used = max(candidate.limit - pose.margins.torque for pose in solved.poses)
    return float(used) if used > candidate.available else None


def _confirm(course: Course, candidate: Candidate, value: float) -> float | None:
    """The least of a few values from `value` on with which a certified plan exists."""
    up = candidate.limit > candidate.available
    for factor in _CONFIRM:
        tried = value * factor if up else value / factor
        if isinstance(candidate.change(course, tried).solve(QUICK), Solved):
            return tried
    return None


def _place(course: Course, blocked: Blocked) -> tuple[tuple[float, float], float, str]:
    """Contact point, progress and name of the wheel that is stopped."""
    begin, end = course.stands
    front, rear = blocked.reached or begin.wheels
    stopped, name = (rear, "rear") if front >= end.wheels[0] - 1e-6 else (front, "front")
    at = course.path.contacts(np.array([stopped]))[0]
    progress = 0.5 * (front + rear - sum(begin.wheels))
    return (float(at[0]), float(at[1])), max(0.0, float(progress)), name


def _problem(course: Course, blocked: Blocked, candidate: Candidate, value: float) -> Problem:
    at, progress, wheel = _place(course, blocked)
    unit = "" if candidate.unit == "1" else f" {candidate.unit}"
    message = (
        f"needs {candidate.quantity} {value:.3g}{unit}, has {candidate.available:.3g}{unit}: "
        f"the {wheel} wheels stop at x = {at[0]:.2f} m, z = {at[1]:.2f} m"
    )
    return Problem(
        kind=candidate.kind, at=at, progress=progress, message=message,
        limit=Limit(
            needed=value, available=candidate.available, quantity=candidate.quantity,
            unit=candidate.unit,
        ),
    )  # fmt: skip


def _hopeless(course: Course, blocked: Blocked) -> Problem:
    """No single change is enough: the leg length that opens the way with high friction."""
    at, progress, wheel = _place(course, blocked)
    robot = course.robot
    legs = robot.thigh.length + robot.calf.length
    grip = max(1.5, course.friction)
    for factor in (1.25, 1.6, 2.2, 3.2):
        bold = replace(course, friction=grip, robot=_longer(robot, factor))
        if isinstance(bold.solve(QUICK), Solved):
            message = (
                f"needs leg length {legs * factor:.3g} m and friction {grip:.2g}, has {legs:.3g} m "
                f"and {course.friction:.2g}: the {wheel} wheels stop at x = {at[0]:.2f} m, "
                f"z = {at[1]:.2f} m"
            )
            break
    else:
        factor = 3.2
        message = (
            f"the {wheel} wheels stop at x = {at[0]:.2f} m, z = {at[1]:.2f} m, and neither legs of "
            f"{legs * factor:.3g} m nor friction {grip:.2g} would change that"
        )
    return Problem(
        kind="reach", at=at, progress=progress, message=message,
        limit=Limit(needed=legs * factor, available=legs, quantity="leg length", unit="m"),
    )  # fmt: skip
