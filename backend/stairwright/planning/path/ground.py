"""The terrain as compiled code sees it, and exact distances of links and trunk from it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

_BUCKET = 0.02  # m
_PIERCED = 0.005  # m; depth of what a spike goes through that has no width to be deep in


class Ground(NamedTuple):
    """Corners of the profile [m] and, per bucket of x, the first segment that reaches into it."""

    x: Floats
    z: Floats
    first: Ints


def make_ground(vertices: Floats) -> Ground:
    """Index the profile `vertices` (n, 2)."""
    x = np.ascontiguousarray(vertices[:, 0])
    buckets = int((x[-1] - x[0]) / _BUCKET) + 2
    edges = x[0] + _BUCKET * np.arange(buckets)
    first = np.searchsorted(x, edges, side="left") - 1
    return Ground(x, np.ascontiguousarray(vertices[:, 1]), np.maximum(first, 0).astype(np.int32))


@leaf
def first_segment(g: Ground, x: float) -> int:
    """Index of a segment at or before the first that touches abscissas from `x` on."""
    k = int((x - g.x[0]) / _BUCKET)
    if x < g.x[0]:
        k = 0
    return int(g.first[min(max(k, 0), len(g.first) - 1)])


@nb.njit(cache=True)
def point_segment(px: float, pz: float, ax: float, az: float, bx: float, bz: float) -> float:
    """Squared distance from a point to the segment a-b."""
    dx, dz = bx - ax, bz - az
    square = dx * dx + dz * dz
    t = ((px - ax) * dx + (pz - az) * dz) / square if square > 1e-18 else 0.0
    t = min(1.0, max(0.0, t))
    ex, ez = px - ax - t * dx, pz - az - t * dz
    return ex * ex + ez * ez


@nb.njit(cache=True)
def segment_gap(
    ax: float, az: float, bx: float, bz: float, cx: float, cz: float, dx: float, dz: float
) -> float:
    """Distance of the segments a-b and c-d; 0 where they cross."""
    s1 = (bx - ax) * (cz - az) - (bz - az) * (cx - ax)
    s2 = (bx - ax) * (dz - az) - (bz - az) * (dx - ax)
    s3 = (dx - cx) * (az - cz) - (dz - cz) * (ax - cx)
    s4 = (dx - cx) * (bz - cz) - (dz - cz) * (bx - cx)
    if s1 * s2 < 0.0 and s3 * s4 < 0.0:
        return 0.0
    near = min(
        min(point_segment(ax, az, cx, cz, dx, dz), point_segment(bx, bz, cx, cz, dx, dz)),
        min(point_segment(cx, cz, ax, az, bx, bz), point_segment(dx, dz, ax, az, bx, bz)),
    )
    return math.sqrt(near)


@leaf
def height(g: Ground, x: float) -> float:
    """Upper height of the ground at `x`; -inf beyond the profile's ends."""
    best = -np.inf
    for i in range(first_segment(g, x), len(g.x) - 1):
        if g.x[i] > x:
            break
        if x <= g.x[i + 1]:
            width = g.x[i + 1] - g.x[i]
            if width < 1e-12:
                best = max(best, max(g.z[i], g.z[i + 1]))
            else:
                best = max(best, g.z[i] + (g.z[i + 1] - g.z[i]) * (x - g.x[i]) / width)
    return best


@leaf
def point_gap(g: Ground, x: float, z: float, reach: float) -> float:
    """Distance of a point from the profile, at most `reach`."""
    best = reach * reach
    for i in range(first_segment(g, x - reach), len(g.x) - 1):
        if g.x[i] > x + reach:
            break
        best = min(best, point_segment(x, z, g.x[i], g.z[i], g.x[i + 1], g.z[i + 1]))
    return math.sqrt(best)


