"""The search for one optimal pose in plain numpy and CasADi: what the compiled one is held to."""

from __future__ import annotations

import math

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.planning.poses.extra_terms import NONE, ExtraTerms
from stairwright.planning.poses.ipopt import Bounds, pose_solver
from stairwright.planning.poses.nlp import Layout
from stairwright.planning.poses.pose_search import (
    ENOUGH,
    TRIES,
    WANTED_MARGIN,
    ContactPair,
    Found,
    PoseSearch,
    Rules,
)
from stairwright.planning.poses.solution import Solution
from stairwright.planning.poses.terrain_window import SIZES, cell_vector, cells, curve_window
from stairwright.planning.weights import CriticalWeights
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.robot.symbolic import dimensions
from stairwright.terrain.profile import height_at
from stairwright.terrain.wheel_path import WheelPath

_SHIFTS = 3  # times that the reference is moved until the CoM has room
_FACE = 2e-3  # m past a corner, where the face ahead alone carries the wheel
_BESIDE = 0.35  # m of ground before the rear and after the front wheel that legs can meet


class CasadiSearch(PoseSearch):
    """Solves the same poses as `PoseSearch` with CasADi, one call at a time.

    Args:
        robot, path, friction, weights: See `PoseSearch`.
        extra: Cost terms and constraints of the user; they hold at the poses found.
        first: The solver tried first: ``daqp`` (an SQP with it, then IPOPT) or ``ipopt``.
    """

    def __init__(
        self,
        robot: Robot,
        path: WheelPath,
        friction: float,
        weights: CriticalWeights,
        extra: ExtraTerms = NONE,
        first: str = "daqp",
    ) -> None:
        super().__init__(robot, path, friction, weights)
        self.repeats = not extra  # the user's terms may depend on the place
        points = robot.points
        layout = Layout(tuple(points.trunk), tuple(points.thigh), tuple(points.calf))
        self._solvers = {
            n: pose_solver(layout, weights.exact_links, n, extra, first) for n in SIZES
        }
        self._dimensions = dimensions(robot)
        joints = kinematics.limits(robot)
        middle, half = joints.mean(axis=1), np.ptp(joints, axis=1) / 2 - 0.02
        self._inner = np.stack([middle - half, middle + half], axis=1)

    def search(self, place: ContactPair, gentle: bool = True) -> list[Found]:
        """All solved poses with the front wheel at a place; see `PoseSearch.search`."""
        found: list[Found] = []
        places = self.rear_places(place, gentle)
        for rear in places:
            one = self.solve(place, rear, start=found[-1].solution.x if found else None)
            if one.solution.solved:
                found.append(one)
                if sum(other.margin >= 0.99 * WANTED_MARGIN for other in found) >= ENOUGH:
                    break
        if not found:
            hard = [self.solve(place, rear, patient=True) for rear in places[:TRIES]]
            found = [one for one in hard if one.solution.solved]
        return found

    def solve(
        self,
        place: ContactPair,
        rear: float,
        *,
        patient: bool = False,
        rules: Rules | None = None,
        start: Floats | None = None,
    ) -> Found:
        """The optimal pose with the rear wheel near `rear`; see `PoseSearch.solve`."""
        window, size = self.window(place.front, rear)
        x_ref = float(self.path.centres(np.array([place.front, rear]))[:, 0].mean())
        bounds = _bounds(rules or self.rules, place, rear)
        found: Found | None = None
        for _ in range(_SHIFTS):
            reference = self.reference(x_ref)
            starts = [
                self._guess(place, rear, reference),
                self._guess(place, rear, reference, float(place.posture[0])),
                self._guess(place, rear, reference, -0.6 if place.climbs else 0.6, 0.3),
            ]
            if start is not None:
                starts.insert(0, start)
            numbers = np.concatenate([reference, self.rules.weights, self._dimensions, window])
            solution = self._solvers[size].solve(numbers, bounds, starts, patient)
            shift, margin = self._com_shift(solution, place)
            turn = float(np.sum((solution.x[2:7] - place.posture) ** 2))
            if found is None or (solution.solved and margin > found.margin):
                found = Found(solution, margin, turn)
            if not solution.solved or abs(shift) < 1e-3:
                break
            start = solution.x
            moved = float(solution.x[0]) + shift - x_ref
            if abs(moved) < 3e-3:
                break
            x_ref += moved
        assert found is not None
        return found

    def reference(self, x: float) -> Floats:
        """Trunk and joints (7,) that eq 17 pulls to: nominal height over the ground below."""
        hips = self.robot.hips
        below = np.linspace(x + hips.rear[0], x + hips.front[0], 15)
        ground = float(height_at(self.path.vertices, below).mean())
        return np.array([x, ground + self.robot.nominal_height, 0.0, *self.standing])

    def window(self, front: float, rear: float) -> tuple[Floats, int]:
        """Parameters of the terrain, and the number of ground cells among them."""
        curves = [curve_window(self.path, s)[0].ravel() for s in (front, rear)]
        x = self.path.centres(np.array([front, rear]))[:, 0]
        beside = _BESIDE * self.scale
        ground = cell_vector(cells(self.path.vertices, x.min() - beside, x.max() + beside))
        vector = np.concatenate([*curves, *(part.ravel() for part in ground)])
        return vector, len(ground[0])

    def _guess(
        self,
        place: ContactPair,
        rear: float,
        reference: Floats,
        pitch: float | None = None,
        higher: float = 0.0,
    ) -> Floats:
        """Trunk along the line of the wheels or at `pitch` [rad]; legs to the wheels.

        It is raised by `higher` times the nominal height.
        """
        wheels = self.path.centres(np.array([place.front, rear]))
        rise, run = wheels[0] - wheels[1], max(wheels[0, 0] - wheels[1, 0], 0.1)
        pitch = -0.8 * math.atan2(rise[1], run) if pitch is None else pitch
        z = max(reference[1], wheels[:, 1].mean() + 0.5 * self.robot.nominal_height)
        z += higher * self.robot.nominal_height
        x = np.asarray(reference[0])
        q = kinematics.inverse(self.robot, x, np.asarray(z), np.asarray(pitch), wheels)
        q = np.where(np.isfinite(q), q, self.standing)
        q = np.clip(q, self._inner[:, 0], self._inner[:, 1])
        return np.array([x, z, pitch, *q, place.front, rear])

    def _com_shift(self, solution: Solution, place: ContactPair) -> tuple[float, float]:
        """Least shift of the CoM that gives it the margin wanted, and its margin [m]."""
        if not solution.solved:
            return 0.0, -np.inf
        x = solution.x
        x_c, z_c, pitch = (np.asarray(value) for value in x[:3])
        frames = kinematics.forward(self.robot, x_c, z_c, pitch, x[3:7])
        com = float(kinematics.com(self.robot, x_c, z_c, pitch, frames)[0])
        low, high = self._interval(x[7], x[8])
        # Just after the first pose the face alone carries the front wheel; on the way down it still
        # does just before the second one, and there the CoM has the least time to move on.
        if place.ahead or not place.climbs:
            on_face = x[7] + _FACE if place.ahead else place.face
            a, b = self._interval(on_face, x[8])
            if max(low, a) <= min(high, b):
                low, high = max(low, a), min(high, b)
        if low > high:
            return 0.0, -np.inf
        spare = min(WANTED_MARGIN, (high - low) / 2)
        wanted = min(max(com, low + spare), high - spare)
        return wanted - com, min(com - low, high - com)

    def _interval(self, front: float, rear: float) -> tuple[float, float]:
        wheels = np.array([[front, rear]])
        low, high = _core.com_intervals(self.path.native, wheels, self.friction)[0].tolist()
        return low, high


def _bounds(rules: Rules, place: ContactPair, rear: float) -> Bounds:
    """Bounds with the front wheel fixed and the rear one free near `rear`."""
    lower, upper = rules.lower.copy(), rules.upper.copy()
    lower[7] = upper[7] = place.front
    lower[8] = max(place.rear[0], rear - _core.REAR_SPACING / 2)
    upper[8] = max(lower[8], min(place.rear[1], rear + _core.REAR_SPACING / 2))
    behind = rules.behind if place.climbs else -np.inf
    return Bounds(lower, upper, rules.clearance, rules.legs_distance, behind)
