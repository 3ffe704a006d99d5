"""Distances of the robot from the ground and of its legs from each other, for the certificate.

Exact (shapely) wherever they may be the least or less than the motion between two samples; what is
farther off is told by bounds, at a fraction of the time. Ground more than a metre away is not seen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from stairwright.planning.certificate.motion import Samples
from stairwright.robot import kinematics as kin
from stairwright.terrain.profile import height_at

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Shapes = NDArray[Any]  # of shapely geometries

_CHUNK = 64  # samples that share one piece of terrain
_FEW = 16  # samples that are no more than this are all looked at exactly, which is sooner
_SIGHT = 0.01  # m; clearance up to which parts are looked at before one is known
_MORE = 1e-6  # m; so much more is looked at than matters: what is not seen is farther off for sure


class Distances:
    """Distances (n,) [m] at the samples of a motion."""

    def __init__(self, samples: Samples) -> None:
        self.samples = samples
        self.robot, self.body = samples.motion.robot, samples.motion.body
        self.vertices = samples.motion.vertices
        self.starts = np.arange(0, len(self.body), _CHUNK)
        self.lines = [self._ground_near(self.body[k : k + _CHUNK, 0]) for k in self.starts]
        self.capsules = [self._capsules(leg) for leg in range(2)]
        self.everywhere = np.arange(len(self.body))

    def wheels(self) -> list[Floats]:
        """Of the rims of the front and of the rear wheels from the ground; negative where sunk."""
        out = []
        for centres in np.moveaxis(self.samples.frames.wheels, 1, 0):
            distance = self._from_ground(shapely.points(centres), self.everywhere)
            distance = np.where(self._above(centres), distance, -distance)
            out.append(distance - self.robot.wheel.radius)
        return out

    def trunk(self) -> Floats:
        """Of the trunk from the ground; see `_clearances`."""
        parts = []
        for piece in self.robot.body.outline:
            corners = np.array([*piece.points, piece.points[0]])
            placed = self.body[:, None, :2] + kin.rotate(self.body[:, 2, None], corners)
            parts.append((placed, 0.0, placed[:, :-1].mean(axis=1)))
        return self._clearances(parts, shapely.polygons)

    def links(self) -> Floats:
        """Of thighs and calves from the ground; see `_clearances`."""
        parts = [
            (line, radius, line[:, 0])
            for leg in range(2)
            for line, radius in reversed(self.capsules[leg])
        ]
        return self._clearances(parts, shapely.linestrings)

    def _capsules(self, leg: int) -> list[tuple[Floats, float]]:
        """Axes (n, 2, 2) and radii of the capsules of a leg's thigh and calf [m]."""
        f, own = self.samples.frames, self.robot.legs[leg]
        out = []
        for link, upper, lower in ((own.thigh, f.hips, f.knees), (own.calf, f.knees, f.wheels)):
            down = (lower[:, leg] - upper[:, leg]) / link.length
            ahead = np.stack([-down[:, 1], down[:, 0]], axis=1)
            for start, end, radius in link.capsules:
                ends = [upper[:, leg] + x * ahead - z * down for x, z in (start, end)]
                out.append((np.stack(ends, axis=1), radius))
        return out

    def legs(self) -> Floats:
        """Between links and wheels of the front and the rear leg, exact where it may be least."""
        if len(self.body) <= _FEW:
            return self._between_legs(self.everywhere)
        radius, wheels = self.robot.wheel.radius, self.samples.frames.wheels
        boxes = []
        for leg in range(2):
            ends = [(line[:, k], r) for line, r in self.capsules[leg] for k in range(2)]
            ends.append((wheels[:, leg], radius))
            low = reduce(np.minimum, [at - r for at, r in ends])
            boxes.append((low, reduce(np.maximum, [at + r for at, r in ends])))
        (low, high), (rear_low, rear_high) = boxes
        between = np.maximum(low - rear_high, rear_low - high)
        gap: Floats = np.hypot(*np.maximum(between, 0.0).T)
        first = np.array([np.argmin(gap)])
        near = np.flatnonzero(gap <= max(self._between_legs(first)[0], 0.0))
        gap[near] = self._between_legs(near)
        return gap

    def _clearances(
        self,
        parts: Sequence[tuple[Floats, float, Floats]],
        shape: Callable[[Floats], Shapes],
    ) -> Floats:
        """Least clearance of some parts from the ground.

        It is exact where it may be less than a sample's slack, or where it may be the least of all
        after that is taken off; elsewhere it is a bound.

        Args:
            parts: Outlines (n, k, 2), radii round them [m], and a point (n, 2) of each that shows
                whether it lies above the ground.
            shape: What makes shapely's geometries of outlines.
        """
        if len(self.body) <= _FEW:
            return self._few_clearances(parts, shape)
        slack = self.samples.slack
        worst = np.full(len(slack), np.inf)
        for outline, radius, point in parts:

            def exact(
                k: Ints, line: Floats = outline, r: float = radius, at: Floats = point
            ) -> Floats:
                distance = self._from_ground(shape(line[k]), k)
                return np.where(self._above(at[k]), distance, -1.0) - r

            # What is worst so far, or first sight shows, tells how much ground has to be looked at.
            corners = list(np.moveaxis(outline, 1, 0))
            box = reduce(np.minimum, corners), reduce(np.maximum, corners)
            bound = self._at_least(*box, _SIGHT + radius) - radius - slack
            first = np.array([np.argmin(bound)])
            least = max(min(np.min(worst - slack), (exact(first) - slack[first])[0]), 0.0)
            clear = self._at_least(*box, least + slack.max() + radius + _MORE) - radius
            near = np.flatnonzero(clear - slack <= least)
            clear[near] = exact(near)
            worst = np.minimum(worst, clear)
        return worst

    def _few_clearances(
        self,
        parts: Sequence[tuple[Floats, float, Floats]],
        shape: Callable[[Floats], Shapes],
    ) -> Floats:
        """`_clearances` of few samples, in the first piece of ground: exact for all parts."""
        shapes = np.stack([shape(outline) for outline, _, _ in parts])
        above = self._above(np.concatenate([point for _, _, point in parts])).reshape(shapes.shape)
        distance = np.where(above, shapely.distance(self.lines[0], shapes), -1.0)
        least: Floats = (distance - np.array([[radius] for _, radius, _ in parts])).min(axis=0)
        return least

    def _at_least(self, low: Floats, high: Floats, most: float) -> Floats:
        """A bound of the distance (n,) of what lies between corners `low` and `high` (n, 2) from
        the ground, at most `most`: what lies ahead or behind by more than that is no matter.
        """
        left, right = low[:, 0] - most, high[:, 0] + most
        x, z = self.vertices.T
        ends = np.maximum(np.interp(left, x, z), np.interp(right, x, z))
        a, b = np.searchsorted(x, left, side="left"), np.searchsorted(x, right, side="right")
        between = np.stack([a, b], axis=1).ravel()
        inner = np.maximum.reduceat(np.append(z, -np.inf), between)[::2]
        highest = np.maximum(ends, np.where(a < b, inner, -np.inf))
        bound: Floats = np.minimum(low[:, 1] - highest, most)
        return bound

    def _from_ground(self, shapes: Shapes, samples: Ints) -> Floats:
        """Distance of `shapes` (k,) at `samples` (k,), which rise, from the ground near them."""
        out = np.empty(len(samples))
        edges = [0, *np.searchsorted(samples, self.starts[1:]).tolist(), len(samples)]
        for line, (a, b) in zip(self.lines, pairwise(edges), strict=True):
            if a < b:
                out[a:b] = shapely.distance(line, shapes[a:b])
        return out

    def _ground_near(self, x: Floats) -> shapely.Geometry:
        """The piece of terrain that robots may meet whose trunks are at `x`."""
        robot = self.robot
        reach = 1.0 + max(leg.reach for leg in robot.legs) + 2 * robot.body.span
        places = self.vertices[:, 0]
        a = max(0, int(np.searchsorted(places, x.min() - reach, side="left")) - 1)
        b = min(len(places), int(np.searchsorted(places, x.max() + reach, side="right")) + 1)
        if b - a < 2:
            a, b = max(0, min(a, len(places) - 2)), max(2, b)
        line = shapely.linestrings(self.vertices[a:b])
        shapely.prepare(line)
        return line

    def _above(self, points: Floats) -> NDArray[np.bool_]:
        """Whether points (n, 2) lie above the ground; beyond the profile's ends there is none."""
        x = self.vertices[:, 0]
        beyond = (points[:, 0] < x[0]) | (points[:, 0] > x[-1])
        above: NDArray[np.bool_] = (points[:, 1] > height_at(self.vertices, points[:, 0])) | beyond
        return above

    def _between_legs(self, samples: Ints) -> Floats:
        """Least distance between the links and wheels of both legs at some samples (n,)."""
        wheels = self.samples.frames.wheels[samples]
        parts = [
            [(shapely.linestrings(line[samples]), radius) for line, radius in self.capsules[leg]]
            + [(shapely.points(wheels[:, leg]), self.robot.wheel.radius)]
            for leg in range(2)
        ]
        gaps = [shapely.distance(a, b) - ra - rb for a, ra in parts[0] for b, rb in parts[1]]
        least: Floats = np.min(gaps, axis=0)
        return least