@leaf
def link_clearance(
    g: Ground, ax: float, az: float, bx: float, bz: float, radius: float, reach: float
) -> float:
    """Distance of the capsule a-b from the ground, at most `reach`; minus its depth if inside [m].

    The depth counts from the capsule's axis: the deepest of five points on it, so that it shrinks
    as the link backs out.
    """
    best = reach + radius
    lo, hi = min(ax, bx) - best, max(ax, bx) + best
    bottom = min(az, bz)
    inside = False
    for i in range(first_segment(g, lo), len(g.x) - 1):
        x0, x1 = g.x[i], g.x[i + 1]
        if x0 > hi:
            break
        z0, z1 = g.z[i], g.z[i + 1]
        if x1 < lo or max(z0, z1) < bottom - best:
            continue
        best = min(best, segment_gap(ax, az, bx, bz, x0, z0, x1, z1))
        if x0 <= ax <= x1 and x1 > x0 and az < z0 + (z1 - z0) * (ax - x0) / (x1 - x0):
            inside = True
    if best > 0.0 and not inside:
        return best - radius
    depth = 0.0
    for k in range(5):
        x, z = ax + 0.25 * k * (bx - ax), az + 0.25 * k * (bz - az)
        if z < height(g, x):
            depth = max(depth, point_gap(g, x, z, 0.5), 1e-4)
    return -radius - (depth if depth > 2e-4 else _PIERCED)


@leaf
def box_clearance(
    g: Ground, cx: float, cz: float, c: float, s: float, hl: float, hh: float, reach: float
) -> float:
    """Distance of the trunk box from the ground, at most `reach`; minus its depth if inside [m].

    Args:
        g: Ground.
        cx, cz: Centre of the box.
        c, s: Cosine and sine of the pitch (about +y).
        hl, hh: Half length and half height.
        reach: Nothing farther is looked for.
    """
    best, depth = reach, 0.0
    wide, tall = abs(c) * hl + abs(s) * hh, abs(s) * hl + abs(c) * hh
    bottom = cz - tall
    lo, hi = cx - wide - reach, cx + wide + reach
    below = False
    for i in range(first_segment(g, lo), len(g.x) - 1):
        x0, x1 = g.x[i], g.x[i + 1]
        if x0 > hi:
            break
        z0, z1 = g.z[i], g.z[i + 1]
        if x1 < lo or max(z0, z1) < bottom - best:
            continue
        if x0 <= cx <= x1 and x1 > x0 and cz < z0 + (z1 - z0) * (cx - x0) / (x1 - x0):
            below = True
        # In the trunk's frame: u forward, v up.
        u0, v0 = c * (x0 - cx) - s * (z0 - cz), s * (x0 - cx) + c * (z0 - cz)
        u1, v1 = c * (x1 - cx) - s * (z1 - cz), s * (x1 - cx) + c * (z1 - cz)
        in0, in1 = min(hl - abs(u0), hh - abs(v0)), min(hl - abs(u1), hh - abs(v1))
        if in0 >= 0.0 or in1 >= 0.0:
            depth = max(depth, max(in0, in1))
            best = 0.0
            continue
        e0 = math.hypot(max(0.0, abs(u0) - hl), max(0.0, abs(v0) - hh))
        e1 = math.hypot(max(0.0, abs(u1) - hl), max(0.0, abs(v1) - hh))
        near = min(e0, e1)
        length = math.hypot(u1 - u0, v1 - v0)
        if near - length < best:
            for k in range(4):
                pu = hl if k < 2 else -hl
                pv = hh if k % 2 == 0 else -hh
                near = min(near, math.sqrt(point_segment(pu, pv, u0, v0, u1, v1)))
            # A diagonal of the box crossed without a corner inside: the segment cuts through.
            if (
                segment_gap(-hl, -hh, hl, hh, u0, v0, u1, v1) == 0.0
                or segment_gap(-hl, hh, hl, -hh, u0, v0, u1, v1) == 0.0
            ):
                near = 0.0
            best = min(best, near)
    if best > 0.0 and not below:
        return best
    for k in range(4):
        pu = hl if k < 2 else -hl
        pv = hh if k % 2 == 0 else -hh
        x, z = cx + c * pu + s * pv, cz - s * pu + c * pv
        if z < height(g, x):
            depth = max(depth, point_gap(g, x, z, 0.5), 1e-4)
    return -(depth if depth > 0.0 else 4.0 * _PIERCED)
