"""One optimal pose: where the rear wheel and the trunk should be, found by solving there."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.robot.symbolic import dimensions
from stairwright.terrain.profile import height_at
from stairwright.terrain.wheel_path import WheelPath

from .clearance import clearance, legs_apart
from .nlp import Layout
from .solver import Bounds, Solution, pose_solver
from .supports import support
from .terrain_window import SIZES, cell_vector, cells, curve_window
from .weights import CriticalWeights

Floats = NDArray[np.float64]

CLEARANCE = 0.012  # m between trunk or links and the terrain at a critical pose
BETWEEN = 0.004  # m, the same between critical poses, where room is scarce
APART = 0.006  # m between front and rear leg
WANTED = 0.05  # m of CoM margin beyond which other things decide
GRID = 0.05  # m between the rear wheel places that are tried
ENOUGH = 3  # poses with the room wanted; then the search ends
TRIES = 4  # places that the slower solvers are tried at where the fast one finds nothing
SETTLE = 0.10  # m that a resting rear wheel is past steep ground, for legs of 0.4 m
GRIP = 0.9  # of the friction angle: steeper ground does not hold a resting wheel alone
TURN = 0.05  # 1/rad^2; what turning the joints weighs against room for the CoM
_NEAREST = np.array([100.0, 30.0, 3.0, 0.05, 0.05, 0.05, 0.05])  # 1/m^2, 1/rad^2
_FACE = 2e-3  # m past a corner, where the face ahead alone carries the wheel
_BESIDE = 0.35  # m of ground before the rear and after the front wheel that legs can meet


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
        posture: (5,) pitch and joints of the pose before [rad].
    """

    front: float
    rear: tuple[float, float]
    ahead: bool
    face: float
    climbs: bool
    posture: Floats


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
        return min(self.margin, WANTED) / WANTED - TURN * self.turn


