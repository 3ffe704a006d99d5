"""Margins of a pose against tipping and slipping, and static joint torques."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.robot.description import Planar

from .contact import CAP, GRAVITY, RAYS, com_interval_within

Floats = NDArray[np.float64]


NOTHING_HOLDS = -1.0  # m; the margin where no CoM is in equilibrium, and the least that is stated


@leaf
def com_margin(low: float, high: float, com_x: float) -> float:
    """How far a CoM at `com_x` may shift in x, the smaller way, with equilibrium [m].

    Equilibrium holds from `low` to `high` [m], see `com_interval`. Negative outside, and finite:
    `NOTHING_HOLDS` where no CoM is held at all, and never below that.
    """
    if low > high:
        return NOTHING_HOLDS
    return max(NOTHING_HOLDS, min(com_x - low, high - com_x))


@nb.njit(cache=True)
def friction_needed(points: Floats, normals: Floats, count: int, com_x: float) -> float:
    """Least friction with which any number of contacts hold a CoM at `com_x`; inf if none does."""
    lo, hi, grips, rays = 0.0, 1.0, np.ones(count), np.empty(RAYS)
    while _outside(points, normals, count, grips, com_x, rays):
        lo, hi = hi, 2.0 * hi
        grips[:] = hi
        if hi > 1e3:
            return np.inf
    for _ in range(24):
        mid = 0.5 * (lo + hi)
        grips[:] = mid
        if not _outside(points, normals, count, grips, com_x, rays):
            hi = mid
        else:
            lo = mid
    return hi


@leaf
def _outside(
    points: Floats, normals: Floats, count: int, grips: Floats, com_x: float, rays: Floats
) -> bool:
    low, high = com_interval_within(points, normals, count, grips, CAP, rays)
    return not low <= com_x <= high


@leaf
def leg_torques(
    robot: Planar, hip: Floats, knee: Floats, wheel: Floats, contact: Floats, fx: float, fz: float
) -> tuple[float, float]:
    """Static torque of thigh and calf [Nm], of one leg of the pair that carries (fx, fz).

    Args:
        robot: Planar robot; its link masses are those of a leg pair.
        hip, knee, wheel: (2,) positions in the world [m].
        contact: (2,) where the ground pushes [m]. The wheel's motor sits in the calf, so for the
            leg's joints the wheel is one body with it.
        fx, fz: Ground force on the wheels of the pair [N].
    """
    g = GRAVITY
    # About +y the moment of (fx, fz) at r is z fx - x fz; the joint must balance everything below.
    cx = knee[0] + robot.calf_com * (wheel[0] - knee[0])
    tx = hip[0] + robot.thigh_com * (knee[0] - hip[0])
    calf = (contact[1] - knee[1]) * fx - (contact[0] - knee[0]) * fz
    calf += (cx - knee[0]) * robot.calf_mass * g + (wheel[0] - knee[0]) * robot.wheel_mass * g
    thigh = (contact[1] - hip[1]) * fx - (contact[0] - hip[0]) * fz
    thigh += (tx - hip[0]) * robot.thigh_mass * g + (cx - hip[0]) * robot.calf_mass * g
    thigh += (wheel[0] - hip[0]) * robot.wheel_mass * g
    return 0.5 * math.fabs(thigh), 0.5 * math.fabs(calf)
