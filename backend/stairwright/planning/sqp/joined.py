"""Whether the robot keeps its balance between two poses, as both wheels roll on evenly."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

from .cells import Course
from .gaps import collect
from .nearest import BETWEEN, nearest
from .places import room
from .rows import Rows, Task, new_rows
from .search import TOLERANCE, Rules
from .state import Body, State, com, new_state, place

Floats = NDArray[np.float64]

_STEP = 0.01  # m between places looked at
_TRIES = 6  # places where the even motion tips that are solved for
_SPARE = 0.002  # m that the CoM keeps from where balance ends
_LIFTS = (0.0, -0.04, 0.04)  # m; a trunk that cannot be there as high as it is may be so
_MOVES = 5  # of the trunk, until the CoM is where it must be
_INSIDE = 5e-4  # m; so far inside it is aimed for, since legs take a part of each move back


@nb.njit(cache=True)
def imbalance(body: Body, course: Course, rules: Rules, begin: Floats, end: Floats) -> float:
    """How far the CoM of the even motion lies where no clear pose keeps balance [m]; 0 if nowhere.

    Where the even motion tips, a clear pose near it that does not is looked for: at the worst
    place, and at a few others.

    Args:
        body: The robot.
        course: The terrain.
        rules: Limits and clearances.
        begin: (9,) variables of the first pose.
        end: (9,) of the second one.
    """
    ways = end[7:] - begin[7:]
    n = max(1, math.ceil(max(ways[0], ways[1]) / _STEP))
    missing = np.zeros(n)
    st, y = new_state(body, True), np.empty(5)
    for i in range(1, n):
        _even(begin, end, i / n, y)
        low, high = room(course, y[3], y[4], rules.friction)
        if low > high:
            missing[i] = np.inf
        elif place(body, course, y, st):
            at = com(st, 0)
            missing[i] = max(0.0, low - at, at - high)
    tipping = np.flatnonzero(missing > 0.0)
    if len(tipping) == 0:
        return 0.0
    worst, start, x = 0.0, np.full(5, np.nan), np.empty(9)
    wanted, wheels, rows = np.empty(7), np.empty(2), new_rows()
    hardest = tipping[np.argmax(missing[tipping])]
    before = -1
    for k in range(_TRIES + 1):
        i = hardest if k == 0 else tipping[(len(tipping) - 1) * (k - 1) // (_TRIES - 1)]
        if k > 0 and (i in (hardest, before)):
            continue
        before, share = i, i / n
        for j in range(7):
            wanted[j] = begin[j] + share * (end[j] - begin[j])
        wheels[:] = begin[7:] + share * ways
        low, high = room(course, wheels[0], wheels[1], rules.friction)
        spare = min(_SPARE, 0.5 * (high - low))
        if low <= high:
            way = (low + spare, high - spare)
            _even(begin, end, share, y)
            if _moved(body, course, rules, way, y, st, rows):
                continue
            _, violation = nearest(body, course, rules, wheels, wanted, way, start, x)
            if violation <= TOLERANCE:
                continue
        worst = max(worst, missing[i])
        if k == 0:
            break
    return worst


@nb.njit(cache=True)
def _moved(
    body: Body, course: Course, rules: Rules, com_way: tuple[float, float], y: Floats, st: State,
    rows: Rows,
) -> bool:  # fmt: skip
    """Whether a pose is clear once its trunk is moved to where the CoM must be.

    Args:
        body, course, rules: See `imbalance`.
        com_way: Least and largest x of the CoM [m].
        y: (5,) x, z, pitch, arc lengths of the wheels; x and z are changed.
        st, rows: Scratch.
    """
    low, high = com_way
    inner = min(_INSIDE, (high - low) / 2)
    lower, upper, none = rules.lower.copy(), rules.upper.copy(), np.zeros(7)
    lower[7:], upper[7:] = y[3:], y[3:]
    task = Task(none, none, lower, upper, BETWEEN, rules.apart, -np.inf, True, low, high)
    x, z = y[0], y[1]
    for lift in _LIFTS:
        y[0], y[1] = x, z + lift
        for _ in range(_MOVES):
            if not place(body, course, y, st):
                break
            at = com(st, 0)
            if low <= at <= high:
                if collect(body, course, task, st, rows)[1] >= -TOLERANCE:
                    return True
                break
            y[0] += min(max(at, low + inner), high - inner) - at
    return False


@leaf
def _even(begin: Floats, end: Floats, share: float, y: Floats) -> None:
    """Unknowns (5,) at a share of the way, trunk and wheels in proportion."""
    for j in range(5):
        k = j if j < 3 else j + 4
        y[j] = begin[k] + share * (end[k] - begin[k])