class PoseSearch:
    """Solves poses of one robot on one terrain."""

    def __init__(
        self, robot: Robot, path: WheelPath, friction: float, weights: CriticalWeights
    ) -> None:
        self.robot, self.path, self.friction = robot, path, friction
        points = robot.collision_points
        layout = Layout(tuple(points.trunk), tuple(points.thigh), tuple(points.calf))
        self._solvers = {n: pose_solver(layout, weights.exact_links, n) for n in SIZES}
        self.standing = kinematics.standing_joints(robot)
        self.size = (robot.thigh.length + robot.calf.length) / 0.4
        self._dimensions = dimensions(robot)
        w = weights
        self._weights = np.array([w.com_x, w.com_z, w.pitch, *[w.posture] * 4])
        # Inside the limits by more than what solvers leave open.
        joints = kinematics.limits(robot) + np.array([1e-5, -1e-5])
        self._lower = np.array([-1e3, -1e3, -math.pi, *joints[:, 0], 0.0, 0.0])
        self._upper = np.array([1e3, 1e3, math.pi, *joints[:, 1], 0.0, 0.0])
        middle, half = joints.mean(axis=1), np.ptp(joints, axis=1) / 2 - 0.02
        self._inner = np.stack([middle - half, middle + half], axis=1)
        reach = robot.thigh.length + robot.calf.length
        self.span = (
            2 * robot.wheel.radius + APART,
            2 * reach + robot.hips.front[0] - robot.hips.rear[0],
        )

    def best_pair(self, first: Place, second: Place) -> tuple[Found | None, Found | None]:
        """The poses before and after a face; the rear wheel crosses no steep ground between."""
        best: tuple[float, Found, Found | None] | None = None
        for gentle in (True, False):
            options = sorted(self.search(first, gentle), key=lambda found: -found.score)
            for one in options[:ENOUGH]:
                rear = float(one.solution.x[8])
                stop = self._steep_ahead(rear) if gentle else second.rear[1]
                stop = min(stop, second.rear[1])
                place = replace(second, rear=(rear, stop), posture=one.solution.x[2:7])
                later = max(self.search(place, gentle), key=lambda found: found.score, default=None)
                value = one.score + (later.score if later else -10.0)
                if best is None or value > best[0]:
                    best = value, one, later
                if later is not None and later.margin >= 0.99 * WANTED:
                    return one, later
            if best is not None and best[2] is not None:
                break
        return (best[1], best[2]) if best else (None, None)

    def search(self, place: Place, gentle: bool = True) -> list[Found]:
        """All solved poses with the front wheel at a place, one for each rear wheel place tried.

        Args:
            place: Where.
            gentle: Rest the rear wheel only on ground that holds it alone.
        """
        found: list[Found] = []
        places = self.rear_places(place, gentle)
        for rear in places:
            one = self.solve(place, rear, found[-1].solution.x if found else None)
            if one.solution.solved:
                found.append(one)
                if sum(other.margin >= 0.99 * WANTED for other in found) >= ENOUGH:
                    break
        if not found:
            hard = [self.solve(place, rear, patient=True) for rear in places[:TRIES]]
            found = [one for one in hard if one.solution.solved]
        return found

    def solve(
        self,
        place: Place,
        rear: float,
        start: Floats | None = None,
        patient: bool = False,
        bounds: Bounds | None = None,
    ) -> Found:
        """The optimal pose with the rear wheel near `rear`.

        The trunk is first pulled to the middle between the wheels, then, where that leaves the
        centre of mass less room than `WANTED`, by what is missing.
        """
        window, size = self._window(place.front, rear)
        x_ref = float(self.path.centres(np.array([place.front, rear]))[:, 0].mean())
        bounds = bounds or self.bounds(place, rear)
        found: Found | None = None
        for _ in range(4):
            reference = self._reference(x_ref)
            starts = [
                self._guess(place, rear, reference),
                self._guess(place, rear, reference, True),
            ]
            if start is not None:
                starts.insert(0, start)
            parameters = np.concatenate([reference, self._weights, self._dimensions, window])
            solution = self._solvers[size].solve(parameters, bounds, starts, patient)
            shift, margin = self._com_shift(solution, place)
            turn = float(np.sum((solution.x[2:7] - place.posture) ** 2))
            if found is None or (solution.solved and margin > found.margin):
                found = Found(solution, margin, turn)
            if not solution.solved or abs(shift) < 1e-3:
                break
            start = solution.x
            x_ref = float(solution.x[0]) + shift
        assert found is not None
        return found

    def nearest(
        self,
        wheels: tuple[float, float],
        trunk: Floats,
        q: Floats,
        start: Floats | None = None,
        *,
        patient: bool = False,
    ) -> Solution:
        """The pose with the wheels at given places that is nearest to a trunk pose.

        Limits and clearances hold; eq 20 does not apply between critical poses.

        Args:
            wheels: Arc lengths of front and rear wheels [m].
            trunk: (3,) x, z [m] and pitch [rad] wanted.
            q: (4,) joints wanted, which count little.
            start: (9,) first guess.
            patient: Go on to slower solvers where the fast one fails.
        """
        lower, upper = self._lower.copy(), self._upper.copy()
        lower[7:] = upper[7:] = wheels
        window, size = self._window(*wheels)
        wanted = np.concatenate([trunk, q])
        parameters = np.concatenate([wanted, _NEAREST, self._dimensions, window])
        starts = [np.concatenate([wanted, wheels])]
        if start is not None:
            starts.insert(0, start)
        for clearance_wanted in (CLEARANCE, BETWEEN):
            bounds = Bounds(lower, upper, clearance_wanted, APART, -np.inf)
            solution = self._solvers[size].solve(
                parameters, bounds, starts, patient and clearance_wanted == BETWEEN
            )
            if solution.solved:
                break
        return solution

    def bounds(self, place: Place, rear: float) -> Bounds:
        """Bounds with the front wheel fixed and the rear one free within half a grid step."""
        lower, upper = self._lower.copy(), self._upper.copy()
        lower[7] = upper[7] = place.front
        lower[8] = max(place.rear[0], rear - GRID / 2)
        upper[8] = max(lower[8], min(place.rear[1], rear + GRID / 2))
        return Bounds(lower, upper, CLEARANCE, APART, 0.0 if place.climbs else -np.inf)

    def clear(self, trunk: tuple[float, float, float], q: Floats) -> bool:
        """Whether a pose with known joints keeps the clearances asked for."""
        gap, _ = clearance(self.robot, self.path.vertices, trunk, q)
        return gap >= CLEARANCE - 1e-6 and legs_apart(self.robot, trunk, q) >= APART - 1e-6

    def rear_places(self, place: Place, gentle: bool = False) -> Floats:
        low = max(place.rear[0], place.front - 1.2 * self.span[1])
        high = min(place.rear[1], place.front)
        if high < low:
            return np.array([])
        s = np.linspace(low, high, max(1, int((high - low) / (GRID * self.size)) + 1))
        ends = self.path.centres(np.array([place.front]))[0]
        gap = np.hypot(*(self.path.centres(s) - ends).T)
        keep = (gap >= self.span[0]) & (gap <= self.span[1])
        if gentle:
            keep &= np.array([self.settled(float(one)) for one in s], dtype=bool)
        for i in np.flatnonzero(keep):
            low_com, high_com = support(self.path, place.face, s[i]).com_interval(self.friction)
            keep[i] = low_com <= high_com
        # From the place like standing outward: neighbours start from each other's solution.
        wheelbase = self.robot.hips.front[0] - self.robot.hips.rear[0]
        order = np.argsort(np.abs(gap[keep] - 1.4 * wheelbase), kind="stable")
        places: Floats = s[keep][order]
        return places

    def settled(self, s: float) -> bool:
        """Whether a wheel at `s` rests: on ground that holds it, and well past any that does not.

        A wheel that has only just climbed an edge would leave the whole climb to the short way of
        the other wheel before.
        """
        places = s - np.array([0.0, 0.25, 0.5, 0.75, 1.0]) * SETTLE * self.size
        normals = self.path.normals(np.maximum(places, 0.0))
        slope = np.abs(np.arctan2(normals[:, 0], normals[:, 1]))
        return bool(np.all(slope <= GRIP * math.atan(self.friction)))

    def _steep_ahead(self, s: float) -> float:
        """Arc length of the next ground ahead of `s` that does not hold a resting wheel alone."""
        limit = GRIP * math.atan(self.friction)
        places = np.arange(s, s + 3.0 * self.size, 0.005)
        normals = self.path.normals(places)
        steep = np.abs(np.arctan2(normals[:, 0], normals[:, 1])) > limit
        return float(places[np.argmax(steep)]) if steep.any() else np.inf

    def _reference(self, x: float) -> Floats:
        """Trunk and joints (7,) that eq 17 pulls to: nominal height over the ground below."""
        hips = self.robot.hips
        below = np.linspace(x + hips.rear[0], x + hips.front[0], 15)
        ground = float(height_at(self.path.vertices, below).mean())
        return np.array([x, ground + self.robot.nominal_height, 0.0, *self.standing])

    def _window(self, front: float, rear: float) -> tuple[Floats, int]:
        """Parameters of the terrain, and the number of ground cells among them."""
        curves = [curve_window(self.path, s)[0].ravel() for s in (front, rear)]
        x = self.path.centres(np.array([front, rear]))[:, 0]
        beside = _BESIDE * self.size
        ground = cell_vector(cells(self.path.vertices, x.min() - beside, x.max() + beside))
        vector = np.concatenate([*curves, *(part.ravel() for part in ground)])
        return vector, len(ground[0])

    def _guess(self, place: Place, rear: float, reference: Floats, same: bool = False) -> Floats:
        """Trunk along the line of the wheels, or pitched as before (`same`); legs to the wheels."""
        wheels = self.path.centres(np.array([place.front, rear]))
        rise, run = wheels[0] - wheels[1], max(wheels[0, 0] - wheels[1, 0], 0.1)
        pitch = float(place.posture[0]) if same else -0.8 * math.atan2(rise[1], run)
        z = max(reference[1], wheels[:, 1].mean() + 0.5 * self.robot.nominal_height)
        x = np.asarray(reference[0])
        q = kinematics.inverse(self.robot, x, np.asarray(z), np.asarray(pitch), wheels)
        q = np.where(np.isfinite(q), q, self.standing)
        q = np.clip(q, self._inner[:, 0], self._inner[:, 1])
        return np.array([x, z, pitch, *q, place.front, rear])

    def _com_shift(self, solution: Solution, place: Place) -> tuple[float, float]:
        """Least shift of the CoM that gives it the room wanted, and the room that it has [m]."""
        if not solution.solved:
            return 0.0, -np.inf
        x = solution.x
        x_c, z_c, pitch = (np.asarray(value) for value in x[:3])
        frames = kinematics.forward(self.robot, x_c, z_c, pitch, x[3:7])
        com = float(kinematics.com(self.robot, x_c, z_c, frames)[0])
        low, high = support(self.path, x[7], x[8]).com_interval(self.friction)
        # Just after the first pose the face alone carries the front wheel; on the way down it still
        # does just before the second one, and there the CoM has the least time to move on.
        if place.ahead or not place.climbs:
            on_face = x[7] + _FACE if place.ahead else place.face
            a, b = support(self.path, on_face, x[8]).com_interval(self.friction)
            if max(low, a) <= min(high, b):
                low, high = max(low, a), min(high, b)
        if low > high:
            return 0.0, -np.inf
        room = min(WANTED, (high - low) / 2)
        wanted = min(max(com, low + room), high - room)
        return wanted - com, min(com - low, high - com)
