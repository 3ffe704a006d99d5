"""Sequential quadratic programming for one pose: five unknowns, exact derivatives.

Unknown are y = (x, z, pitch, s_front, s_rear); joints follow in closed form, so that every iterate
has its wheels on the terrain. Hessians are exact, made positive by lifting eigenvalues; steps are
judged by cost plus penalty times the largest violation.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.terrain.wheel_path import curve_at

from .cells import Course
from .gaps import collect
from .qp import SOLVED, solve_qp
from .rows import Rows, Task, U, add_curvature, gradient, new_rows
from .state import WHEEL, Body, State, new_state, place

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TOLERANCE = 1e-9  # m and rad; the largest violation of a solution
_STEP = 1e-6  # m and rad; a smaller step ends the iteration
_LAST = 3e-5  # m and rad; after such a whole step the next one would be that small
_ROUNDS = 60
_PATIENCE = 8  # rounds in which a violation must fall by `_FALL`, or there is no solution near
_FALL = 0.8
_HALVINGS = 8
_MEMORY = 6  # rounds; a step must better the worst of so many (Grippo, Lampariello, Lucidi 1986)
_LEAST_CURVATURE = 1e-3
_LONGEST = (0.15, 0.15, 0.5, 0.05, 0.05)  # m, m, rad, m, m; of one step
_RELAXED = 1e4  # cost of what linearised constraints lack where they contradict each other


@nb.njit(cache=True)
def solve_pose(
    body: Body, course: Course, task: Task, start: Floats, x: Floats
) -> tuple[float, float, int]:
    """Minimise the cost of eq 17 under eqs 18-22 from one first guess.

    Args:
        body: The robot.
        course: The terrain.
        task: What is asked of the pose.
        start: (5,) x, z, pitch, s_front, s_rear; joints follow.
        x: (9,) filled with [x, z, pitch, q1..4, s_front, s_rear].

    Returns:
        Cost, largest violation [m or rad; inf where no pose reaches], iterations.
    """
    st, trial = new_state(body, task.links), new_state(body, task.links)
    rows, other = new_rows(), new_rows()
    y, step = start.copy(), np.zeros(5)
    for k in range(2):
        y[3 + k] = min(max(y[3 + k], task.lower[7 + k]), task.upper[7 + k])
    x[:] = np.nan
    if not (_within_reach(body, course, y, st) and math.isfinite(y.sum())):
        return np.inf, np.inf, 0
    free = np.array([0, 1, 2, 3, 4])[
        np.array([True, True, True, task.upper[7] > task.lower[7], task.upper[8] > task.lower[8]])
    ]
    count, least = collect(body, course, task, st, rows)
    value = cost(task, st)
    held = new_rows()  # the rows that held the last step back, and their multipliers
    force = np.zeros(len(free) + 1)
    holding, penalty, rounds = 0, 1.0, 0
    closest, since = np.inf, 0
    values, worsts = np.full(_MEMORY, -np.inf), np.zeros(_MEMORY)  # of the last rounds
    g, H, A = np.empty(5), np.empty((5, 5)), np.empty((len(rows.value), len(free)))
    while rounds < _ROUNDS:
        rounds += 1
        _model(task, st, held, force, holding, g, H)
        _gradients(st, rows, count, free, A)
        multipliers = np.zeros(count)
        relaxed = _direction(H, g, A[:count], rows.value[:count], free, step, multipliers)
        holding = _hold(rows, multipliers, held, force)
        size = np.abs(step).max()
        worst = max(0.0, -least)
        if size < _STEP and worst <= TOLERANCE:
            break
        since += 1
        if worst <= TOLERANCE or worst < _FALL * closest:
            closest, since = worst, 0
        if since > _PATIENCE or not math.isfinite(size):
            break
        penalty = max(penalty, 1.5 * multipliers.sum())
        shorten = 1.0
        for k in range(5):
            if abs(step[k]) > _LONGEST[k]:
                shorten = min(shorten, _LONGEST[k] / abs(step[k]))
        slope = (g * step).sum() - penalty * worst * (0.0 if relaxed else 1.0)
        values[rounds % _MEMORY], worsts[rounds % _MEMORY] = value, worst
        now, accepted = (values + penalty * worsts).max(), False
        for _ in range(_HALVINGS):
            if place(body, course, y + shorten * step, trial):
                number, slack = collect(body, course, task, trial, other)
                new = cost(task, trial)
                merit = new + penalty * max(0.0, -slack)
                if merit <= now + 1e-4 * shorten * min(slope, 0.0) + 1e-14:
                    accepted = True
                    break
            shorten *= 0.5
        if not accepted:
            break
        y += shorten * step
        st, trial, rows, other = trial, st, other, rows
        count, least, value = number, slack, new
        if size < _LAST and shorten == 1.0 and -least <= TOLERANCE:
            break
    x[:3], x[3:7], x[7:] = st.y[:3], st.q, st.y[3:]
    return value, max(0.0, -least), rounds


@leaf
def cost(task: Task, st: State) -> float:
    """Eq 17."""
    total = 0.0
    for k in range(7):
        error = (st.y[k] if k < 3 else st.q[k - 3]) - task.reference[k]
        total += task.weights[k] * error * error
    return total


@leaf
def _within_reach(body: Body, course: Course, y: Floats, st: State) -> bool:
    """Move the trunk of a first guess to where both legs reach their wheels; False if nowhere."""
    for _ in range(20):
        moved = False
        c, s = math.cos(y[2]), math.sin(y[2])
        place(body, course, y, st)
        for leg in range(2):
            limb = body.front if leg == 0 else body.rear
            hx = y[0] + c * limb.hip_x + s * limb.hip_z
            hz = y[1] - s * limb.hip_x + c * limb.hip_z
            wx, wz = _wheel(course, y[3 + leg])
            d = math.hypot(hx - wx, hz - wz)
            room = 0.02 * (limb.reach_max - limb.reach_min)
            want = min(max(d, limb.reach_min + room), limb.reach_max - room)
            if abs(d - want) > 1e-9:
                moved = True
                share = (want - d) / max(d, 1e-6)
                y[0] += share * (hx - wx)
                y[1] += share * (hz - wz)
        if not moved:
            break
    return place(body, course, y, st)


@nb.njit(cache=True)
def _model(
    task: Task, st: State, held: Rows, force: Floats, holding: int,
    g: Floats, H: Floats,
) -> None:  # fmt: skip
    """Gradient (5,) of the cost and Hessian (5, 5) of the Lagrangian by y."""
    gu, Hu = np.zeros(U), np.zeros((U, U))
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
    row = np.empty(U)
    for k in range(holding):
        gradient(st, held, k, row)
        gu -= force[k] * row
        add_curvature(st, held, k, -force[k], Hu)
    for leg in range(2):
        _closure(st, leg, gu, Hu)
    # H = Z' Hu Z, where Z (U, 5) holds the turns of the link angles and ones elsewhere.
    half, row = np.empty((U, 5)), np.empty(5)
    for i in range(U):
        _reduce(st, Hu[i], half[i])
    for j in range(5):
        _reduce(st, half[:, j], row)
        H[j] = row


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


@nb.njit(cache=True)
def _gradients(st: State, rows: Rows, count: int, free: Ints, A: Floats) -> None:
    gu, gy = np.empty(U), np.empty(5)
    for k in range(count):
        gradient(st, rows, k, gu)
        _reduce(st, gu, gy)
        for j in range(len(free)):
            A[k, j] = gy[free[j]]


@nb.njit(cache=True)
def _direction(
    H: Floats, g: Floats, A: Floats, value: Floats, free: Ints, step: Floats, multipliers: Floats
) -> bool:
    """Step (5,) of the quadratic model; True if the rows contradicted each other and gave way."""
    n = len(free)
    B, c, d = np.empty((n, n)), np.empty(n), np.empty(n)
    for i in range(n):
        c[i] = g[free[i]]
        for j in range(n):
            B[i, j] = H[free[i], free[j]]
    _lift(B)
    step[:] = 0.0
    relaxed = solve_qp(B, c, A, -value, d, multipliers) != SOLVED
    if relaxed:
        # One more unknown: how much all rows give way, dear and never negative.
        m = len(value)
        B1, c1, d1 = np.zeros((n + 1, n + 1)), np.empty(n + 1), np.empty(n + 1)
        A1, b1, force = np.zeros((m + 1, n + 1)), np.zeros(m + 1), np.empty(m + 1)
        B1[:n, :n], B1[n, n] = B, _RELAXED
        c1[:n], c1[n] = c, 1.0
        A1[:m, :n], A1[:, n] = A, 1.0
        b1[:m] = -value
        solve_qp(B1, c1, A1, b1, d1, force)
        d[:] = d1[:n]
        multipliers[:] = force[:m]
    for i in range(n):
        step[free[i]] = d[i]
    return relaxed


@nb.njit(cache=True)
def _lift(B: Floats) -> None:
    """Make B positive definite: negative eigenvalues change sign, and none stays near zero."""
    if _curved(B):
        return
    values, vectors = np.linalg.eigh(B)
    for k in range(len(values)):
        values[k] = max(abs(values[k]), _LEAST_CURVATURE)
    B[:] = (vectors * values) @ vectors.T


@nb.njit(cache=True)
def _curved(B: Floats) -> bool:
    """Whether all eigenvalues of B are above `_LEAST_CURVATURE`: its Cholesky factor exists."""
    n = len(B)
    L = np.empty((n, n))
    for i in range(n):
        for j in range(i + 1):
            total = B[i, j] - (_LEAST_CURVATURE if i == j else 0.0)
            for k in range(j):
                total -= L[i, k] * L[j, k]
            if i == j:
                if not total > 0.0:
                    return False
                L[i, i] = math.sqrt(total)
            else:
                L[i, j] = total / L[j, j]
    return True


@nb.njit(cache=True)
def _hold(rows: Rows, multipliers: Floats, held: Rows, force: Floats) -> int:
    """Copy the rows with a multiplier to `held` and `force`; returns their number."""
    count = 0
    for k in range(len(multipliers)):
        if multipliers[k] > 0.0 and count < len(force):
            held.what[count], held.numbers[count] = rows.what[k], rows.numbers[k]
            force[count] = multipliers[k]
            count += 1
    return count


@leaf
def _wheel(course: Course, s: float) -> tuple[float, float]:
    from_curve = curve_at(course.pieces, course.radius, s)
    return from_curve[0], from_curve[1]
