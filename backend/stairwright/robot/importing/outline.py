"""Convex polygons in the side view: hulls, and hulls of few corners that lie outside them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stairwright.arrays import Floats

MOST_CORNERS = 16
_NEAR = 1e-9  # m
_LEAST = 1e-3  # m; what is flat in the side view gets this thickness


def hull(points: Floats) -> Floats:
    """(n, 2) convex hull of points, counter-clockwise, without corners that lie on an edge."""
    order = sorted({(round(float(x), 10), round(float(z), 10)) for x, z in points})
    if len(order) < 3:
        return np.array(order)

    def half(sequence: list[tuple[float, float]]) -> list[tuple[float, float]]:
        chain: list[tuple[float, float]] = []
        for point in sequence:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], point) <= _NEAR * 1e-3:
                chain.pop()
            chain.append(point)
        return chain

    lower, upper = half(order), half(order[::-1])
    return np.array(lower[:-1] + upper[:-1])


def outer(points: Floats, corners: int = MOST_CORNERS) -> Floats:
    """(n, 2) a convex polygon of at most `corners` round the hull of `points`.

    Edges go one by one: the one whose neighbours, made longer, meet with the least area added.
    """
    polygon = _thick(hull(points))
    while len(polygon) > corners:
        meeting, added = _meetings(polygon)
        k = int(added.argmin())
        if np.isinf(added[k]):
            low, high = polygon.min(axis=0), polygon.max(axis=0)
            return np.array([low, (high[0], low[1]), high, (low[0], high[1])])
        first, second = (k + 1) % len(polygon), (k + 2) % len(polygon)
        polygon[first] = meeting[k]
        polygon = np.delete(polygon, second, axis=0)
    return hull(polygon) if len(polygon) > 3 else polygon


def area(polygon: Floats) -> float:
    """Of a polygon, counter-clockwise positive [m^2]."""
    x, z = polygon[:, 0], polygon[:, 1]
    return float(x @ np.roll(z, -1) - z @ np.roll(x, -1)) / 2


def covers(polygon: Floats, points: Floats) -> bool:
    """Whether all of `points` lie in a counter-clockwise convex polygon, give or take rounding."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    normal = np.column_stack([edge[:, 1], -edge[:, 0]]) / np.linalg.norm(edge, axis=1)[:, None]
    beyond = points @ normal.T - (polygon * normal).sum(axis=1)
    return bool(beyond.max() <= 1e-6)


def _thick(polygon: Floats) -> Floats:
    """A polygon with an area, where the shape had none."""
    if len(polygon) >= 3 and area(polygon) > 1e-8:
        return polygon
    h = _LEAST / 2
    corners = np.array([(-h, -h), (h, -h), (h, h), (-h, h)])
    return hull((polygon[:, None, :] + corners[None, :, :]).reshape(-1, 2))


def _meetings(polygon: Floats) -> tuple[Floats, Floats]:
    """Of each edge's neighbours, made longer: where they meet, and the area that adds [m^2].

    That of edge k + 1 to k + 2 stands at k; the area is infinite where they do not meet.
    """
    b, c, d = (np.roll(polygon, -k, axis=0) for k in (1, 2, 3))
    u, v, w = b - polygon, c - d, c - b
    with np.errstate(divide="ignore", invalid="ignore"):
        across = _cross(u, v)
        t, s = _cross(w, v) / across, _cross(w, u) / across
        meeting: Floats = b + t[:, None] * u
        added = np.abs(_cross(meeting - b, w)) / 2
    return meeting, np.where((np.abs(across) >= 1e-15) & (t > 0) & (s > 0), added, np.inf)


def _cross(a: Floats, b: Floats) -> Floats:
    """(n,) of vectors (n, 2)."""
    out: Floats = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return out


def _turn(a: Sequence[float], b: Sequence[float], c: Sequence[float]) -> float:
    """Twice the area of a triangle, counter-clockwise positive."""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
