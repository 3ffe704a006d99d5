"""Small dense quadratic programmes: the dual active-set method of Goldfarb and Idnani (1983)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SOLVED, INFEASIBLE, STALLED = 0, 1, 2
_FEASIBLE = 1e-11  # violation that is none, relative to a row's size
_ROUNDS = 200


class Room(NamedTuple):
    """What a programme of n unknowns takes: factors (n, n), active rows (n,), directions (n,)."""

    L: Floats
    J: Floats
    R: Floats
    active: Ints
    u: Floats  # (n + 1,) their multipliers
    d: Floats
    z: Floats
    r: Floats


@nb.njit(cache=True)
def make_room(n: int) -> Room:
    """Room for programmes of `n` unknowns, one after the other."""
    return Room(
        np.empty((n, n)), np.empty((n, n)), np.empty((n, n)), np.empty(n, np.int64),
        np.empty(n + 1), np.empty(n), np.empty(n), np.empty(n),
    )  # fmt: skip


@nb.njit(cache=True)
def solve_qp(H: Floats, g: Floats, A: Floats, b: Floats, x: Floats, multipliers: Floats) -> int:
    """Minimise x'Hx/2 + g'x subject to A x >= b.

    Args:
        H: (n, n) positive definite.
        g: (n,) linear cost.
        A: (m, n) rows.
        b: (m,) least values.
        x: (n,) filled with the minimiser.
        multipliers: (m,) filled with the multipliers, >= 0.

    Returns:
        `SOLVED`, `INFEASIBLE` (no x satisfies all rows) or `STALLED` (rounding errors).
    """
    return solve_qp_within(H, g, A, b, x, multipliers, make_room(len(g)))


@leaf
def solve_qp_within(
    H: Floats, g: Floats, A: Floats, b: Floats, x: Floats, multipliers: Floats, room: Room
) -> int:
    """As `solve_qp`, for who asks often: `room`, made for just as many unknowns, is overwritten."""
    n, m = len(g), len(b)
    L, J, R, active, u, d, z, r = room
    for i in range(m):
        multipliers[i] = 0.0
    if not _inverse_factor(H, L, J):
        return STALLED
    for i in range(n):
        x[i] = 0.0
    for k in range(n):
        along = 0.0
        for i in range(n):
            along += J[i, k] * g[i]
        for i in range(n):
            x[i] -= J[i, k] * along
    count = 0
    for _ in range(_ROUNDS):
        worst, p = 0.0, -1
        for i in range(m):
            slack = -b[i]
            for k in range(n):
                slack += A[i, k] * x[k]
            if slack >= worst:
                continue
            size = abs(b[i]) + 1e-3
            for k in range(n):
                size += abs(A[i, k] * x[k])
            if slack < -_FEASIBLE * size:
                worst, p = slack, i
        if p < 0:
            for j in range(count):
                multipliers[active[j]] = u[j]
            return SOLVED
        u[count] = 0.0
        while True:
            _directions(J, R, A[p], count, d, z, r)
            t1, drop = np.inf, -1
            for j in range(count):
                if r[j] > 0.0 and u[j] / r[j] < t1:
                    t1, drop = u[j] / r[j], j
            gain = 0.0
            for k in range(n):
                gain += z[k] * A[p, k]
            slack = -b[p]
            for k in range(n):
                slack += A[p, k] * x[k]
            size = 0.0
            for k in range(n):
                size += d[k] * d[k]
            t2 = -slack / gain if gain > 1e-13 * size and count < n else np.inf
            t = min(t1, t2)
            if t == np.inf:
                return INFEASIBLE
            for j in range(count):
                u[j] -= t * r[j]
            u[count] += t
            if t2 < np.inf:
                for k in range(n):
                    x[k] += t * z[k]
            if t2 <= t1:
                _add(J, R, d, count)
                active[count] = p
                count += 1
                break
            _drop(J, R, count, drop)
            for j in range(drop, count - 1):
                active[j] = active[j + 1]
                u[j] = u[j + 1]
            u[count - 1] = u[count]
            count -= 1
    return STALLED


@leaf
def factor(H: Floats, least: float, L: Floats) -> bool:
    """Fill the lower triangle of L with the Cholesky factor of H less `least` on the diagonal.

    False if there is none: not all eigenvalues of H are above `least`.
    """
    for i in range(len(H)):
        for j in range(i + 1):
            total = H[i, j] - (least if i == j else 0.0)
            for k in range(j):
                total -= L[i, k] * L[j, k]
            if i == j:
                if not total > 0.0:
                    return False
                L[i, i] = math.sqrt(total)
            else:
                L[i, j] = total / L[j, j]
    return True


@leaf
def _inverse_factor(H: Floats, L: Floats, J: Floats) -> bool:
    """J (n, n) with J J' = H^-1: the inverse of H's Cholesky factor L, transposed.

    False if H has none.
    """
    if not factor(H, 0.0, L):
        return False
    n = len(H)
    for c in range(n):  # column c of L^-1 is row c of J
        for i in range(c):
            J[c, i] = 0.0
        for i in range(c, n):
            total = 1.0 if i == c else 0.0
            for k in range(c, i):
                total -= L[i, k] * J[c, k]
            J[c, i] = total / L[i, i]
    return True


@leaf
def _directions(
    J: Floats, R: Floats, row: Floats, count: int, d: Floats, z: Floats, r: Floats
) -> None:
    """Step `z` in x and `-r` in the multipliers as the constraint `row` is pushed."""
    n = len(row)
    for k in range(n):
        d[k] = 0.0
        for i in range(n):
            d[k] += J[i, k] * row[i]
    for i in range(n):
        z[i] = 0.0
        for k in range(count, n):
            z[i] += J[i, k] * d[k]
    for j in range(count - 1, -1, -1):
        total = d[j]
        for k in range(j + 1, count):
            total -= R[j, k] * r[k]
        r[j] = total / R[j, j]


@leaf
def _add(J: Floats, R: Floats, d: Floats, count: int) -> None:
    """Take a constraint into the factorisation; `d` is J' times its row."""
    n = len(d)
    for i in range(n - 1, count, -1):
        h = math.hypot(d[i - 1], d[i])
        if h == 0.0:
            continue
        c, s = d[i - 1] / h, d[i] / h
        d[i - 1], d[i] = h, 0.0
        for k in range(n):
            a, b = J[k, i - 1], J[k, i]
            J[k, i - 1], J[k, i] = c * a + s * b, c * b - s * a
    for i in range(count + 1):
        R[i, count] = d[i]


@leaf
def _drop(J: Floats, R: Floats, count: int, which: int) -> None:
    """Take constraint number `which` of the active ones out of the factorisation."""
    n = len(J)
    for j in range(which, count - 1):
        for i in range(j + 2):
            R[i, j] = R[i, j + 1]
    for j in range(which, count - 1):
        h = math.hypot(R[j, j], R[j + 1, j])
        if h == 0.0:
            continue
        c, s = R[j, j] / h, R[j + 1, j] / h
        for k in range(j, count - 1):
            a, b = R[j, k], R[j + 1, k]
            R[j, k], R[j + 1, k] = c * a + s * b, c * b - s * a
        for k in range(n):
            a, b = J[k, j], J[k, j + 1]
            J[k, j], J[k, j + 1] = c * a + s * b, c * b - s * a
