"""Constraints of one pose as rows "value >= 0": value, gradient and curvature.

Derivatives are by u = (x, z, five absolute angles, s_front, s_rear); `state.State` says how points
depend on them. `gaps.collect` finds the rows.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

from .state import ANGLES, HIP, State

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

JOINT, PLACE, BEHIND, PLANE, ACROSS, APART, COM = 0, 1, 2, 3, 4, 5, 6
U = ANGLES + 4  # length of u
MOST = 1000  # rows kept; what lies beyond is still measured
LOOK = 0.15  # m; rows with more slack do not guide a step
CENTRE = -1  # in place of a point's index: the trunk's centre
FIXED = -1  # in place of a point's index: the fixed point in the row's numbers


class Task(NamedTuple):
    """What is asked of a pose. SI units.

    Attributes:
        reference, weights: (7,) of eq 17: x, z, pitch, joints.
        lower, upper: (9,) bounds of [x, z, pitch, q1..4, s_front, s_rear]; x, z, pitch are free.
        clearance: Least distance of trunk and links (or points) from the ground.
        apart: Least distance of the front leg from the rear one.
        hip: Least distance of the rear contact behind the rear hip (eq 20), or -inf.
        links: Keep whole links clear instead of the collision points (eq 21).
        com_low, com_high: Where the centre of mass must be along x; infinite where it is free.
    """

    reference: Floats
    weights: Floats
    lower: Floats
    upper: Floats
    clearance: float
    apart: float
    hip: float
    links: bool
    com_low: float
    com_high: float


class Rows(NamedTuple):
    """Rows of the constraints.

    Attributes:
        what: (m, 4) kind, point i, point j, index of angle or normal.
        numbers: (m, 4) normal or fixed point (x, z), sign, offset.
        value: (m,) slack, >= 0 where the constraint holds [m or rad].
    """

    what: Ints
    numbers: Floats
    value: Floats


@nb.njit(cache=True)
def new_rows() -> Rows:
    """Room for `MOST` rows."""
    return Rows(np.empty((MOST, 4), np.int64), np.empty((MOST, 4)), np.empty(MOST))


@leaf
def add_row(
    rows: Rows, count: int, kind: int, i: int, j: int, turn: int,
    nx: float, nz: float, sign: float, offset: float, value: float,
) -> int:  # fmt: skip
    """Append a row if it is near its bound; returns the number of rows."""
    if value > LOOK or count >= MOST:
        return count
    rows.what[count, 0], rows.what[count, 1] = kind, i
    rows.what[count, 2], rows.what[count, 3] = j, turn
    rows.numbers[count, 0], rows.numbers[count, 1] = nx, nz
    rows.numbers[count, 2], rows.numbers[count, 3] = sign, offset
    rows.value[count] = value
    return count + 1


@leaf
def gradient(st: State, rows: Rows, k: int, out: Floats) -> None:
    """Gradient (U,) of row `k` by u."""
    kind, i, j = rows.what[k, 0], rows.what[k, 1], rows.what[k, 2]
    nx, nz, sign = rows.numbers[k, 0], rows.numbers[k, 1], rows.numbers[k, 2]
    _clear(out)
    if kind == JOINT:
        out[2 + i], out[2 + j] = sign, -sign
    elif kind == PLACE:
        out[7 + i] = sign
    elif kind in (BEHIND, PLANE):
        _pull(st, i, nx, nz, out)
        if kind == BEHIND:
            out[8] -= st.contact[1]
    elif kind == COM:
        out[0] += sign * st.shares[0]
        for k in range(6):
            _pull(st, HIP + k, sign * st.shares[1 + k // 2], 0.0, out)
    elif kind == ACROSS:
        turn = rows.what[k, 3]
        ax, az = sign * st.normals[turn, 0], sign * st.normals[turn, 1]
        dx, dz = _between(st, rows, k)
        angle = 0 if turn < 2 else turn - 1
        if i != FIXED:
            _pull(st, i, ax, az, out)
        _pull(st, j, -ax, -az, out)
        out[2 + angle] += az * dx - ax * dz
    else:
        dx, dz = _between(st, rows, k)
        gap = max(math.hypot(dx, dz), 1e-9)
        _pull(st, i, dx / gap, dz / gap, out)
        _pull(st, j, -dx / gap, -dz / gap, out)


@leaf
def _pull(st: State, i: int, nx: float, nz: float, out: Floats) -> None:
    """Add the gradient of n . (point i)."""
    out[0] += nx
    out[1] += nz
    if i != CENTRE:
        for a in range(ANGLES):
            out[2 + a] += nx * st.arms[i, a, 1] - nz * st.arms[i, a, 0]


@leaf
def _between(st: State, rows: Rows, k: int) -> tuple[float, float]:
    """From point j of a row to its point i."""
    i, j = rows.what[k, 1], rows.what[k, 2]
    ax = st.y[0] if j == CENTRE else st.points[j, 0]
    az = st.y[1] if j == CENTRE else st.points[j, 1]
    if rows.what[k, 0] == ACROSS and i == FIXED:
        return rows.numbers[k, 0] - ax, rows.numbers[k, 1] - az
    return st.points[i, 0] - ax, st.points[i, 1] - az


@leaf
def _clear(out: Floats) -> None:
    for a in range(U):
        out[a] = 0.0


@leaf
def add_curvature(st: State, rows: Rows, k: int, factor: float, H: Floats, across: Floats) -> None:
    """Add `factor` times the second derivative of row `k` to H (U, U); `across` (U,) is scratch."""
    kind, i, j = rows.what[k, 0], rows.what[k, 1], rows.what[k, 2]
    nx, nz, sign = rows.numbers[k, 0], rows.numbers[k, 1], rows.numbers[k, 2]
    if kind in (BEHIND, PLANE):
        _bend(st, i, factor * nx, factor * nz, H)
    elif kind == COM:
        for k in range(6):
            _bend(st, HIP + k, factor * sign * st.shares[1 + k // 2], 0.0, H)
    elif kind == ACROSS:
        turn = rows.what[k, 3]
        ax = factor * sign * st.normals[turn, 0]
        az = factor * sign * st.normals[turn, 1]
        dx, dz = _between(st, rows, k)
        angle = 2 + (0 if turn < 2 else turn - 1)
        if i != FIXED:
            _bend(st, i, ax, az, H)
        _bend(st, j, -ax, -az, H)
        H[angle, angle] -= ax * dx + az * dz
        _clear(across)
        if i != FIXED:
            _pull(st, i, az, -ax, across)
        _pull(st, j, -az, ax, across)
        for a in range(U):
            H[angle, a] += across[a]
            H[a, angle] += across[a]
    elif kind == APART:
        dx, dz = _between(st, rows, k)
        gap = max(math.hypot(dx, dz), 1e-9)
        ux, uz = dx / gap, dz / gap
        _bend(st, i, factor * ux, factor * uz, H)
        _bend(st, j, -factor * ux, -factor * uz, H)
        _clear(across)  # |d|'' = (across the line)(across the line)' / |d|
        _pull(st, i, -uz, ux, across)
        _pull(st, j, uz, -ux, across)
        for a in range(U):
            for b in range(U):
                H[a, b] += factor * across[a] * across[b] / gap


@leaf
def _bend(st: State, i: int, nx: float, nz: float, H: Floats) -> None:
    """Add the second derivative of n . (point i)."""
    if i != CENTRE:
        for a in range(ANGLES):
            H[2 + a, 2 + a] -= nx * st.arms[i, a, 0] + nz * st.arms[i, a, 1]
