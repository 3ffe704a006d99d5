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
from .model import direction, gradients, hold, lagrangian, make_scratch
from .rows import Task, new_rows
from .state import Body, State, new_state, place

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
_LONGEST = (0.15, 0.15, 0.5, 0.05, 0.05)  # m, m, rad, m, m; of one step


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
    multipliers, scratch = np.empty(len(rows.value)), make_scratch(len(free))
    while rounds < _ROUNDS:
        rounds += 1
        lagrangian(task, st, held, force, holding, g, H, scratch)
        gradients(st, rows, count, free, A, scratch)
        relaxed = direction(
            H, g, A[:count], rows.value[:count], free, step, multipliers[:count], scratch
        )
        holding = hold(rows, multipliers, count, held, force)
        size = np.abs(step).max()
        worst = max(0.0, -least)
        if size < _STEP and worst <= TOLERANCE:
            break
        since += 1
        if worst <= TOLERANCE or worst < _FALL * closest:
            closest, since = worst, 0
        if since > _PATIENCE or not math.isfinite(size):
            break
        penalty = max(penalty, 1.5 * multipliers[:count].sum())
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


@leaf
def _wheel(course: Course, s: float) -> tuple[float, float]:
    from_curve = curve_at(course.pieces, course.radius, s)
    return from_curve[0], from_curve[1]
