"""What stops the robot: the single change that would open the way, where, and how large.

Each candidate quantity is raised alone, on the coarse lattice and with bounds that forgive what
rounding takes: that gives the least value that may do. A candidate is only asked whether it opens
the way at a smaller relative change than the best one so far. The smallest names the problem, after
planning again with it: the answer is physically true, not a guess from the search's front.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from stairwright.robot.description import Robot

from .path.course import NoStand
from .path.solve import BOLD, QUICK, Blocked, Course, Solved, pose_course
from .plan import Limit, Problem

Kind = Literal["reach", "clearance", "statics", "torque", "joint_limit"]

_FINE = 1.7  # lattice of the questions, coarser than that of plans
_CLOSE = 0.02  # relative precision of the bisected value
_CONFIRM = (1.005, 1.04, 1.1, 1.25, 1.6)  # factors tried on the bisected value
_LONGEST = (3.0, 8.0)  # times the legs' length; asked last, with ample friction
_ASKED = 2  # candidates for which planning is tried


@dataclass(frozen=True)
class Candidate:
    """One quantity that may be raised (or, for `lower`, reduced)."""

    kind: Kind
    quantity: str
    unit: str
    available: float
    limit: float
    change: Callable[[Course, float], Course]
    given: str = ""  # what else the change needs

    def at(self, ratio: float) -> float:
        """The value that differs from what there is by the factor `ratio` > 1."""
        return self.available * ratio if self.limit > self.available else self.available / ratio

    @property
    def most(self) -> float:
        """The factor at the limit."""
        return max(self.limit / self.available, self.available / self.limit)

    def opens(self, course: Course, ratio: float) -> bool:
        """Whether a quick, forgiving search comes through with the quantity changed so."""
        try:
            changed = self.change(course, self.at(ratio))
        except NoStand:
            return False
        return changed.find(_FINE, BOLD, cheap=False).quality > 0

    def solves(self, course: Course, ratio: float) -> bool:
        """Whether there is a certified plan with the quantity changed so."""
        try:
            changed = self.change(course, self.at(ratio))
        except NoStand:
            return False
        return isinstance(changed.solve(QUICK), Solved)


def explain(course: Course, blocked: Blocked) -> Problem:
    """Name what stops `course`.

    Args:
        course: The question without an answer.
        blocked: What its solution attempt returned.
    """
    if blocked.opened:
        torque = _torque(course, blocked)
        if torque is not None:
            return torque
    candidates = _candidates(course)
    for _ in range(_ASKED):
        best: Candidate | None = None
        ratio = math.inf
        for candidate in candidates:
            least = _least(course, candidate, ratio)
            if least is not None:
                best, ratio = candidate, least
        if best is None:
            break
        confirmed = _confirm(course, best, ratio)
        if confirmed is not None:
            return _problem(course, blocked, best, best.at(confirmed))
        candidates.remove(best)
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
        Candidate("reach", "leg length", "m", legs, 3.0 * legs,
                  lambda c, v: _with_robot(c, _longer(robot, v / legs))),
        Candidate("clearance", "trunk height", "m", robot.trunk.size[2], 0.1 * robot.trunk.size[2],
                  lambda c, v: _with_robot(c, _flatter(robot, v))),
        Candidate("joint_limit", "calf range", "rad", ranges["calf"], ranges["calf"] + 0.8,
                  lambda c, v: _with_robot(c, _wider(robot, "calf", v - ranges["calf"]))),
        Candidate("joint_limit", "thigh range", "rad", ranges["thigh"], ranges["thigh"] + 1.0,
                  lambda c, v: _with_robot(c, _wider(robot, "thigh", v - ranges["thigh"]))),
    ]  # fmt: skip


def _with_robot(course: Course, robot: Robot) -> Course:
    """The same question for another robot, which stands as it would."""
    return pose_course(course.terrain, robot, course.friction, course.weights)


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


def _least(course: Course, candidate: Candidate, below: float) -> float | None:
    """Least factor on the candidate's quantity that opens the way, if it is less than `below`."""
    low, high = 1.0, min(candidate.most, below / (1.0 + _CLOSE))
    if high <= low or not candidate.opens(course, high):
        return None
    while high / low > 1.0 + _CLOSE:
        middle = math.sqrt(low * high)
        if candidate.opens(course, middle):
            high = middle
        else:
            low = middle
    return high


def _confirm(course: Course, candidate: Candidate, ratio: float) -> float | None:
    """The least of a few factors from `ratio` on with which a certified plan exists."""
    before = 1.0
    for factor in _CONFIRM:
        tried = ratio * factor
        if candidate.solves(course, tried):
            middle = math.sqrt(before * tried)
            wide = tried / before > 1.04 and before > 1.0
            return middle if wide and candidate.solves(course, middle) else tried
        before = tried
    return None


def _torque(course: Course, blocked: Blocked) -> Problem | None:
    """The problem if joint torque alone stands in the way."""
    robot = course.robot
    available = robot.actuators.leg.torque
    limit = 10 * available
    strong = _with_robot(course, _stronger(robot, limit)).solve(QUICK)
    if not isinstance(strong, Solved):
        return None
    used = max(limit - pose.margins.torque for pose in strong.poses)
    candidate = Candidate(
        "torque", "leg torque", "Nm", available, limit,
        lambda c, v: _with_robot(c, _stronger(robot, v)),
    )  # fmt: skip
    if used <= available or not candidate.solves(course, 1.001 * used / available):
        return None
    return _problem(course, blocked, candidate, 1.001 * used)


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
        f"needs {candidate.quantity} {value:.3g}{unit}{candidate.given}, "
        f"has {candidate.available:.3g}{unit}: "
        f"the {wheel} wheels stop at x = {at[0]:.2f} m, z = {at[1]:.2f} m"
    )
    return Problem(
        kind=candidate.kind, at=at, progress=progress, message=message,
        limit=Limit(
            needed=value, available=candidate.available,
            quantity=candidate.quantity + candidate.given, unit=candidate.unit,
        ),
    )  # fmt: skip


def _hopeless(course: Course, blocked: Blocked) -> Problem:
    """No single change is enough: the leg length that opens the way with high friction."""
    at, progress, wheel = _place(course, blocked)
    robot = course.robot
    legs = robot.thigh.length + robot.calf.length
    grip = max(1.5, course.friction)
    for longest in _LONGEST:
        bold = Candidate(
            "reach", "leg length", "m", legs, longest * legs,
            lambda c, v: replace(_with_robot(c, _longer(robot, v / legs)), friction=grip),
            f" with friction {grip:.2g}",
        )  # fmt: skip
        least = _least(course, bold, math.inf)
        confirmed = _confirm(course, bold, least) if least is not None else None
        if confirmed is not None:
            return _problem(course, blocked, bold, bold.at(confirmed))
    message = (
        f"the {wheel} wheels stop at x = {at[0]:.2f} m, z = {at[1]:.2f} m, and neither legs of "
        f"{bold.limit:.3g} m nor friction {grip:.2g} would change that"
    )
    return Problem(kind="reach", at=at, progress=progress, message=message)
