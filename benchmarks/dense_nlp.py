"""The peer of the certified path: one sparse problem over the whole course, for IPOPT.

Direct transcription, as a robotics group would write it: at N places of the course the trunk, the
joints, both wheels' arc lengths and the contact forces are variables; wheels on the wheel-centre
curve, 25 collision points clear of the ground, forces in static equilibrium inside their cones, and
wheels that only roll forward are constraints; the cost keeps the posture and the way smooth.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from stairwright.planning.path.course import find_stands
from stairwright.planning.plan import Plan
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.robot.symbolic import Shape, between, dimensions, forward, to_world
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import ARC, WheelPath, wheel_path

Floats = NDArray[np.float64]

CLEARANCE = 0.006  # m
SIZE = 13  # variables a knot: trunk 3, joints 4, arc lengths 2, forces 4 (shares of the weight)


@dataclass(frozen=True)
class Answer:
    """What IPOPT made of it: whether it converged, time [s], iterations, the (N, 13) variables."""

    solved: bool
    seconds: float
    iterations: int
    knots: Floats


class DensePath:
    """The problem of one terrain, robot and friction; building it is not part of the solve."""

    def __init__(
        self, terrain: Terrain, robot: Robot, friction: float, knots: int, statics: bool = True
    ) -> None:
        self.path = wheel_path(terrain, robot.wheel.radius)
        begin, end = find_stands(terrain, robot, self.path)
        self.robot, self.friction, self.n, self.statics = robot, friction, knots, statics
        shares = np.linspace(0.0, 1.0, knots)
        ends = np.array([begin.wheels, end.wheels])
        self.wheels = ends[0] + shares[:, None] * (ends[1] - ends[0])
        self.first = self._knot(begin.body, ends[0])
        self.last = self._knot(end.body, ends[1])
        self.solver = self._build()

    def solve(self, known: Plan | None = None) -> Answer:
        """From nominal poses over evenly spread wheels, or from a `known` path."""
        start = np.stack([self._knot(self._trunk(w), w) for w in self.wheels])
        if known is not None:
            rows = np.array(
                [
                    [p.x_c, p.z_c, p.pitch, *p.q, *p.wheel_progress, 0, 0.5, 0, 0.5]
                    for p in known.poses
                ]
            )
            places = np.linspace(0, len(rows) - 1, self.n)
            start = np.stack([np.interp(places, range(len(rows)), column) for column in rows.T], 1)
        lower, upper = self._bounds(start)
        begun = time.perf_counter()
        result = self.solver(
            x0=start.ravel(),
            lbx=lower.ravel(),
            ubx=upper.ravel(),
            lbg=self._lower,
            ubg=self._upper,
        )
        seconds = time.perf_counter() - begun
        stats = self.solver.stats()
        knots = np.asarray(result["x"]).reshape(self.n, SIZE)
        return Answer(bool(stats["success"]), seconds, int(stats["iter_count"]), knots)

    def _trunk(self, wheels: Floats) -> Floats:
        a, b = self.path.centres(wheels)
        x, z = (a + b) / 2
        height = self.robot.nominal_height - self.robot.wheel.radius
        return np.array([x, max(z + 0.8 * height, a[1], b[1]), -0.8 * math.atan2(*(a - b)[::-1])])

    def _knot(self, trunk: Floats, wheels: Floats) -> Floats:
        return np.array([*trunk, *kinematics.standing_joints(self.robot), *wheels, 0, 0.5, 0, 0.5])

    def _bounds(self, start: Floats) -> tuple[Floats, Floats]:
        limits = kinematics.limits(self.robot)
        lower, upper = np.full_like(start, -np.inf), np.full_like(start, np.inf)
        lower[:, 3:7], upper[:, 3:7] = limits[:, 0], limits[:, 1]
        lower[:, 7:9], upper[:, 7:9] = 0.0, self.path.length
        lower[:, 9::2] = -5.0
        lower[:, 10::2] = 0.0
        upper[:, 9:] = 5.0
        for k, fixed in ((0, self.first), (-1, self.last)):
            lower[k, [0, 1, 2, 7, 8]] = upper[k, [0, 1, 2, 7, 8]] = fixed[[0, 1, 2, 7, 8]]
        return lower, upper

    def _build(self) -> Any:
        pose, low, high = self._pose_function()
        X = ca.SX.sym("X", SIZE, self.n)
        rows = [pose(X[:, k]) for k in range(self.n)]
        lows, highs = [low] * self.n, [high] * self.n
        cost = 0
        rest = kinematics.standing_joints(self.robot)
        for k in range(self.n):
            x = X[:, k]
            cost += 0.02 * ca.sumsqr(x[3:7] - rest) + 0.05 * x[2] ** 2
            cost += 0.05 * ca.sumsqr(x[9:] - np.array([0, 0.5, 0, 0.5]))
            if k:
                step = x - X[:, k - 1]
                cost += 10 * ca.sumsqr(step[:2]) + ca.sumsqr(step[2:7]) + 5 * ca.sumsqr(step[7:9])
                rows.append(step[7:9])
                lows.append(np.zeros(2))
                highs.append(np.full(2, 3.0 * self.path.length / self.n))
        self._lower, self._upper = np.concatenate(lows), np.concatenate(highs)
        problem = {"x": ca.vec(X), "f": cost, "g": ca.vertcat(*rows)}
        options = {"ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.mu_strategy": "adaptive"}
        options |= {"ipopt.max_iter": 500, "ipopt.acceptable_tol": 1e-3}
        return ca.nlpsol("path", "ipopt", problem, {"print_time": False, **options})

    def _pose_function(self) -> tuple[Any, Floats, Floats]:
        """Constraints of one knot, and their bounds."""
        x = ca.SX.sym("x", SIZE)
        robot, shape = self.robot, Shape.from_vector(dimensions(self.robot))
        pose = forward(shape, x[0], x[1], x[2], ca.vertsplit(x[3:7]))
        places = [_on_curve(self.path, x[7 + k]) for k in range(2)]
        equal: list[Any] = []
        for k, (centre, _) in enumerate(places):
            equal += [pose.wheels[k][0] - centre[0], pose.wheels[k][1] - centre[1]]
        com = _com(robot, pose)
        force_x, force_z, moment, cones = 0, 0, 0, []
        for k, (centre, (nx, nz)) in enumerate(places):
            t, n = x[9 + 2 * k], x[10 + 2 * k]
            fx, fz = t * nz + n * nx, -t * nx + n * nz
            cx, cz = centre[0] - shape.wheel_radius * nx, centre[1] - shape.wheel_radius * nz
            force_x += fx
            force_z += fz
            moment += (cz - com[1]) * fx - (cx - com[0]) * fz
            cones += [self.friction * n - t, self.friction * n + t]
        if self.statics:
            equal += [force_x, force_z - 1, moment]
        clear = [_height(self.path.vertices, point) for point in _points(robot, shape, pose)]
        g = ca.vertcat(*equal, *cones, *clear)
        low = np.concatenate([np.zeros(len(equal) + len(cones)), np.full(len(clear), CLEARANCE)])
        high = np.concatenate([np.zeros(len(equal)), np.full(len(cones) + len(clear), np.inf)])
        return ca.Function("pose", [x], [g]), low, high


def _on_curve(path: WheelPath, s: Any) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
    """Wheel centre and normal at arc length `s`."""
    x: Any = 0
    z: Any = 0
    nx: Any = 0
    nz: Any = 1
    for kind, begin, _, px, pz, a, b in path.pieces:
        u = s - begin
        if kind == ARC:
            angle = a - u / path.radius
            ex, ez = ca.cos(angle), ca.sin(angle)
            here = (px + path.radius * ex, pz + path.radius * ez, ex, ez)
        else:
            here = (px + u * a, pz + u * b, -b, a)
        x, z, nx, nz = (
            ca.if_else(s >= begin, new, old) if begin > 0 else new
            for new, old in zip(here, (x, z, nx, nz), strict=True)
        )
    return (x, z), (nx, nz)


def _com(robot: Robot, pose: Any) -> tuple[Any, Any]:
    """The CoM; both legs of a pair move together."""
    x, z = (robot.body.mass * part for part in pose.trunk)
    for k, leg in enumerate(robot.legs):
        parts = (
            (leg.thigh.mass, between(pose.hips[k], pose.knees[k], leg.thigh.com_along[0])),
            (leg.calf.mass, between(pose.knees[k], pose.wheels[k], leg.calf.com_along[0])),
            (leg.wheel.mass, pose.wheels[k]),
        )
        for mass, (px, pz) in parts:
            x, z = x + 2 * mass * px, z + 2 * mass * pz
    return x / robot.mass, z / robot.mass


def _points(robot: Robot, shape: Shape, pose: Any) -> list[tuple[Any, Any]]:
    """The 25 collision points."""
    layout = robot.collision_points
    half = (2 * shape.half_length, 2 * shape.half_height)
    points = [to_world(pose.trunk, pose.pitch, (half[0] * u, half[1] * v)) for u, v in layout.trunk]
    for k in range(2):
        points += [between(pose.hips[k], pose.knees[k], t) for t in layout.thigh]
        points += [between(pose.knees[k], pose.wheels[k], t) for t in layout.calf]
    return points


def _height(vertices: Floats, point: tuple[Any, Any], width: float = 0.004) -> Any:
    """Height of a point over the profile; vertical faces are `width` wide, as the paper has it."""
    x, z = vertices[:, 0].copy(), vertices[:, 1]
    for i in range(1, len(x)):
        x[i] = max(x[i], x[i - 1] + width) if z[i] != z[i - 1] else x[i]
    ground: Any = z[0]
    for i in range(1, len(x)):
        slope = (z[i] - z[i - 1]) / max(x[i] - x[i - 1], 1e-9)
        ground += slope * ca.fmin(ca.fmax(point[0] - x[i - 1], 0), x[i] - x[i - 1])
    return point[1] - ground
