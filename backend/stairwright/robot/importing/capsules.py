"""Capsules in the side view: the least one round a convex shape."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats

from .outline import hull

_POINT = 5e-4  # m; half the length of a capsule that is a disc (the simulator wants some)
_WIDER = np.array([1.0, 1.03, 1.06, 1.1, 1.15, 1.2, 1.3, 1.45, 1.7, 2.0, 2.5])
_ALIKE = 2e-3  # m between two capsules that are taken as one


@dataclass(frozen=True)
class Disc2:
    """A capsule: all points within `radius` of the line from `start` to `end` [m]."""

    start: Floats
    end: Floats
    radius: float

    @property
    def area(self) -> float:
        """[m^2]"""
        return self.radius * (math.pi * self.radius + 2 * math.dist(self.start, self.end))


def around(points: Floats) -> Disc2:
    """The smallest capsule found round all of `points` (n, 2).

    Tried are the directions of the hull's edges. Along one, a radius r of at least half the width
    lets the middle line start where the last of the points' circles of radius r lets it.
    """
    corners = hull(points)
    if len(corners) < 3:
        ends = corners[[0, -1]]
        return _round_line(ends[0], ends[1], _POINT)
    edges = np.roll(corners, -1, axis=0) - corners
    found = [_along(edge / np.linalg.norm(edge), corners) for edge in edges]
    return min(found, key=lambda capsule: capsule.area)


def _along(along: Floats, corners: Floats) -> Disc2:
    """The smallest capsule round all corners whose line has a direction."""
    across = np.array([-along[1], along[0]])
    u, v = corners @ along, corners @ across
    middle, half = (v.min() + v.max()) / 2, (v.max() - v.min()) / 2
    radii = max(half, _POINT) * _WIDER
    room = np.sqrt(np.maximum(0.0, radii[:, None] ** 2 - (v - middle) ** 2))
    low, high = (u + room).min(axis=1), (u - room).max(axis=1)
    low, high = np.where(low > high, (low + high) / 2, [low, high])
    areas = radii * (math.pi * radii + 2 * np.maximum(high - low, 2 * _POINT))
    k = int(areas.argmin())
    start, end = (middle * across + end[k] * along for end in (low, high))
    return _round_line(start, end, float(radii[k]))


def _round_line(start: Floats, end: Floats, radius: float) -> Disc2:
    """A capsule whose line is never too short for the simulator."""
    if math.dist(start, end) >= 2 * _POINT:
        return Disc2(start, end, radius)
    middle = (start + end) / 2
    off = np.array([0.0, _POINT])
    return Disc2(middle + off, middle - off, radius)


def within_disc(capsule: Disc2, centre: Floats, radius: float) -> bool:
    """Whether a disc holds all of a capsule."""
    far = max(math.dist(capsule.start, centre), math.dist(capsule.end, centre))
    return far + capsule.radius <= radius + 1e-9


def merged(groups: list[list[Disc2]]) -> list[Disc2]:
    """The capsules of legs that are taken as one: those nearly alike become one round both."""
    found: list[Disc2] = []
    for capsule in (each for group in groups for each in group):
        for k, other in enumerate(found):
            off = _apart(capsule, other)
            if off <= _ALIKE:
                radius = max(other.radius, capsule.radius + off)
                found[k] = (
                    other if radius - other.radius < 1e-9 else Disc2(other.start, other.end, radius)
                )
                break
        else:
            found.append(capsule)
    return found


def _apart(a: Disc2, b: Disc2) -> float:
    """How far the ends of two capsules lie apart, and the difference of their radii at most."""
    ends = min(
        max(math.dist(a.start, b.start), math.dist(a.end, b.end)),
        max(math.dist(a.start, b.end), math.dist(a.end, b.start)),
    )
    return max(ends, abs(a.radius - b.radius))


def limited(capsules: list[Disc2], most: int) -> list[Disc2]:
    """At most so many: the smallest beyond that become one round them all."""
    if len(capsules) <= most:
        return capsules
    order = sorted(capsules, key=lambda each: -each.area)
    angle = np.arange(24) * 2 * math.pi / 24
    ring = np.column_stack([np.cos(angle), np.sin(angle)]) / math.cos(math.pi / 24)
    cloud = [
        end + each.radius * ring for each in order[most - 1 :] for end in (each.start, each.end)
    ]
    return [*order[: most - 1], around(np.concatenate(cloud))]
