"""Distances of the robot from the ground and of its legs from each other, for the certificate.

Exact (shapely) wherever they may be the least or less than the motion between two samples. What is
farther off is told by bounds, at a fraction of the time: from one sample to the next no distance
changes by more than the parts move. Ground more than a metre away is not seen.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from stairwright.planning.certificate.equilibrium import NearFaces
from stairwright.planning.certificate.motion import Samples
from stairwright.robot import kinematics as kin
from stairwright.terrain.profile import height_at

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]
Shapes = NDArray[Any]  # of shapely geometries
Exact = Callable[[Ints, Ints], Floats]  # distances at some samples of some parts

_CHUNK = 128  # samples that share one piece of terrain
_FEW = 16  # samples that are no more than this are all looked at exactly, which is sooner
_STEPS = (12, 3, 1)  # every so manieth sample is looked at, where what is known leaves it open
_JUMP = 1e3  # m; more than any distance
_MORE = 1e-6  # m; so much more is looked at than matters: what is not is farther off for sure


class Distances:
    """Distances (n,) [m] at the samples of a motion."""

    def __init__(self, samples: Samples) -> None:
        self.samples = samples
        self.robot, self.body = samples.motion.robot, samples.motion.body
        self.vertices = samples.motion.vertices
        self.starts = np.arange(0, len(self.body), _CHUNK)
        self.lines = [self._ground_near(self.body[k : k + _CHUNK, 0]) for k in self.starts]
        self.axes, self.radii = zip(*(self._capsules(leg) for leg in range(2)), strict=True)

    def wheels(self, near: NearFaces) -> list[Floats]:
        """Of the rims of the front and of the rear wheels from the ground; negative where sunk.

        Args:
            near: The faces near to all wheels (2 n,); where one sees none, shapely is asked.
        """
        wheels = self.samples.frames.wheels
        distance = near.distances[:, 0].copy()
        far = np.flatnonzero(np.isinf(distance))
        if len(far):
            centres = shapely.points(wheels.reshape(-1, 2)[far])
            distance[far] = self._from_ground(centres, far // 2)
        distance = np.where(self._above(wheels), distance.reshape(-1, 2), -distance.reshape(-1, 2))
        return list(distance.T - self.robot.wheel.radius)

    def trunk(self) -> Floats:
        """Of the trunk from the ground; see `_where_it_matters`."""
        outlines = [
            self.body[:, None, :2] + kin.rotate(self.body[:, 2, None], np.array(piece.points))
            for piece in self.robot.body.outline
        ]

        def exact(k: Ints, part: Ints) -> Floats:
            out = np.empty(len(k))
            for i, outline in enumerate(outlines):
                mine = part == i
                corners = outline[k[mine]]
                distance = self._from_ground(shapely.polygons(corners), k[mine])
                out[mine] = np.where(self._above(corners.mean(axis=1)), distance, -1.0)
            return out

        def moved() -> Floats:
            middles = np.stack([outline.mean(axis=1) for outline in outlines], axis=1)
            steps = np.stack([_moved(outline) for outline in outlines], axis=1)
            return steps + self._jumps(middles)

        return _where_it_matters(exact, self.samples.slack, len(outlines), moved)

    def links(self) -> Floats:
        """Of thighs and calves from the ground; see `_where_it_matters`."""
        axes, radii = np.concatenate(self.axes, axis=1), np.concatenate(self.radii)

        def exact(k: Ints, part: Ints) -> Floats:
            lines = axes[k, part]
            distance = self._from_ground(shapely.linestrings(lines), k)
            clear: Floats = np.where(self._above(lines[:, 0]), distance, -1.0) - radii[part]
            return clear

        def moved() -> Floats:
            return _moved(axes) + self._jumps(axes[:, :, 0])

        return _where_it_matters(exact, self.samples.slack, len(radii), moved)

    def legs(self) -> Floats:
        """Between links and wheels of the front and the rear leg, exact where it may be least."""
        wheels, tyre = self.samples.frames.wheels, self.robot.wheel.radius
        axes = [  # of wheels, too: one that has no length
            np.concatenate([axes, np.repeat(wheels[:, leg, None, None], 2, axis=2)], axis=1)
            for leg, axes in enumerate(self.axes)
        ]
        front, rear = (np.append(radii, tyre) for radii in self.radii)
        touch = front[:, None] + rear

        def exact(k: Ints) -> Floats:
            lines = [shapely.linestrings(ends[k]) for ends in axes]
            apart = shapely.distance(lines[0][:, :, None], lines[1][:, None])
            least: Floats = np.min(apart - touch, axis=(1, 2))
            return least

        def nearly(k: Ints, _part: Ints) -> Floats:
            apart = _apart(axes[0][k][:, :, None], axes[1][k][:, None])
            least: Floats = np.min(apart - touch, axis=(1, 2))
            return least

        def moved() -> Floats:
            steps = [_moved(ends.reshape(len(ends), 1, -1, 2)) for ends in axes]
            return steps[0] + steps[1]

        n = len(self.body)
        if n <= _FEW:
            return exact(np.arange(n))
        out = _where_it_matters(nearly, np.zeros(n), 1, moved)
        k = np.flatnonzero(out <= out.min() + _MORE)
        out[k] = exact(k)
        return out

    def _capsules(self, leg: int) -> tuple[Floats, Floats]:
        """Axes (n, k, 2, 2) and radii (k,) of the capsules of a leg's thigh and calf [m]."""
        f, own = self.samples.frames, self.robot.legs[leg]
        lines, radii = [], []
        for link, upper, lower in ((own.thigh, f.hips, f.knees), (own.calf, f.knees, f.wheels)):
            down = (lower[:, leg] - upper[:, leg]) / link.length
            ahead = np.stack([-down[:, 1], down[:, 0]], axis=1)
            for start, end, radius in link.capsules:
                ends = [upper[:, leg] + x * ahead - z * down for x, z in (start, end)]
                lines.append(np.stack(ends, axis=1))
                radii.append(radius)
        return np.stack(lines, axis=1), np.array(radii)

    def _from_ground(self, shapes: Shapes, samples: Ints) -> Floats:
        """Distance of `shapes` (k,) at `samples` (k,), which do not fall, from the ground near."""
        out = np.empty(shapes.shape)
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
        return shapely.linestrings(self.vertices[a:b])

    def _above(self, points: Floats) -> Flags:
        """Whether points (..., 2) lie above the ground; beyond the profile's ends there is none."""
        x = points[..., 0]
        height = height_at(self.vertices, x.ravel()).reshape(x.shape)
        above: Flags = (points[..., 1] > height) | self._beyond(x)
        return above

    def _beyond(self, x: Floats) -> Flags:
        first, last = self.vertices[[0, -1], 0]
        beyond: Flags = (x < first) | (x > last)
        return beyond

    def _jumps(self, points: Floats) -> Floats:
        """How far (n - 1, k) a clearance may jump from one sample to the next, whose sign is told
        by a point (n, k, 2): where that passes an end of the profile [m].
        """
        return np.where(np.diff(self._beyond(points[..., 0]), axis=0), _JUMP, 0.0)


