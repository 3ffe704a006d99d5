"""Which faces a wheel touches at an arc length, and the CoM intervals that follow from them."""

from __future__ import annotations

from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.statics.contact import CAP, RAYS, com_interval_within
from stairwright.statics.margin import com_margin
from stairwright.terrain.wheel_path import curve_at

Floats = NDArray[np.float64]

GENTLE = 0.75  # weights; ray strength that poses with reserve do with: no wheels that pinch
STRAY = 0.005  # m; how far a wheel may be from its place
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
    """What finding an interval takes.

    Attributes:
        faces, face_normals: (4, 2) where wheels touch the terrain.
        points, normals, grips: (4, 2), (4, 2), (4,) contacts that are counted, their friction.
        rays: Of their friction cones.
    """

    faces: Floats
    face_normals: Floats
    points: Floats
    normals: Floats
    grips: Floats
    rays: Floats


@nb.njit(cache=True)
def make_scratch() -> Scratch:
    """Made once for many intervals."""
    pairs = np.empty((4, 4, 2))
    return Scratch(pairs[0], pairs[1], pairs[2], pairs[3], np.empty(4), np.empty(RAYS))


@leaf
def pair_interval(
    pieces: Floats, corners: Floats, r: float, sf: float, sr: float, friction: float, cap: float,
    scratch: Scratch,
) -> tuple[float, float]:  # fmt: skip
    """CoM interval (low, high) with the front wheels at `sf` and the rear wheels at `sr` [m].

    A wheel between two faces pushes on either with friction, or on both without. Friction on both
    could hold more: a motor that drives the wheel against the face ahead lifts the robot's nose.
    But it takes all the grip of both at once, and robots whose plans counted on it tipped.
    """
    front = wheel_contacts(pieces, corners, r, sf, scratch.faces, scratch.face_normals, 0)
    rear = wheel_contacts(pieces, corners, r, sr, scratch.faces, scratch.face_normals, front)
    low, high = np.inf, -np.inf
    for i in range(1 if front == 1 else 3):
        n = _lean(0, front, i, friction, scratch, 0)
        for j in range(1 if rear == 1 else 3):
            count = _lean(front, front + rear, j, friction, scratch, n)
            lo, hi = com_interval_within(
                scratch.points, scratch.normals, count, scratch.grips, cap, scratch.rays
            )
            if lo <= hi:
                low, high = min(low, lo), max(high, hi)
    return low, high


@nb.njit(cache=True, nogil=True)
def firm_margins(
    pieces: Floats, corners: Floats, r: float, s: Floats, com_x: Floats, friction: float
) -> Floats:
    """CoM margins (n,) [m] within `pair_interval`, with the wheels at `s` (n, 2) [m].

    No more than the margins that plans state, which count friction on both faces of a corner.
    """
    scratch, out = make_scratch(), np.empty(len(s))
    for k in range(len(s)):
        low, high = pair_interval(pieces, corners, r, s[k, 0], s[k, 1], friction, CAP, scratch)
        out[k] = com_margin(low, high, com_x[k])
    return out


@leaf
def steady_interval(
    pieces: Floats, corners: Floats, r: float, sf: float, sr: float, friction: float,
    scratch: Scratch,
) -> tuple[float, float]:  # fmt: skip
    """CoM interval without pinching that also holds where a wheel on an edge strays by `STRAY`.

    Round an edge a few millimetres tilt the face by a tenth of a radian. Low > high where no CoM
    suits all cases.
    """
    low, high = pair_interval(pieces, corners, r, sf, sr, friction, GENTLE, scratch)
    for case in range(4):
        strayed = STRAY if case % 2 == 0 else -STRAY
        s = sf if case < 2 else sr
        if low > high or not _turns(pieces, corners, r, s, s + strayed):
            continue
        f, b = (s + strayed, sr) if case < 2 else (sf, s + strayed)
        lo, hi = pair_interval(pieces, corners, r, f, b, friction, GENTLE, scratch)
        low, high = max(low, lo), min(high, hi)
    return low, high


@leaf
def _turns(pieces: Floats, corners: Floats, r: float, s: float, other: float) -> bool:
    """Whether the face tilts from `s` to `other`, both between the same two corners."""
    if np.searchsorted(corners, min(s, other) - TOUCH) != np.searchsorted(
        corners, max(s, other) + TOUCH
    ):
        return False
    _, _, ax, az = curve_at(pieces, r, s)
    _, _, bx, bz = curve_at(pieces, r, other)
    return bool(ax * bx + az * bz < 1.0 - 1e-6)


@leaf
def _lean(begin: int, end: int, way: int, friction: float, scratch: Scratch, at: int) -> int:
    """Write the contacts of the wheel that touches the faces from `begin` on to row `at`.

    Its friction is on face `way`; 2 stands for both faces without any. Returns the row after the
    last.
    """
    for k in range(begin, end):
        if way == 2 or way == k - begin:
            scratch.points[at, 0], scratch.points[at, 1] = scratch.faces[k, 0], scratch.faces[k, 1]
            scratch.normals[at, 0] = scratch.face_normals[k, 0]
            scratch.normals[at, 1] = scratch.face_normals[k, 1]
            scratch.grips[at] = 0.0 if way == 2 else friction
            at += 1
    return at


@leaf
def lagged_interval(
    pieces: Floats, corners: Floats, r: float, sf: float, sr: float, friction: float, lag: float,
    scratch: Scratch,
) -> tuple[float, float]:  # fmt: skip
    """CoM interval that also holds if either wheel is `lag` behind its plan, or `STRAY` ahead.

    A wheel that arrives late at a corner pushes on the face behind it alone; plans that tolerate
    this are what a controller can follow. Low > high where no CoM suits all cases.
    """
    low, high = -np.inf, np.inf
    _, _, points, normals, grips, rays = scratch
    grips[:] = friction
    for a in range(4):
        n = _late(pieces, corners, r, sf, a, lag, points, normals, 0)
        for b in range(4):
            if max(a, b) == 3 and a + b > 3:
                continue  # ahead while the other is not in time: too much to ask
            count = _late(pieces, corners, r, sr, b, lag, points, normals, n)
            lo, hi = com_interval_within(points, normals, count, grips, GENTLE, rays)
            low, high = max(low, lo), min(high, hi)
            if low > high:
                return low, high
    return low, high


@leaf
def _late(
    pieces: Floats, corners: Floats, r: float, s: float, case: int, lag: float,
    points: Floats, normals: Floats, at: int,
) -> int:  # fmt: skip
    """Write the contacts of a wheel in time (case 0), late (1), a little late (2) or ahead (3).

    Returns the row after the last.
    """
    if case == 0:
        return at + wheel_contacts(pieces, corners, r, s, points, normals, at)
    # The straying wheel's normal at the planned centre: the direction decides.
    x, z, _, _ = curve_at(pieces, r, s)
    other = s - lag if case == 1 else s - 0.3 * lag
    if case == 3:
        other = s + STRAY
        k = int(np.searchsorted(corners, s))
        if k < len(corners) and corners[k] < other:
            other = s
    _, _, nx, nz = curve_at(pieces, r, other)
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

    Where one of the stricter two is empty the interval before it stands in; before that, less lag.
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
            lo, hi = lagged_interval(
                pieces, corners, r, s[k, 0], s[k, 1], friction, 0.3 * lag, scratch
            )
        if lo > hi:
            lo, hi = out[k, 2], out[k, 3]
        out[k, 4], out[k, 5] = lo, hi
