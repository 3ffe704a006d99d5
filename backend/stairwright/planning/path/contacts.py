"""Which faces a wheel touches at an arc length, and the CoM intervals that follow from them."""

from __future__ import annotations

from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.statics.contact import CAP, RAYS, com_interval_within
from stairwright.terrain.wheel_path import curve_at

Floats = NDArray[np.float64]

GENTLE = 0.75  # weights; ray strength that poses with reserve do with: no wheels that pinch
TOUCH = 0.0018  # m; a wheel this near to a concave corner (by arc length) touches both faces


@leaf
def wheel_contacts(
    pieces: Floats, corners: Floats, r: float, s: float, points: Floats, normals: Floats, at: int
) -> int:
    """Write the contacts of a wheel at `s` from row `at` on; returns their number (1 or 2)."""
    x, z, nx, nz = curve_at(pieces, r, s)
    k = int(np.searchsorted(corners, s))
    near = -1
    if k < len(corners) and corners[k] - s <= TOUCH:
        near = k
    if k > 0 and s - corners[k - 1] <= TOUCH and (near < 0 or s - corners[k - 1] < corners[k] - s):
        near = k - 1
    if near < 0:
        points[at, 0], points[at, 1] = x - r * nx, z - r * nz
        normals[at, 0], normals[at, 1] = nx, nz
        return 1
    for m in range(2):
        side = -1e-7 if m == 0 else 1e-7
        cx, cz, cnx, cnz = curve_at(pieces, r, corners[near] + side)
        points[at + m, 0], points[at + m, 1] = cx - r * cnx, cz - r * cnz
        normals[at + m, 0], normals[at + m, 1] = cnx, cnz
    return 2


class Scratch(NamedTuple):
    """What finding an interval takes: contact points, their normals, rays of the friction cones."""

    points: Floats
    normals: Floats
    rays: Floats


@nb.njit(cache=True)
def make_scratch() -> Scratch:
    """Made once for many intervals."""
    return Scratch(np.empty((4, 2)), np.empty((4, 2)), np.empty(RAYS))


@leaf
def pair_interval(
    pieces: Floats, corners: Floats, r: float, sf: float, sr: float, friction: float, cap: float,
    scratch: Scratch,
) -> tuple[float, float]:  # fmt: skip
    """CoM interval (low, high) with the front wheels at `sf` and the rear wheels at `sr` [m]."""
    points, normals, rays = scratch
    n = wheel_contacts(pieces, corners, r, sf, points, normals, 0)
    n += wheel_contacts(pieces, corners, r, sr, points, normals, n)
    return com_interval_within(points, normals, n, friction, cap, rays)


@leaf
def lagged_interval(
    pieces: Floats, corners: Floats, r: float, sf: float, sr: float, friction: float, lag: float,
    scratch: Scratch,
) -> tuple[float, float]:  # fmt: skip
    """CoM interval that also holds if either wheel is still `lag` behind its plan.

    A wheel that arrives late at a corner pushes on the face behind it alone; plans that tolerate
    this are what a controller can follow. Low > high where no CoM suits all cases.
    """
    low, high = -np.inf, np.inf
    points, normals, rays = scratch
    for a in range(3):
        n = _late(pieces, corners, r, sf, a, lag, points, normals, 0)
        for b in range(3):
            count = _late(pieces, corners, r, sr, b, lag, points, normals, n)
            lo, hi = com_interval_within(points, normals, count, friction, GENTLE, rays)
            low, high = max(low, lo), min(high, hi)
            if low > high:
                return low, high
    return low, high


@leaf
def _late(
    pieces: Floats, corners: Floats, r: float, s: float, case: int, lag: float,
    points: Floats, normals: Floats, at: int,
) -> int:  # fmt: skip
    """Write the contacts of a wheel in time (case 0), late (1) or a little late (2).

    Returns the row after the last.
    """
    if case == 0:
        return at + wheel_contacts(pieces, corners, r, s, points, normals, at)
    # The lagging wheel's normal at the planned centre: the direction decides.
    x, z, _, _ = curve_at(pieces, r, s)
    _, _, nx, nz = curve_at(pieces, r, s - (lag if case == 1 else 0.3 * lag))
    points[at, 0], points[at, 1] = x - r * nx, z - r * nz
    normals[at, 0], normals[at, 1] = nx, nz
    return at + 1


@nb.njit(cache=True, nogil=True)
def path_intervals(
    pieces: Floats,
    corners: Floats,
    r: float,
    s: Floats,
    friction: float,
    reserve: float,
    lag: float,
    out: Floats,
) -> None:
    """Rows (6,): interval at `friction`, interval at `reserve`, interval with lag, per pair `s`.

    Where one of the stricter two is empty the interval before it stands in.
    """
    scratch = make_scratch()
    for k in range(len(s)):
        lo, hi = pair_interval(pieces, corners, r, s[k, 0], s[k, 1], friction, CAP, scratch)
        if lo > hi:
            xf, _, _, _ = curve_at(pieces, r, s[k, 0])
            xr, _, _, _ = curve_at(pieces, r, s[k, 1])
            lo, hi = 0.5 * (xf + xr) + 0.05, 0.5 * (xf + xr) - 0.05
        out[k, 0], out[k, 1] = lo, hi
        lo, hi = pair_interval(pieces, corners, r, s[k, 0], s[k, 1], reserve, GENTLE, scratch)
        if lo > hi:
            lo, hi = out[k, 0], out[k, 1]
        out[k, 2], out[k, 3] = lo, hi
        lo, hi = lagged_interval(pieces, corners, r, s[k, 0], s[k, 1], friction, lag, scratch)
        if lo > hi:
            lo, hi = out[k, 2], out[k, 3]
        out[k, 4], out[k, 5] = lo, hi
