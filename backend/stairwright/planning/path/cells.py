"""Cells of the search: pairs of wheel samples, each with a window of body poses.

A window's volume is stored flat with a rim of two lattice steps on every side, rows `row` long:
shifting by any few steps, dilating and comparing whole volumes are then single loops over bytes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.statics.contact import CAP

from .contacts import TOUCH, lagged_interval, make_scratch, pair_interval, steady_interval
from .tables import Lattice

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Flags = NDArray[np.bool_]

# Wheel moves (front, rear); the first three roll forward.
MOVES = np.array(
    [[1, 1], [1, 0], [0, 1], [1, -1], [-1, 1], [-1, 0], [0, -1], [-1, -1]], dtype=np.int32
)
FORWARD = 3


class Cells(NamedTuple):
    """Pairs of wheel samples in lexicographic order.

    Attributes:
        front, rear: (n,) sample indices.
        number: (samples, samples) cell number, -1 where there is none.
        spans: (n, 6) CoM intervals at friction, at the reserve, with lag [m].
        t0, z0, x0: (n,) lattice index of the window's corner.
        slope: (n,) angle of the line from the rear to the front wheel, upward positive [rad].
        origin: (n, moves) cell that a move into a cell comes from, -1 where there is none.
    """

    front: Ints
    rear: Ints
    number: Ints
    spans: Floats
    t0: Ints
    z0: Ints
    x0: Ints
    slope: Floats
    origin: Ints


@nb.njit(cache=True, nogil=True)
def wheel_pairs(
    centres: Floats, near: float, far: float, front: int, rear: int
) -> tuple[Ints, Ints]:
    """Samples of front and rear wheels `near`..`far` apart, in lexicographic order.

    The front wheel is at sample `front` or ahead of it, the rear wheel not ahead of `rear`: wheels
    that roll forward from one stand to another are nowhere else.
    """
    n = len(centres)
    fronts, rears = np.empty(n * n, np.int32), np.empty(n * n, np.int32)
    k = 0
    for i in range(front, n):
        first = i
        while first > 0 and centres[i, 0] - centres[first - 1, 0] <= far:
            first -= 1
        for j in range(first, min(i, rear + 1)):
            gap = math.hypot(centres[i, 0] - centres[j, 0], centres[i, 1] - centres[j, 1])
            if near <= gap <= far:
                fronts[k], rears[k] = i, j
                k += 1
    return fronts[:k].copy(), rears[:k].copy()


@nb.njit(cache=True, nogil=True)
def build_cells(
    pieces: Floats,
    corners: Floats,
    r: float,
    s: Floats,
    centres: Floats,
    pairs: tuple[Ints, Ints],
    lat: Lattice,
    friction: float,
    reserve: float,
    com: float,
) -> Cells:
    """Those `pairs` of samples (see `wheel_pairs`) that can stand at all.

    CoM intervals with lag are left to `lag_spans`; those at the `reserve` friction are empty if
    that is 0.
    """
    n, k = len(s), len(pairs[0])
    index = np.full((n, n), -1, np.int32)
    front, rear = np.empty(k, np.int32), np.empty(k, np.int32)
    spans = np.empty((k, 6))
    t0, z0, x0 = np.empty(k, np.int32), np.empty(k, np.int32), np.empty(k, np.int32)
    slope, scratch = np.empty(k), make_scratch()
    m = 0
    for c in range(k):
        i, j = pairs[0][c], pairs[1][c]
        lo, hi = pair_interval(pieces, corners, r, s[i], s[j], friction, CAP, scratch)
        if hi - lo < 2 * com:
            continue
        front[m], rear[m], index[i, j] = i, j, m
        spans[m, 0], spans[m, 1] = lo, hi
        spans[m, 2], spans[m, 3] = 1.0, -1.0
        if reserve > 0.0:
            spans[m, 2], spans[m, 3] = steady_interval(
                pieces, corners, r, s[i], s[j], reserve, scratch
            )
        slope[m] = _slope(centres, i, j)
        t0[m] = _first_pitch(slope[m], lat)
        x0[m] = int(round(0.5 * (centres[i, 0] + centres[j, 0]) / lat.step)) - lat.nx // 2
        z0[m] = int(round(0.5 * (centres[i, 1] + centres[j, 1]) / lat.step)) + lat.low
        m += 1
    origin = _origins(s, corners, front[:m], rear[:m], index)
    return Cells(
        front[:m].copy(), rear[:m].copy(), index, spans[:m].copy(),
        t0[:m].copy(), z0[:m].copy(), x0[:m].copy(), slope[:m].copy(), origin,
    )  # fmt: skip


@leaf
def _slope(centres: Floats, front: int, rear: int) -> float:
    x, z = centres[front, 0] - centres[rear, 0], centres[front, 1] - centres[rear, 1]
    return math.atan2(z, x)


@leaf
def _first_pitch(slope: float, lat: Lattice) -> int:
    """Index of the first pitch in the window of a cell of this `slope`."""
    middle = int(round(-0.8 * slope / lat.turn)) + lat.pitches // 2
    return min(lat.pitches - lat.nt, max(0, middle - lat.nt // 2))


@nb.njit(cache=True, nogil=True)
def pitch_ranges(centres: Floats, pairs: tuple[Ints, Ints], lat: Lattice) -> Ints:
    """Pitches (2, n, 2) that any cell of a sample looks at: the first and the one after the last.

    First with the sample's wheel in front, then with it behind, by all `pairs` of them.
    """
    out = np.zeros((2, len(centres), 2), np.int32)
    out[:, :, 0] = lat.pitches
    for c in range(len(pairs[0])):
        first = _first_pitch(_slope(centres, pairs[0][c], pairs[1][c]), lat)
        for wheel in range(2):
            k = pairs[wheel][c]
            out[wheel, k, 0] = min(out[wheel, k, 0], first)
            out[wheel, k, 1] = max(out[wheel, k, 1], first + lat.nt)
    return out


@nb.njit(cache=True, nogil=True)
def lag_spans(
    cells: Cells,
    wanted: Flags,
    pieces: Floats,
    corners: Floats,
    r: float,
    s: Floats,
    friction: float,
    lag: float,
) -> None:
    """Fill the CoM intervals with lag of the `wanted` (n,) cells: they take the longest of all."""
    scratch = make_scratch()
    for c in np.flatnonzero(wanted):
        i, j, spans = cells.front[c], cells.rear[c], cells.spans[c]
        lo, hi = lagged_interval(pieces, corners, r, s[i], s[j], friction, lag, scratch)
        if lo > hi:
            lo = hi = 0.5 * (spans[0] + spans[1])
        spans[4], spans[5] = lo, hi


@nb.njit(cache=True, nogil=True)
def _origins(s: Floats, corners: Floats, front: Ints, rear: Ints, number: Ints) -> Ints:
    """`Cells.origin`.

    A wheel comes to touch a second face, or leaves it, while the other stands: what carries the
    robot then changes at a place that the search has judged, not somewhere on a diagonal.
    """
    n = len(s)
    touch = np.full(n, -1, np.int32)
    for i in range(n):
        k = int(np.searchsorted(corners, s[i]))
        if k < len(corners) and corners[k] - s[i] <= TOUCH:
            touch[i] = k
        elif k > 0 and s[i] - corners[k - 1] <= TOUCH:
            touch[i] = k - 1
    out = np.full((len(front), len(MOVES)), -1, np.int32)
    for c in range(len(front)):
        f, r = front[c], rear[c]
        for m in range(len(MOVES)):
            i, j = f - MOVES[m, 0], r - MOVES[m, 1]
            if i < 0 or j < 0 or i >= n or j >= n:
                continue
            if i == f or j == r or (touch[i] == touch[f] and touch[j] == touch[r]):
                out[c, m] = number[i, j]
    return out