def _moved(corners: Floats) -> Floats:
    """The most (n - 1, ...) that `corners` (n, ..., k, 2) move from one sample to the next [m]."""
    x, z = np.diff(corners[..., 0], axis=0), np.diff(corners[..., 1], axis=0)
    most: Floats = np.sqrt((x * x + z * z).max(axis=-1))
    return most


def _apart(one: Floats, other: Floats) -> Floats:
    """Distances (...) of segments (..., 2, 2), found without shapely; 0 where they cross."""
    # As complex numbers: the real part of conj(u) v is their dot product, the other their cross.
    a, b = np.moveaxis(one[..., 0] + 1j * one[..., 1], -1, 0)
    c, d = np.moveaxis(other[..., 0] + 1j * other[..., 1], -1, 0)
    nearest, sides = [], []
    for begin, line, points in ((a, b - a, (c, d)), (c, d - c, (a, b))):
        square = np.maximum((line * np.conj(line)).real, 1e-18)
        for point in points:
            turned = np.conj(line) * (point - begin)
            share = np.clip(turned.real / square, 0.0, 1.0)
            nearest.append(np.abs(point - begin - share * line))
            sides.append(turned.imag)
    crossing = (sides[0] * sides[1] < 0.0) & (sides[2] * sides[3] < 0.0)
    return np.where(crossing, 0.0, np.min(nearest, axis=0))


def _where_it_matters(
    exact: Exact, slack: Floats, parts: int, moved: Callable[[], Floats]
) -> Floats:
    """Least distances (n,) of some parts, exact where they may be less than a sample's slack, or
    may be the least of all after that is taken off; elsewhere bounds: no more than the distance.

    Args:
        exact: Tells the distances at some samples, which do not fall, of some parts.
        slack: (n,) of the samples [m].
        parts: How many.
        moved: Tells the most (n - 1, parts) that a distance changes to the next sample [m].
    """
    n = len(slack)
    if n <= _FEW:
        k, part = np.divmod(np.arange(n * parts), parts)
        all_of_them: Floats = exact(k, part).reshape(n, parts).min(axis=1)
        return all_of_them
    out = np.full((parts, n), -np.inf)
    known = np.zeros((parts, n), np.bool_)
    way = np.zeros((parts, n))
    np.cumsum(moved().T, axis=1, out=way[:, 1:])
    least = np.inf
    for step in _STEPS:
        matters = ~known[:, ::step] & (out - slack <= max(least, 0.0) + _MORE)[:, ::step]
        k, part = np.nonzero(matters.T)
        k *= step
        found = exact(k, part)
        out[part, k] = found
        known[part, k] = True
        least = min(least, np.min(found - slack[k], initial=np.inf))
        if step > 1:
            ahead = np.maximum.accumulate(np.where(known, out + way, -np.inf), axis=1) - way
            back = np.where(known, out - way, -np.inf)[:, ::-1]
            back = np.maximum.accumulate(back, axis=1)[:, ::-1] + way
            out = np.where(known, out, np.maximum(ahead, back))
    least_of_all: Floats = out.min(axis=0)
    return least_of_all
