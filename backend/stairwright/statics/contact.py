"""Statics of wheels on terrain: where the centre of mass may be, in closed form.

The robot at rest needs contact forces inside their friction cones whose sum is the weight and whose
moment balances it. In the plane a cone is spanned by two rays; force is counted in robot weights
and moment in weights times metres, so the moment that the weight asks for is the CoM's x.

With ray strengths between 0 and `CAP` the question is a linear programme with two equations. Its
dual has two variables and is piecewise linear, so its optimum lies where two of the rays' lines
cross: all crossings are tried. The test compares it with scipy's solver.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

Floats = NDArray[np.float64]

GRAVITY = 9.81  # m/s^2
CAP = 1.0  # largest ray strength, in weights: joints hold no larger force of wedged wheels
SQUEEZE = 3.0  # largest inner force looked at, in weights
MAX_CONTACTS = 6
RAYS = (3, 2 * MAX_CONTACTS)  # direction (x, z) and moment of each
_EPS = 1e-9


@nb.njit(cache=True)
def com_interval(
    points: Floats, normals: Floats, count: int, friction: float, cap: float = CAP
) -> tuple[float, float]:
    """Least and largest x of the CoM [m] that the first `count` contacts can hold at rest.

    Args:
        points: (m, 2) contact points [m].
        normals: (m, 2) unit normals out of the terrain.
        count: Number of contacts used, at most `MAX_CONTACTS`.
        friction: Coulomb friction, alike at all contacts.
        cap: Largest ray strength, in weights.

    Returns:
        (low, high); low > high (+inf, -inf) where nothing can hold the robot.
    """
    grips = np.full(count, friction)
    return com_interval_within(points, normals, count, grips, cap, np.empty(RAYS))


@leaf
def com_interval_within(
    points: Floats, normals: Floats, count: int, grips: Floats, cap: float, rays: Floats
) -> tuple[float, float]:
    """As `com_interval`, for who asks often.

    `grips` (m,) is the friction of each contact; `rays` of shape `RAYS` is overwritten.
    """
    n = 2 * count
    dx, dz, moment = rays[0], rays[1], rays[2]
    for i in range(count):
        for k in range(2):
            side = grips[i] if k == 0 else -grips[i]
            x = normals[i, 0] + side * normals[i, 1]
            z = normals[i, 1] - side * normals[i, 0]
            dx[2 * i + k], dz[2 * i + k] = x, z
            # Weight acts down at the CoM: force balance sum(f) = (0, 1), moment about the origin
            # sum(x f_z - z f_x) = x_com.
            moment[2 * i + k] = points[i, 0] * z - points[i, 1] * x
    # The weight must lie in the zonotope of the rays: test every direction normal to a ray.
    for i in range(n):
        for k in range(2):
            ux, uz = (-dz[i], dx[i]) if k == 0 else (dz[i], -dx[i])
            reach = 0.0
            for j in range(n):
                reach += max(0.0, ux * dx[j] + uz * dz[j])
            if uz > cap * reach + _EPS:
                return np.inf, -np.inf
    low, high = -np.inf, np.inf
    for i in range(n):
        for j in range(i + 1, n):
            det = dx[i] * dz[j] - dz[i] * dx[j]
            if abs(det) < _EPS:
                continue
            yx = (moment[i] * dz[j] - moment[j] * dz[i]) / det
            yz = (dx[i] * moment[j] - dx[j] * moment[i]) / det
            above, below = 0.0, 0.0
            for k in range(n):
                slack = moment[k] - yx * dx[k] - yz * dz[k]
                if slack > 0.0:
                    above += slack
                else:
                    below += slack
            high = min(high, yz + cap * above)
            low = max(low, yz + cap * below)
    if low > high + 1e-7 or not math.isfinite(low + high):
        return np.inf, -np.inf
    return min(low, high), max(low, high)


@leaf
def _squeeze_range(
    base: Floats, inner: Floats, friction: float, bound: float
) -> tuple[float, float]:
    """Factors of the inner force that keep both contact forces inside their cones."""
    low, high = -bound, bound
    for k in range(2):
        for m in range(3):
            side = 1.0 - m
            # m = 0, 2: friction * normal -/+ tangential >= 0; m = 1: normal >= 0
            mu = friction if m != 1 else 1.0
            a = mu * base[k, 1] - side * base[k, 0]
            b = mu * inner[k, 1] - side * inner[k, 0]
            if b > 1e-12:
                low = max(low, -a / b)
            elif b < -1e-12:
                high = min(high, -a / b)
            elif a < -1e-9:
                return 1.0, -1.0
    return low, high


@nb.njit(cache=True)
def least_friction(
    points: Floats, normals: Floats, com_x: float, ample: float, forces: Floats
) -> float:
    """Least friction with which two contacts hold a CoM at `com_x`, and the forces that do.

    Args:
        points: (2, 2) contact points [m].
        normals: (2, 2) unit normals out of the terrain.
        com_x: Centre of mass [m].
        ample: Friction that may be used without harm: up to it the forces squeeze the terrain
            least, beyond it they need the least friction.
        forces: (2, 2) filled with (tangential, normal) per contact, in weights; tangential is
            positive along (n_z, -n_x), forward on the level.

    Returns:
        The friction needed; inf where no push on both contacts holds the robot.
    """
    lx, lz = points[0, 0] - points[1, 0], points[0, 1] - points[1, 1]
    gap = math.hypot(lx, lz)
    if gap < 1e-9:
        return np.inf
    ux, uz = lx / gap, lz / gap
    front = (com_x - points[1, 0]) / gap  # across the line of contacts: lever `gap`
    rear = -front + ux
    base, inner = np.empty((2, 2)), np.empty((2, 2))
    for k in range(2):
        nx, nz = normals[k, 0], normals[k, 1]
        across = front if k == 0 else rear
        fx, fz = -across * uz + 0.5 * uz * ux, across * ux + 0.5 * uz * uz
        sign = -1.0 if k == 0 else 1.0
        base[k, 0], base[k, 1] = fx * nz - fz * nx, fx * nx + fz * nz
        inner[k, 0], inner[k, 1] = sign * (ux * nz - uz * nx), sign * (ux * nx + uz * nz)
    lo, hi = 0.0, 1e4
    a, b = _squeeze_range(base, inner, hi, SQUEEZE)
    if a > b:
        return np.inf
    hi = 8.0
    a, b = _squeeze_range(base, inner, hi, SQUEEZE)
    while a > b:
        lo, hi = hi, 2.0 * hi
        a, b = _squeeze_range(base, inner, hi, SQUEEZE)
    for _ in range(40):
        mid = 0.5 * (lo + hi)
        c, d = _squeeze_range(base, inner, mid, SQUEEZE)
        if c <= d:
            hi, a, b = mid, c, d
        else:
            lo = mid
        if hi - lo < 1e-7:
            break
    if ample > hi:
        a, b = _squeeze_range(base, inner, ample, SQUEEZE)
    factor = min(max(0.0, a), b)
    for k in range(2):
        for m in range(2):
            forces[k, m] = base[k, m] + factor * inner[k, m]
    return hi
