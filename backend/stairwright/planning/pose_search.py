"""One optimal pose: where the rear wheel and the trunk should be, found by solving there."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

from .solver import Solution
from .sqp import places, search
from .sqp.cells import make_course
from .sqp.joined import imbalance
from .sqp.nearest import nearest
from .sqp.search import COST, ENOUGH, GRID, MARGIN, TOLERANCE, TURN, VIOLATION, WANTED, Rules, Wish
from .sqp.state import make_body
from .weights import CriticalWeights

Floats = NDArray[np.float64]

CLEARANCE = 0.012  # m between trunk or links and the terrain at a critical pose
APART = 0.006  # m between front and rear leg
TRIES = 4  # places where many first guesses are tried when the usual ones find nothing
FREE = 1e3  # m; a bound that bounds nothing
_TIPPED = 20.0  # 1/m; what lost balance on the way weighs against room for the CoM
_TURN = 0.06  # 1/rad^2; what turning the joints weighs against room for the CoM
_NOTHING = np.full(5, np.nan)
_ANYWHERE = np.array([[-np.inf, np.inf]])


@dataclass(frozen=True)
class Place:
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

    @property
    def wish(self) -> Wish:
        """The same for compiled code."""
        return Wish(
            float(self.front), float(self.rear[0]), float(self.rear[1]),
            self.ahead, float(self.face), self.climbs, self.posture,
        )  # fmt: skip


@dataclass(frozen=True)
class Found:
    """A solved pose and how good it is.

    Attributes:
        solution: Variables and cost.
        margin: Room for the CoM [m], also with the face ahead alone.
        turn: Sum of squares of the turns of pitch and joints since the pose before [rad^2].
    """

    solution: Solution
    margin: float
    turn: float

    @property
    def score(self) -> float:
        """Room for the CoM up to `WANTED`, and among poses with room the nearest posture."""
        return min(self.margin, WANTED) / WANTED - _TURN * self.turn


class PoseSearch:
    """Solves poses of one robot on one terrain, with the compiled solver."""

    def __init__(
        self, robot: Robot, path: WheelPath, friction: float, weights: CriticalWeights
    ) -> None:
        self.robot, self.path, self.friction = robot, path, friction
        self.body, self.course = make_body(robot), make_course(path)
        self.standing = self.body.standing
        self.size = (robot.thigh.length + robot.calf.length) / 0.4
        w = weights
        # Inside the limits by more than what solvers leave open.
        joints = kinematics.limits(robot) + np.array([1e-5, -1e-5])
        self.rules = Rules(
            friction=friction,
            weights=np.array([w.com_x, w.com_z, w.pitch, *[w.posture] * 4]),
            lower=np.array([-FREE, -FREE, -math.pi, *joints[:, 0], 0.0, 0.0]),
            upper=np.array([FREE, FREE, math.pi, *joints[:, 1], 0.0, 0.0]),
            clearance=CLEARANCE,
            apart=APART,
            hip=0.0,
            links=w.exact_links,
            box=GRID / 2,
        )
        reach = robot.thigh.length + robot.calf.length
        wheelbase = robot.hips.front[0] - robot.hips.rear[0]
        self.span = (2 * robot.wheel.radius + APART, 2 * reach + wheelbase)
        self._usual = 1.4 * wheelbase
        self._lost: dict[bytes, float] = {}  # balance lost between two poses, once judged

    def best_pair(
        self, first: Place, second: Place, after: Floats | None = None, balance: bool = True
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
                    if later is not None and lost == 0.0 and later.margin >= 0.99 * WANTED:
                        return one, later
                    if best is None or value > best[0]:
                        best = value, one, later
            if best is not None and best[2] is not None:
                break
        return (best[1], best[2]) if best else (None, None)

    def _later(self, one: Found, second: Place, gentle: bool) -> list[Found | None]:
        """Poses that may follow `one`, best first; a list of None where there are none."""
        rear = float(one.solution.x[8])
        stop = min(self._steep_ahead(rear), second.rear[1]) if gentle else second.rear[1]
        place = replace(second, rear=(rear, stop), before=one.solution.x)
        found = sorted(self.search(place, gentle), key=lambda other: -other.score)
        return [*found[:ENOUGH]] or [None]

    def search(self, place: Place, gentle: bool = True) -> list[Found]:
        """All solved poses with the front wheel at a place, one for each rear wheel place tried.

        Args:
            place: Where.
            gentle: Rest the rear wheel only on ground that holds it alone.
        """
        rears = self.rear_places(place, gentle)
        x, numbers = np.empty((len(rears), 9)), np.empty((len(rears), 4))
        count = search.search(self.body, self.course, self.rules, place.wish, rears, x, numbers)
        if count:
            return [_found(x[i], numbers[i]) for i in range(count)]
        hard = [self.solve(place, float(rear), patient=True) for rear in rears[:TRIES]]
        return [one for one in hard if one.solution.solved]

    def solve(
        self,
        place: Place,
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
            rules: Bounds other than those of the plan.
            start: (9,) a first guess before the usual ones.
        """
        x, numbers = np.empty(9), np.empty(4)
        search.solve_at(
            self.body, self.course, rules or self.rules, place.wish, rear, _start(start), patient,
            x, numbers,
        )  # fmt: skip
        return _found(x, numbers)

    def nearest(
        self,
        wheels: Floats,
        wanted: Floats,
        start: Floats | None,
        com: tuple[float, float] = (-math.inf, math.inf),
    ) -> Solution:
        """The pose with the wheels at given places that is nearest to a trunk pose.

        Limits and clearances hold; eq 20 does not apply between critical poses.

        Args:
            wheels: (2,) arc lengths of front and rear wheels [m].
            wanted: (7,) x, z [m], pitch and joints [rad]; the joints count little.
            start: (9,) another first guess.
            com: Least and largest x of the centre of mass [m].
        """
        x = np.empty(9)
        value, violation = nearest(
            self.body, self.course, self.rules, wheels, wanted, com, _start(start), x
        )
        return Solution(x, float(value), float(violation), "sqp")

    def imbalance(self, begin: Floats, end: Floats) -> float:
        """By how much the CoM lies outside balance between two poses (9,), at worst [m]."""
        key = begin.tobytes() + end.tobytes()
        if key not in self._lost:
            self._lost[key] = float(imbalance(self.body, self.course, self.rules, begin, end))
        return self._lost[key]

    def clear(self, trunk: tuple[float, float, float], wheels: tuple[float, float]) -> bool:
        """Whether a pose with the wheels at given arc lengths keeps limits and clearances."""
        sound, _ = self.sound(np.array([[*trunk, *wheels]]), _ANYWHERE)
        return bool(sound[0])

    def sound(
        self, poses: Floats, coms: Floats, clearance: float = CLEARANCE
    ) -> tuple[NDArray[np.bool_], Floats]:
        """Whether poses keep limits, clearances and balance (n,), and their joints (n, 4).

        Args:
            poses: (n, 5) x, z, pitch, arc lengths of front and rear wheels.
            coms: (n, 2) least and largest x of the centre of mass [m].
            clearance: Of trunk and links from the terrain [m].
        """
        joints = np.empty((len(poses), 4))
        rules = self.rules._replace(clearance=clearance)
        slack = search.slacks(self.body, self.course, rules, poses, coms, joints)
        return slack >= -TOLERANCE, joints

    def rear_places(self, place: Place, gentle: bool = False) -> Floats:
        """Arc lengths of the rear wheel where ground and friction allow a pose, likeliest first."""
        found: Floats = places.rear_places(
            self.course, float(place.front), float(place.face), float(place.rear[0]),
            float(place.rear[1]), self.span, GRID * self.size, self._usual, self.friction,
            self.size, gentle,
        )  # fmt: skip
        return found

    def settled(self, s: float) -> bool:
        """Whether a wheel at `s` rests on ground that holds it, well past any that does not."""
        return bool(places.settled(self.course, float(s), self.friction, self.size))

    def _steep_ahead(self, s: float) -> float:
        return float(places.steep_ahead(self.course, s, self.friction, self.size))


def _start(x: Floats | None) -> Floats:
    """Unknowns (5,) of a pose's variables (9,)."""
    return _NOTHING if x is None else np.concatenate([x[:3], x[7:]])


def _found(x: Floats, numbers: Floats) -> Found:
    solution = Solution(x, float(numbers[COST]), float(numbers[VIOLATION]), "sqp")
    return Found(solution, float(numbers[MARGIN]), float(numbers[TURN]))
