"""The certificate: an independent, exact check of a plan (shapely), poses and the motion between.

It shares no geometry or statics with the planner. Between poses trunk and joints move linearly;
samples of that motion lie so close together that no point of the robot moves more than `_STRIDE`
between two of them, and clearances count less half of what it does move there: what is certified
holds in between too. Where that is too little to tell, samples lie closer still.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, get_args

import numpy as np
import shapely
from numpy.typing import NDArray

from stairwright.arguments import as_model
from stairwright.errors import InputError
from stairwright.robot import kinematics as kin
from stairwright.robot.description import Robot
from stairwright.terrain.profile import height_at

from .equilibrium import balanced
from .plan import Certificate, Check, Plan

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

WHEEL_GAP = 0.002  # m; a wheel this near to the ground touches it
WHEEL_SINK = 0.001  # m
LEGS_GAP = 0.005  # m between front and rear leg
_STRIDE = 0.006  # m
_CLOSER = 8  # times more samples where those do not settle it
_CHUNK = 64  # samples that share one piece of terrain
_JOINT_STEP = 0.35  # rad between two poses

Scope = Literal["motion", "poses"]


def certify(plan: Plan | Mapping[str, Any], scope: Scope | None = None) -> Certificate:
    """Check `plan` against terrain, robot and friction that it names.

    Args:
        plan: Any plan with poses, or its document.
        scope: ``motion`` checks the motion between poses too, ``poses`` only the poses; by default
            the motion for dense paths and the poses for the others.

    Raises:
        InputError: If an argument is bad.
    """
    plan = as_model(Plan, plan, "plan")
    if scope not in (None, *get_args(Scope)):
        raise InputError(f"must be one of: {', '.join(get_args(Scope))}", ("scope",))
    chosen: Scope = scope or ("motion" if plan.method == "path" else "poses")
    if not plan.poses:
        missing = Check(name="poses", value=0.0, bound=1.0, unit="1", passed=False)
        return Certificate(passed=False, scope=chosen, checks=[missing])
    checker = _Checker(plan, chosen)
    certificate = checker.run()
    if checker.unsettled.any():
        certificate = _Checker(plan, chosen, checker.unsettled).run()
    return certificate


class _Checker:
    """Samples of the motion (n) and the checks on them. SI units, world frame.

    Attributes:
        unsettled: (poses - 1,) after `run`: whether clearances between two poses are positive, and
            yet not more than what the robot moves between samples.
    """

    def __init__(self, plan: Plan, scope: Scope, closer: NDArray[np.bool_] | None = None) -> None:
        self.plan, self.scope = plan, scope
        self.robot: Robot = plan.robot_description
        self.vertices = plan.terrain.vertices
        self.body = np.array([[p.x_c, p.z_c, p.pitch] for p in plan.poses], float)
        self.joints = np.array([p.q for p in plan.poses], float)
        self.progress = np.array([p.progress for p in plan.poses], float)
        self.slack = np.zeros(len(plan.poses))
        self.unsettled = np.zeros(len(plan.poses) - 1, np.bool_)
        self.interval = np.arange(len(plan.poses) - 1)  # between poses, of each between samples
        if scope == "motion" and len(plan.poses) > 1:
            self._interpolate(self.unsettled if closer is None else closer)
        x, z, pitch = self.body.T
        self.frames = kin.forward(self.robot, x, z, pitch, self.joints)
        self.com = kin.com(self.robot, x, z, self.frames)
        self.chunks = self._chunks()

    def _interpolate(self, closer: NDArray[np.bool_]) -> None:
        """Replace poses by samples of the motion; `slack` bounds what happens next to them."""
        x, z, pitch = self.body.T
        frames = kin.forward(self.robot, x, z, pitch, self.joints)
        span = np.hypot(*self.robot.trunk.size[::2]) / 2
        moved = [np.hypot(np.diff(x), np.diff(z)) + span * np.abs(np.diff(pitch))]
        for points in (frames.hips, frames.knees, frames.wheels):
            moved += [np.hypot(*np.diff(points[:, leg], axis=0).T) for leg in range(2)]
        stride = np.max(moved, axis=0)
        parts = np.maximum(1, np.ceil(stride / _STRIDE)).astype(int) * np.where(closer, _CLOSER, 1)
        apart = np.repeat(stride / parts, parts)
        self.slack = 0.5 * np.maximum(np.append(apart, 0.0), np.append(0.0, apart))
        self.interval = np.repeat(np.arange(len(parts)), parts)
        knots = np.arange(len(x), dtype=float)
        first = np.cumsum(parts) - parts
        share = (np.arange(parts.sum()) - np.repeat(first, parts)) / np.repeat(parts, parts)
        at = np.append(np.repeat(knots[:-1], parts) + share, knots[-1])
        self.body = np.stack([np.interp(at, knots, c) for c in self.body.T], axis=1)
        self.joints = np.stack([np.interp(at, knots, c) for c in self.joints.T], axis=1)
        self.progress = np.interp(at, knots, self.progress)

    def run(self) -> Certificate:
        """All checks in the order of a reader's interest."""
        checks = [
            *self._wheels(),
            *self._clearances(),
            self._least("gap between front and rear leg", self._legs_gap(), LEGS_GAP, "m"),
            self._least("slack of the joint limits", self._limits(), 0.0, "rad"),
            self._balance(),
            *self._order(),
        ]
        return Certificate(passed=all(c.passed for c in checks), scope=self.scope, checks=checks)

    def _least(self, name: str, values: Floats, bound: float, unit: str) -> Check:
        k = int(np.argmin(values))
        value = float(values[k])
        return Check(
            name=name, value=value, bound=bound, unit=unit, passed=bool(value >= bound - 1e-9),
            progress=float(self.progress[k]),
        )  # fmt: skip

    def _most(self, name: str, values: Floats, bound: float, unit: str) -> Check:
        check = self._least(name, -values, -bound, unit)
        return check.model_copy(update={"value": -check.value, "bound": bound})

    def _local(self, measure: Callable[[slice, shapely.Geometry], Floats]) -> Floats:
        """Evaluate `measure` on chunks of samples, each with the terrain near it."""
        return np.concatenate([measure(chunk, line) for chunk, line in self.chunks])

    def _chunks(self) -> list[tuple[slice, shapely.Geometry]]:
        """Chunks of samples with the piece of terrain that their robots may meet."""
        reach = 1.0 + self.robot.thigh.length + self.robot.calf.length + self.robot.trunk.size[0]
        x = self.vertices[:, 0]
        out = []
        for begin in range(0, len(self.body), _CHUNK):
            chunk = slice(begin, begin + _CHUNK)
            lo, hi = self.body[chunk, 0].min() - reach, self.body[chunk, 0].max() + reach
            a = max(0, int(np.searchsorted(x, lo, side="left")) - 1)
            b = min(len(x), int(np.searchsorted(x, hi, side="right")) + 1)
            if b - a < 2:
                a, b = max(0, min(a, len(x) - 2)), max(2, b)
            line = shapely.linestrings(self.vertices[a:b])
            shapely.prepare(line)
            out.append((chunk, line))
        return out

    def _above(self, points: Floats) -> NDArray[np.bool_]:
        """Whether points (n, 2) lie above the ground; beyond the profile's ends there is none."""
        x = self.vertices[:, 0]
        beyond = (points[:, 0] < x[0]) | (points[:, 0] > x[-1])
        above: NDArray[np.bool_] = (points[:, 1] > height_at(self.vertices, points[:, 0])) | beyond
        return above

    def _wheels(self) -> list[Check]:
        """Distance of the rims from the ground."""
        gaps = []
        for leg in range(2):
            centre = self.frames.wheels[:, leg]

            def measure(chunk: slice, line: shapely.Geometry, c: Floats = centre) -> Floats:
                distance: Floats = shapely.distance(line, shapely.points(c[chunk]))
                return distance

            distance = self._local(measure)
            distance = np.where(self._above(centre), distance, -distance)
            gaps.append(distance - self.robot.wheel.radius)
        high, low = np.max(gaps, axis=0), -np.min(gaps, axis=0)
        return [
            self._most("gap between wheels and ground", high, WHEEL_GAP, "m"),
            self._most("wheels sunk into the ground", low, WHEEL_SINK, "m"),
        ]

    def _clearances(self) -> list[Check]:
        """Distance of trunk and links from the ground, less what may happen between samples."""
        size = np.array([self.robot.trunk.size[0], self.robot.trunk.size[2]]) / 2
        corners = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1], [1, 1]]) * size
        box = self.body[:, None, :2] + kin.rotate(self.body[:, 2, None], corners)

        def trunk(chunk: slice, line: shapely.Geometry) -> Floats:
            distance: Floats = shapely.distance(line, shapely.polygons(box[chunk]))
            return distance

        clear = np.where(self._above(self.body[:, :2]), self._local(trunk), -1.0)
        checks = [self._clear("clearance of the trunk", clear)]
        worst = np.full(len(self.body), np.inf)
        f = self.frames
        for leg in range(2):
            for a, b, link in (
                (f.hips, f.knees, self.robot.thigh),
                (f.knees, f.wheels, self.robot.calf),
            ):
                ends = np.stack([a[:, leg], b[:, leg]], axis=1)

                def reach(chunk: slice, line: shapely.Geometry, e: Floats = ends) -> Floats:
                    distance: Floats = shapely.distance(line, shapely.linestrings(e[chunk]))
                    return distance

                distance = np.where(self._above(ends[:, 0]), self._local(reach), -1.0)
                worst = np.minimum(worst, distance - link.radius)
        checks.append(self._clear("clearance of the links", worst))
        return checks

    def _clear(self, name: str, clearances: Floats) -> Check:
        unsettled = (clearances < self.slack) & (clearances > 0.0)
        self.unsettled[self.interval[unsettled[:-1] | unsettled[1:]]] = True
        return self._least(name, clearances - self.slack, 0.0, "m")

    def _legs_gap(self) -> Floats:
        """Distance between the links and wheels of the front and the rear leg (n,), or a bound.

        It is exact wherever the legs may be nearer to each other than at the least bound.
        """
        f, robot = self.frames, self.robot
        joints = np.stack([f.hips, f.knees, f.wheels], axis=2)  # (n, leg, joint, 2)
        low, high = joints.min(axis=2), joints.max(axis=2)
        radius = max(robot.thigh.radius, robot.calf.radius, robot.wheel.radius)
        between = np.maximum(low[:, 0] - high[:, 1], low[:, 1] - high[:, 0])
        gap: Floats = np.hypot(*np.maximum(between, 0.0).T) - 2 * radius
        first = np.array([np.argmin(gap)])
        near = np.flatnonzero(gap <= self._exact_gap(first)[0])
        gap[near] = self._exact_gap(near)
        return gap

    def _exact_gap(self, samples: Ints) -> Floats:
        """Least distance between the links and wheels of both legs at some samples (n,)."""
        f, robot = self.frames, self.robot
        parts = []
        for leg in range(2):
            hip, knee, wheel = (one[samples, leg] for one in (f.hips, f.knees, f.wheels))
            parts.append(
                [
                    (shapely.linestrings(np.stack([hip, knee], axis=1)), robot.thigh.radius),
                    (shapely.linestrings(np.stack([knee, wheel], axis=1)), robot.calf.radius),
                    (shapely.points(wheel), robot.wheel.radius),
                ]
            )
        gaps = [shapely.distance(a, b) - ra - rb for a, ra in parts[0] for b, rb in parts[1]]
        least: Floats = np.min(gaps, axis=0)
        return least

    def _limits(self) -> Floats:
        """Least distance of the joints from their limits (n,) [rad]."""
        limits = kin.limits(self.robot)
        slack: Floats = np.minimum(self.joints - limits[:, 0], limits[:, 1] - self.joints).min(
            axis=1
        )
        return slack

    def _balance(self) -> Check:
        """Whether forces inside the friction cones of all touching faces balance the weight."""
        failed = ~balanced(
            self.vertices, self.frames.wheels, self.com[:, 0],
            self.robot.wheel.radius + WHEEL_GAP, self.plan.friction,
        )  # fmt: skip
        k = int(np.argmax(failed))
        return Check(
            name="samples out of balance", value=float(failed.sum()), bound=0.0, unit="1",
            passed=not failed.any(), progress=float(self.progress[k]) if failed.any() else None,
        )  # fmt: skip

    def _order(self) -> list[Check]:
        """Progress and time rise; joints do not jump between poses."""
        poses = self.plan.poses
        if len(poses) < 2 or self.scope == "poses":
            return []
        steps = np.diff([p.progress for p in poses])
        jumps = np.abs(np.diff([p.q for p in poses], axis=0)).max(axis=1)
        widest = int(np.argmax(jumps))
        checks = [
            Check(
                name="least step of progress", value=float(steps.min()), bound=0.0, unit="m",
                passed=bool(steps.min() > 0.0),
            ),
            Check(
                name="largest joint step", value=float(jumps[widest]), bound=_JOINT_STEP,
                unit="rad", passed=bool(jumps[widest] <= _JOINT_STEP),
                progress=poses[widest].progress,
            ),
        ]  # fmt: skip
        return checks
