"""The sound pose nearest to one that is wanted, with the wheels at given places."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from .cells import Course
from .rows import Task
from .search import TOLERANCE, Rules
from .solve import solve_pose
from .state import Body

Floats = NDArray[np.float64]

BETWEEN = 0.004  # m of clearance between critical poses, where room is scarce
_WEIGHTS = (100.0, 30.0, 3.0, 0.05, 0.05, 0.05, 0.05)  # 1/m^2, 1/rad^2


@nb.njit(cache=True)
def nearest(
    body: Body, course: Course, rules: Rules, wheels: Floats, wanted: Floats,
    com: tuple[float, float], start: Floats, x: Floats,
) -> tuple[float, float]:  # fmt: skip
    """Cost and violation of the pose nearest to `wanted`; eq 20 does not apply.

    Args:
        body: The robot.
        course: The terrain.
        rules: Bounds; with the full clearance if that is possible, else with `BETWEEN`.
        wheels: (2,) arc lengths of the wheels.
        wanted: (7,) x, z, pitch, joints; the joints count little.
        com: Least and largest x of the centre of mass [m].
        start: (5,) another first guess, or nan.
        x: (9,) filled with the pose.
    """
    lower, upper = rules.lower.copy(), rules.upper.copy()
    lower[7:], upper[7:] = wheels, wheels
    weights, guess, trial = np.array(_WEIGHTS), np.empty(5), np.empty(9)
    best, least = np.inf, np.inf
    x[:] = np.nan
    for clearance in (rules.clearance, BETWEEN):
        task = Task(
            wanted, weights, lower, upper, clearance, rules.apart, -np.inf, True, com[0], com[1]
        )
        least = np.inf
        for k in range(2):
            guess[:] = start
            if k == 1:
                guess[:3] = wanted[:3]
            guess[3:] = wheels
            if math.isnan(guess[0]):
                continue
            value, violation, _ = solve_pose(body, course, task, guess, trial)
            if violation < least:
                best, least = value, violation
                x[:] = trial
            if least <= TOLERANCE:
                return best, least
    return best, least
