"""One optimal pose: where the rear wheel and the trunk should be, found by solving there."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from stairwright import _core
from stairwright.arrays import Flags, Floats
from stairwright.planning.poses.solution import Solution
from stairwright.planning.weights import CriticalWeights
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

CLEARANCE = 0.012  # m between trunk or links and the terrain at a critical pose
BETWEEN = _core.CLEARANCE_BETWEEN  # m; the same between critical poses, where room is scarce
LEGS_DISTANCE = 0.006  # m between front and rear leg
WANTED_MARGIN = _core.WANTED_MARGIN  # m of CoM margin beyond which other things decide
ENOUGH = _core.ENOUGH_POSES  # poses with that margin; then the search ends
TRIES = 4  # places where many first guesses are tried when the usual ones find nothing
_FREE = 1e3  # m; a bound that bounds nothing
_TIPPED = 20.0  # 1/m; what lost balance on the way weighs against CoM margin
_TURN = 0.06  # 1/rad^2; what turning the joints weighs against CoM margin
_NOTHING = np.full(5, np.nan)
_ANYWHERE = np.array([[-np.inf, np.inf]])


class Rules(NamedTuple):
    """What all poses of one plan keep. SI units.

    Attributes:
        friction: Between wheels and terrain.
        weights: (7,) of eq 17.
        lower, upper: (9,) bounds of x, z, pitch, joints, arc lengths; those of the wheels are
            filled in for each pose.
        clearance: Of trunk and links from the ground.
        legs_distance: Of the front leg from the rear one.
        behind: Of the rear contact behind the rear hip (eq 20).
        exact_links: Keep whole links clear, not only the collision points.
    """

    friction: float
    weights: Floats
    lower: Floats
    upper: Floats
    clearance: float
    legs_distance: float
    behind: float
    exact_links: bool

    @property
    def native(self) -> _core.PoseRules:
        """The same for the native core."""
        return _core.PoseRules(*self)


@dataclass(frozen=True)
class ContactPair:
    """Where a pose is wanted: arc lengths [m].

    Attributes:
        front: Of the front wheel.
        rear: Least and largest of the rear wheel.
        ahead: Whether the front wheel is about to take a face, which alone must carry it next.
        face: Where on the obstacle's face the front wheel is, or was, while the rear wheel is here:
            both must hold the robot together.
        climbs: Whether the obstacle goes up. Eq 20 keeps the robot from falling backward there; on
            the way down it does not apply, the robot would fall forward.
        before: (9,) variables of the pose before: x, z, pitch, joints, arc lengths of the wheels.
    """

    front: float
    rear: tuple[float, float]
    ahead: bool
    face: float
    climbs: bool
    before: Floats

    @property
    def posture(self) -> Floats:
        """Pitch and joints (5,) of the pose before [rad]."""
        return self.before[2:7]

    @cached_property
    def native(self) -> _core.ContactPair:
        """The same for the native core."""
        return _core.ContactPair(
            self.front, self.rear, self.ahead, self.face, self.climbs, self.posture
        )


@dataclass(frozen=True)
class Found:
    """A solved pose and how good it is.

    Attributes:
        solution: Variables and cost.
        margin: CoM margin [m], also with the face ahead alone.
        turn: Sum of squares of the turns of pitch and joints since the pose before [rad^2].
    """

    solution: Solution
    margin: float
    turn: float

    @property
    def score(self) -> float:
        """CoM margin up to `WANTED_MARGIN`, and among poses with that the nearest posture."""
        return min(self.margin, WANTED_MARGIN) / WANTED_MARGIN - _TURN * self.turn


class PoseSearch:
    """Solves poses of one robot on one terrain, with the native solver."""

    def __init__(
        self, robot: Robot, path: WheelPath, friction: float, weights: CriticalWeights
    ) -> None:
        self.robot, self.path, self.friction = robot, path, friction
        self.problem = pose_problem(robot, path)
        self.repeats = True  # poses of a uniform flight may be moved along
        self.standing = self.problem.standing
        self.scale = min(leg.reach for leg in robot.legs) / 0.4
        w = weights
        # Inside the limits by more than what solvers leave open.
        joints = kinematics.limits(robot) + np.array([1e-5, -1e-5])
        self.rules = Rules(
            friction=friction,
            weights=np.array([w.com_x, w.com_z, w.pitch, *[w.posture] * 4]),
            lower=np.array([-_FREE, -_FREE, -math.pi, *joints[:, 0], 0.0, 0.0]),
            upper=np.array([_FREE, _FREE, math.pi, *joints[:, 1], 0.0, 0.0]),
            clearance=CLEARANCE,
            legs_distance=LEGS_DISTANCE,
            behind=0.0,
            exact_links=w.exact_links,
        )
        self._native_rules = self.rules.native
        reach = max(leg.reach for leg in robot.legs)
        wheelbase = robot.hips.front[0] - robot.hips.rear[0]
        self.span = (2 * robot.wheel.radius + LEGS_DISTANCE, 2 * reach + wheelbase)
        self._usual = 1.4 * wheelbase
        self._lost: dict[bytes, float] = {}  # balance lost between two poses, once judged

    def best_pair(
        self,
        first: ContactPair,
        second: ContactPair,
        after: Floats | None = None,
        balance: bool = True,
    ) -> tuple[Found | None, Found | None]:
        """The poses before and after a face; the rear wheel crosses no steep ground between.

        Of all pairs with room for the CoM the first one wins whose poses the robot can go through
        without losing its balance; without any, the one that loses least.

        Args:
            first: Where the front wheel arrives at the face.
            second: Where it is past it.
            after: (9,) the known pose that follows, if any.
            balance: Whether balance on the way counts.
        """
        best: tuple[float, Found, Found | None] | None = None
        for gentle in (True, False):
            options = sorted(self.search(first, gentle), key=lambda found: -found.score)
            for one in options[:ENOUGH]:
                tipped = self.imbalance(first.before, one.solution.x) if balance else 0.0
                for later in self._later(one, second, gentle):
                    lost = tipped
                    if later is not None and balance:
                        lost += self.imbalance(one.solution.x, later.solution.x)
                        if after is not None:
                            lost += self.imbalance(later.solution.x, after)
                    value = one.score + (later.score if later else -10.0) - _TIPPED * lost
                    if later is not None and lost == 0.0 and later.margin >= 0.99 * WANTED_MARGIN:
                        return one, later
                    if best is None or value > best[0]:
                        best = value, one, later
            if best is not None and best[2] is not None:
                break
        return (best[1], best[2]) if best else (None, None)

    def _later(self, one: Found, second: ContactPair, gentle: bool) -> list[Found | None]:
        """Poses that may follow `one`, best first; a list of None where there are none."""
        rear = float(one.solution.x[8])
        stop = min(self._steep_ahead(rear), second.rear[1]) if gentle else second.rear[1]
        place = replace(second, rear=(rear, stop), before=one.solution.x)
        found = sorted(self.search(place, gentle), key=lambda other: -other.score)
        return [*found[:ENOUGH]] or [None]

    def search(self, place: ContactPair, gentle: bool = True) -> list[Found]:
        """All solved poses with the front wheel at a place, one for each rear wheel place tried.

        Args:
            place: Where.
            gentle: Rest the rear wheel only on ground that holds it alone.
        """
        rears = self.rear_places(place, gentle)
        found = self.problem.critical_poses(self._native_rules, place.native, rears)
        if found:
            return [_found(one) for one in found]
        hard = [self.solve(place, float(rear), patient=True) for rear in rears[:TRIES]]
        return [one for one in hard if one.solution.solved]

    def solve(
        self,
        place: ContactPair,
        rear: float,
        *,
        patient: bool = False,
        rules: Rules | None = None,
        start: Floats | None = None,
    ) -> Found:
        """The optimal pose with the rear wheel near `rear`.

        Args:
            place: Where.
            rear: Arc length [m].
            patient: Try many first guesses where the usual ones find nothing.
            rules: Rules other than those of the plan.
            start: (9,) a first guess before the usual ones.
        """
        kept = self._native_rules if rules is None else rules.native
        return _found(self.problem.critical_pose(kept, place.native, rear, _start(start), patient))

    def imbalance(self, begin: Floats, end: Floats) -> float:
        """By how much the CoM lies outside balance between two poses (9,), at worst [m]."""
        key = begin.tobytes() + end.tobytes()
        if key not in self._lost:
            self._lost[key] = self.problem.balance_lost(self._native_rules, begin, end)
        return self._lost[key]

    def clear(self, trunk: tuple[float, float, float], wheels: tuple[float, float]) -> bool:
        """Whether a pose with the wheels at given arc lengths keeps limits and clearances."""
        sound, _ = self.sound(np.array([[*trunk, *wheels]]), _ANYWHERE)
        return bool(sound[0])

    def sound(
        self, poses: Floats, coms: Floats, clearance: float = CLEARANCE
    ) -> tuple[Flags, Floats]:
        """Whether poses keep limits, clearances and balance (n,), and their joints (n, 4).

        Args:
            poses: (n, 5) x, z, pitch, arc lengths of front and rear wheels.
            coms: (n, 2) least and largest x of the centre of mass [m].
            clearance: Of trunk and links from the terrain [m].
        """
        rules = self.rules._replace(clearance=clearance).native
        slack, joints = self.problem.pose_slacks(rules, poses, coms)
        return slack >= -_core.SOLVED, joints

    def rear_places(self, place: ContactPair, gentle: bool = False) -> Floats:
        """Arc lengths of the rear wheel where ground and friction allow a pose, likeliest first."""
        return _core.rear_places(
            self.path.native, place.front, place.face, place.rear, self.span, self._usual,
            _core.REAR_SPACING * self.scale, self.friction, self.scale, gentle,
        )  # fmt: skip

    def settled(self, s: float) -> bool:
        """Whether a wheel at `s` rests on ground that holds it, well past any that does not."""
        return _core.rests(self.path.native, s, self.friction, self.scale)

    def _steep_ahead(self, s: float) -> float:
        return _core.steep_ahead(self.path.native, s, self.friction, self.scale)


def pose_problem(robot: Robot, path: WheelPath) -> _core.PoseProblem:
    """Pose optimisation for a robot on a terrain, in the native core."""
    points, size = robot.points, robot.trunk.size
    trunk = np.array(points.trunk, float) * (size[0], size[2])
    return _core.PoseProblem(
        _core.Terrain(path.vertices), path.native, robot.native, trunk, points.thigh, points.calf
    )


def _start(x: Floats | None) -> Floats:
    """Unknowns (5,) of a pose's variables (9,)."""
    return _NOTHING if x is None else np.concatenate([x[:3], x[7:]])


def _solution(found: _core.PoseSolution) -> Solution:
    return Solution(found.x, found.cost, found.violation, "sqp")


def _found(pose: _core.CriticalPose) -> Found:
    return Found(_solution(pose.solution), pose.margin, pose.turn)
