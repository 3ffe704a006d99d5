"""One round of the iteration: the quadratic model of the problem, and the step that it asks for."""

from __future__ import annotations

from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

from .qp import SOLVED, Room, factor, make_room, solve_qp, solve_qp_within
from .rows import MOST, Rows, Task, U, add_curvature, gradient
from .state import WHEEL, State

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_LEAST_CURVATURE = 1e-3
_RELAXED = 1e4  # cost of what linearised constraints lack where they contradict each other


class Scratch(NamedTuple):
    """What every round takes, made once; n unknowns are free, at most m rows are near.

    Attributes:
        gu, Hu: (U,), (U, U) gradient and Hessian by u.
        row, across: (U,) of one constraint.
        half: (U, 5) the Hessian by u and y.
        gy: (5,) gradient of one constraint by y.
        B, c, d: (n, n), (n,), (n,) Hessian, gradient and step of the free unknowns.
        b: (m,) right-hand sides.
        room: Of the quadratic programme.
    """

    gu: Floats
    Hu: Floats
    row: Floats
    across: Floats
    half: Floats
    gy: Floats
    B: Floats
    c: Floats
    d: Floats
    b: Floats
    room: Room


@nb.njit(cache=True)
def make_scratch(n: int) -> Scratch:
    """Scratch for `n` free unknowns."""
    return Scratch(
        np.empty(U), np.empty((U, U)), np.empty(U), np.empty(U), np.empty((U, 5)), np.empty(5),
        np.empty((n, n)), np.empty(n), np.empty(n), np.empty(MOST), make_room(n),
    )  # fmt: skip


@leaf
def lagrangian(
    task: Task, st: State, held: Rows, force: Floats, holding: int, g: Floats, H: Floats,
    scratch: Scratch,
) -> None:  # fmt: skip
    """Gradient (5,) of the cost and Hessian (5, 5) of the Lagrangian by y."""
    gu, Hu, row, half = scratch.gu, scratch.Hu, scratch.row, scratch.half
    for i in range(U):
        gu[i] = 0.0
        for j in range(U):
            Hu[i, j] = 0.0
    for k in range(7):
        w = 2.0 * task.weights[k]
        error = (st.y[k] if k < 3 else st.q[k - 3]) - task.reference[k]
        i = k
        gu[i] += w * error
        Hu[i, i] += w
        if k >= 3:
            # Joint = angle of its link minus angle of the link that it turns against.
            j = 2 if k == 3 or k == 5 else k - 1
            gu[j] -= w * error
            Hu[j, j] += w
            Hu[i, j] -= w
            Hu[j, i] -= w
    _reduce(st, gu, g)
    for k in range(holding):
        gradient(st, held, k, row)
        for i in range(U):
            gu[i] -= force[k] * row[i]
        add_curvature(st, held, k, -force[k], Hu, scratch.across)
    for leg in range(2):
        _closure(st, leg, gu, Hu)
    # H = Z' Hu Z, where Z (U, 5) holds the turns of the link angles and ones elsewhere.
    turns = st.turns
    for i in range(U):
        _reduce(st, Hu[i], half[i])
    for k in range(5):
        i = k if k < 3 else 4 + k
        for j in range(5):
            H[k, j] = half[i, j]
            for a in range(4):
                H[k, j] += turns[a, k] * half[3 + a, j]


@leaf
def _closure(st: State, leg: int, gu: Floats, Hu: Floats) -> None:
    """Curvature of "the wheel is on the curve" with the multiplier that its leg's angles imply."""
    wheel, upper = WHEEL + leg, 1 + 2 * leg
    ax, az = st.arms[wheel, upper, 1], -st.arms[wheel, upper, 0]
    bx, bz = st.arms[wheel, upper + 1, 1], -st.arms[wheel, upper + 1, 0]
    det = ax * bz - az * bx
    g1, g2 = gu[2 + upper], gu[3 + upper]
    mx, mz = (g1 * bz - g2 * az) / det, (ax * g2 - bx * g1) / det
    for a in (0, upper, upper + 1):
        Hu[2 + a, 2 + a] += mx * st.arms[wheel, a, 0] + mz * st.arms[wheel, a, 1]
    tx, tz, bent = st.curve[leg, 0], st.curve[leg, 1], st.curve[leg, 2]
    Hu[7 + leg, 7 + leg] -= bent * (mz * tx - mx * tz)


@leaf
def _reduce(st: State, gu: Floats, out: Floats) -> None:
    """Gradient by y (5,) from the gradient by u (U,)."""
    for k in range(5):
        out[k] = gu[k] if k < 3 else gu[4 + k]
        for a in range(4):
            out[k] += gu[3 + a] * st.turns[a, k]


@leaf
def gradients(st: State, rows: Rows, count: int, free: Ints, A: Floats, scratch: Scratch) -> None:
    """Fill A (count, n) with the rows' gradients by the free unknowns."""
    gu, gy = scratch.row, scratch.gy
    for k in range(count):
        gradient(st, rows, k, gu)
        _reduce(st, gu, gy)
        for j in range(len(free)):
            A[k, j] = gy[free[j]]


@nb.njit(cache=True)
def direction(
    H: Floats, g: Floats, A: Floats, value: Floats, free: Ints, step: Floats, multipliers: Floats,
    scratch: Scratch,
) -> bool:  # fmt: skip
    """Step (5,) of the quadratic model; True if the rows contradicted each other and gave way."""
    n, m = len(free), len(value)
    B, c, d, b = scratch.B, scratch.c, scratch.d, scratch.b[:m]
    for i in range(m):
        b[i] = -value[i]
    for i in range(n):
        c[i] = g[free[i]]
        for j in range(n):
            B[i, j] = H[free[i], free[j]]
    _lift(B, scratch.room.L)
    step[:] = 0.0
    relaxed = solve_qp_within(B, c, A, b, d, multipliers, scratch.room) != SOLVED
    if relaxed:
        # One more unknown: how much all rows give way, dear and never negative.
        B1, c1, d1 = np.zeros((n + 1, n + 1)), np.empty(n + 1), np.empty(n + 1)
        A1, b1, force = np.zeros((m + 1, n + 1)), np.zeros(m + 1), np.empty(m + 1)
        B1[:n, :n], B1[n, n] = B, _RELAXED
        c1[:n], c1[n] = c, 1.0
        A1[:m, :n], A1[:, n] = A, 1.0
        b1[:m] = b
        solve_qp(B1, c1, A1, b1, d1, force)
        d[:] = d1[:n]
        multipliers[:] = force[:m]
    for i in range(n):
        step[free[i]] = d[i]
    return relaxed


@nb.njit(cache=True)
def _lift(B: Floats, L: Floats) -> None:
    """Make B positive definite: negative eigenvalues change sign, and none stays near zero.

    L, of the same shape, is scratch.
    """
    if factor(B, _LEAST_CURVATURE, L):
        return
    values, vectors = np.linalg.eigh(B)
    for k in range(len(values)):
        values[k] = max(abs(values[k]), _LEAST_CURVATURE)
    B[:] = (vectors * values) @ vectors.T


@leaf
def hold(rows: Rows, multipliers: Floats, count: int, held: Rows, force: Floats) -> int:
    """Copy those of `count` rows that have a multiplier to `held` and `force`; how many."""
    kept = 0
    for k in range(count):
        if multipliers[k] > 0.0 and kept < len(force):
            for i in range(4):
                held.what[kept, i], held.numbers[kept, i] = rows.what[k, i], rows.numbers[k, i]
            force[kept] = multipliers[k]
            kept += 1
    return kept
