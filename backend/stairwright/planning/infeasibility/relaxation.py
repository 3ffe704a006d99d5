"""Quantities of which more, or less, would open a way: of the terrain and of the robot."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from stairwright.planning.attempt import Blocked, Outcomes, Solved
from stairwright.planning.infeasibility.changed_robots import (
    STRONGEST,
    balanced,
    farther,
    flatter,
    loaded,
    longer,
    stronger,
    wider,
)
from stairwright.planning.lattice.body_lattice import LOOSE, Bounds
from stairwright.planning.lattice.pieces import pieces
from stairwright.planning.lattice.search import Place
from stairwright.planning.path_planner import PathPlanner, path_planner
from stairwright.planning.smoothing.node_margins import JOINTS, Motor
from stairwright.planning.standing import NoStandingPose
from stairwright.planning.strategy import AT_ONCE, quick, solve
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

Kind = Literal["reach", "clearance", "statics", "torque", "joint_limit"]

LONGEST = 3.0  # times the legs' length; no engineer would build more
AMPLE = 1.5  # friction that leaves nothing to wish for
CLOSE = 0.02  # relative precision of the value that searches tell
_FLAT = 0.02  # of a profile's height
_LEAST = 0.01  # of a payload, and of how far a mass centre is off
WIDE = 4.0  # rad that a range may be wider
FARTHEST = 3.0  # times the distance of the hips
_KEPT = 4
_FINE = 1.7  # lattice of the questions, coarser than that of plans


@dataclass(frozen=True)
class Candidate:
    """One quantity that may be raised, or reduced where `limit` is less than `available`."""

    kind: Kind
    quantity: str
    unit: str
    available: float
    limit: float
    change: Callable[[PathPlanner, float], PathPlanner]
    given: Mapping[str, float] = field(default_factory=dict, compare=False)  # what else it needs
    # Questions asked last, by their factor: what is tried anew has its tables.
    changed: dict[float, PathPlanner] = field(default_factory=dict, compare=False, repr=False)
    # What came of attempts at all of them.
    tried: dict[float, Outcomes] = field(default_factory=dict, compare=False, repr=False)

    def anew(self) -> Candidate:
        """The same one, of which nothing was asked."""
        return replace(self, changed={}, tried={})

    def at(self, ratio: float) -> float:
        """The value that differs from what there is by the factor `ratio` > 1."""
        return self.available * ratio if self.limit > self.available else self.available / ratio

    @property
    def most(self) -> float:
        """The factor at the limit."""
        return max(self.limit / self.available, self.available / self.limit)

    def highest(self, below: float) -> float:
        """The largest factor worth asking about where one of `below` is known to do."""
        return min(self.most, below / (1.0 + CLOSE))

    def opens(
        self, planner: PathPlanner, places: Sequence[Place], ratio: float, bounds: Bounds = LOOSE
    ) -> bool:
        """Whether a quick search within `bounds` comes past `places` with the quantity changed so.

        Of another profile all is asked.
        """
        try:
            changed = self.change(planner, self.at(ratio))
        except NoStandingPose:
            return False
        return leads_past(changed, places if changed.terrain is planner.terrain else (), bounds)

    def attempt(self, planner: PathPlanner, ratio: float) -> Solved | Blocked:
        """What comes of a quick attempt at a plan with the quantity changed so."""
        return self._planned(planner, ratio, quick)

    def feasible(self, planner: PathPlanner, ratio: float, pool: Executor) -> bool:
        """Whether all of planning, asked anew with the quantity changed so, has a plan."""
        above = self._outcomes_above(ratio)
        likely = [how for how, end in above.items() if isinstance(end, Solved)]
        # Motors that are too weak for a path are so with less torque.
        weak = self.kind == "torque" and _weak(above.get((AT_ONCE, False)))

        def ask(changed: PathPlanner) -> Solved | Blocked:
            asked = changed.within_torques if weak else changed.regardless
            return solve(asked, pool, any_path=True, likely=likely)

        return isinstance(self._planned(planner, ratio, ask), Solved)

    def feasible_likewise(self, planner: PathPlanner, ratio: float) -> bool:
        """Whether an attempt has a plan that had one with a little more of the quantity, or the
        first attempt.

        Where none has, all of planning may still.
        """
        above = self._outcomes_above(ratio)
        likely = [how for how, end in above.items() if isinstance(end, Solved)]
        likely += [(AT_ONCE, torques) for torques in {torques for _, torques in likely}]

        def ask(changed: PathPlanner) -> Solved | Blocked:
            found: Solved | Blocked = Blocked(None, False)
            for how, torques in likely:
                found = (changed.within_torques if torques else changed.regardless).attempt(how)
                if isinstance(found, Solved):
                    break
            return found

        return isinstance(self._planned(planner, ratio, ask), Solved)

    def _outcomes_above(self, ratio: float) -> Outcomes:
        """What came of attempts with the next larger factor with which one found a path."""
        found = [
            one
            for one, outcomes in self.tried.items()
            if one >= ratio and any(isinstance(end, Solved) for end in outcomes.copy().values())
        ]
        return self.tried[min(found)] if found else {}

    def _planned(
        self,
        planner: PathPlanner,
        ratio: float,
        how: Callable[[PathPlanner], Solved | Blocked],
    ) -> Solved | Blocked:
        changed = self.changed.get(ratio)
        if changed is None:
            try:
                changed = self.change(planner, self.at(ratio))
            except NoStandingPose:
                return Blocked(None, False)
            for old in list(self.changed)[: 1 - _KEPT]:
                self.changed.pop(old, None)
            changed.tried = self.tried.setdefault(ratio, changed.tried)
            self.changed[ratio] = changed
        return how(changed)


def _weak(end: Solved | Blocked | None) -> bool:
    return isinstance(end, Blocked) and end.weak is not None


def leads_past(planner: PathPlanner, places: Sequence[Place], bounds: Bounds = LOOSE) -> bool:
    """Whether a quick search within `bounds` leads through the pieces round `places`."""
    return all(planner.passes(piece, _FINE, bounds) for piece in pieces(planner, places))


def candidates_of(planner: PathPlanner) -> list[Candidate]:
    """Quantities in the order in which they are asked: cheap and likely first."""
    robot = planner.robot
    legs = robot.legs[0].reach
    return [
        Candidate("statics", "friction", "1", planner.friction, max(2.0, 2.5 * planner.friction),
                  lambda c, v: replace(c, friction=v)),
        Candidate("reach", "leg length", "m", legs, LONGEST * legs,
                  lambda c, v: _with_robot(c, longer(c.robot, v / legs))),
        Candidate("clearance", "trunk height", "m", robot.trunk.size[2], 0.1 * robot.trunk.size[2],
                  lambda c, v: _with_robot(c, flatter(c.robot, v))),
        joint_range(robot, "calf", 0.8),
        joint_range(robot, "thigh", 1.0),
        *(motor_torque(robot, motor) for motor in JOINTS if planner.torques),
    ]  # fmt: skip


def joint_range(robot: Robot, part: Literal["thigh", "calf"], most: float) -> Candidate:
    """The range of all thighs or calves, wider by `most` rad at most."""
    ends = [getattr(leg, part) for leg in (robot.joints.front, robot.joints.rear)]
    least = min(high - low for low, high in ends)
    return Candidate("joint_limit", f"{part} range", "rad", least, least + most,
                     lambda c, v: _with_robot(c, wider(c.robot, part, v - least)))  # fmt: skip


def motor_torque(robot: Robot, motor: Motor) -> Candidate:
    """The torque of the legs' or wheels' motors; where they differ the weaker keep their share."""
    most = float(robot.torque_limits[:, JOINTS[motor]].max())
    return Candidate(
        "torque", f"{motor} torque", "Nm", most, STRONGEST,
        lambda c, v: _with_robot(c, stronger(c.robot, motor, v / most)),
    )  # fmt: skip


def _legs_with_grip(planner: PathPlanner) -> Candidate:
    """Longer legs, with ample friction."""
    robot = planner.robot
    legs = robot.legs[0].reach
    grip = max(AMPLE, planner.friction)
    return Candidate(
        "reach", "leg length", "m", legs, LONGEST * legs,
        lambda c, v: replace(_with_robot(c, longer(c.robot, v / legs)), friction=grip),
        {"friction": grip},
    )  # fmt: skip


def large_changes(planner: PathPlanner) -> list[Candidate]:
    """What is asked where nothing else is enough, one after the other."""
    points = np.array(planner.terrain.points)
    base, height = float(points[0, 1]), float(np.ptp(points[:, 1]))
    changes = [_legs_with_grip(planner)]

    def lowered(c: PathPlanner, v: float) -> PathPlanner:
        document = c.terrain.model_dump()
        low = base + (points[:, 1] - base) * (v / height)
        document["points"] = np.stack([points[:, 0], low], axis=1).tolist()
        changed = path_planner(Terrain.model_validate(document), c.robot, c.friction, c.weights)
        return replace(changed, torques=c.torques)

    if height > 0.0:  # in the end it is flat
        lower = Candidate("reach", "profile height", "m", height, _FLAT * height, lowered)
        changes.append(lower)
    return changes + list(_level_changes(planner.robot))


def _level_changes(robot: Robot) -> Iterator[Candidate]:
    """What robots may lack that do not even roll on the level."""
    if robot.payload:
        mass = robot.payload.mass
        yield Candidate("statics", "payload", "kg", mass, _LEAST * mass,
                        lambda c, v: _with_robot(c, loaded(c.robot, v)))  # fmt: skip
    off = abs(robot.trunk.com[0])
    if off > 0.0:
        yield Candidate("statics", "trunk CoM offset", "m", off, _LEAST * off,
                        lambda c, v: _with_robot(c, balanced(c.robot, v / off)))  # fmt: skip
    yield joint_range(robot, "thigh", WIDE)
    yield joint_range(robot, "calf", WIDE)
    apart = robot.hips.front[0] - robot.hips.rear[0]
    yield Candidate("clearance", "distance of the hips", "m", apart, FARTHEST * apart,
                    lambda c, v: _with_robot(c, farther(c.robot, v / apart)))  # fmt: skip


def _with_robot(planner: PathPlanner, robot: Robot) -> PathPlanner:
    """The same question for another robot, which stands as it would."""
    changed = path_planner(planner.terrain, robot, planner.friction, planner.weights)
    return replace(changed, torques=planner.torques)
