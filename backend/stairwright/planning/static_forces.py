"""Static forces of two wheel contacts: equilibrium (eq 1 at rest) with the least friction need.

Per wheel pair one force in its contact frame: tangential along the terrain (positive forward) and
normal. Three equations (force x, force z, moment) leave one internal force: the wheels may squeeze
or spread the ground along the line between the contacts.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
GRAVITY = 9.81  # m/s^2

_GOLDEN = (5**0.5 - 1) / 2


def static_forces(mass: float, com_x: Floats, contacts: Floats, normals: Floats) -> Floats:
    """Forces (n, 2, 2) [N]: wheel pair, then (tangential, normal), that hold the robot at rest.

    Of all equilibria the one whose larger ratio |tangential| / normal is least. Without any
    equilibrium that pushes on the ground at both contacts, the force of least norm is returned
    (a normal force is then negative).

    Args:
        mass: Of the whole robot [kg].
        com_x: (n,) centre of mass [m].
        contacts: (n, 2, 2) contact points [m].
        normals: (n, 2, 2) unit normals out of the terrain.
    """
    weight = mass * GRAVITY
    span = contacts[:, 0] - contacts[:, 1]
    gap = np.maximum(np.hypot(span[:, 0], span[:, 1]), 1e-9)
    line = span / gap[:, None]
    # Particular solution: forces across the line between the contacts carry weight and moment,
    # the rest of the weight acts along that line, shared equally.
    across = np.stack([-line[:, 1], line[:, 0]], axis=1)
    # Moment about the rear contact: the front force across the line has the lever `gap`.
    lever = com_x - contacts[:, 1, 0]
    front = weight * lever / gap
    rear = weight * across[:, 1] - front
    along = weight * line[:, 1] / 2
    force = np.stack(
        [
            front[:, None] * across + along[:, None] * line,
            rear[:, None] * across + along[:, None] * line,
        ],
        axis=1,
    )
    squeeze = np.stack([-line, line], axis=1)  # pushes the ground apart for positive factors
    frame = np.stack(
        [np.stack([normals[..., 1], -normals[..., 0]], axis=-1), normals], axis=-2
    )  # rows: tangent, normal
    base = np.einsum("nkij,nkj->nki", frame, force)
    inner = np.einsum("nkij,nkj->nki", frame, squeeze)
    factor = _least_need(base, inner, weight)
    chosen: Floats = base + factor[:, None, None] * inner
    return chosen


def friction_need(forces: Floats) -> Floats:
    """Largest |tangential| / normal (...,) of the forces (..., 2, 2); inf where one pulls."""
    t, n = np.abs(forces[..., 0]), forces[..., 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(n > 0.0, t / n, np.inf)
    # A wheel without load needs no friction.
    ratio = np.where((t < 1e-9) & (n > -1e-9), 0.0, ratio)
    need: Floats = np.max(ratio, axis=-1)
    return need


def _least_need(base: Floats, inner: Floats, weight: float) -> Floats:
    """Factors (n,) of `inner` with the least friction need; 0 where no factor has both pushing."""
    low = np.full(len(base), -10 * weight)
    high = np.full(len(base), 10 * weight)
    for k in range(2):
        a, b = inner[:, k, 1], base[:, k, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            edge = -b / a
        low = np.where(a > 1e-12, np.maximum(low, edge), low)
        high = np.where(a < -1e-12, np.minimum(high, edge), high)
        impossible = (np.abs(a) <= 1e-12) & (b < 0)
        high = np.where(impossible, low - 1.0, high)
    some = high > low
    lo, hi = np.where(some, low, 0.0), np.where(some, high, 0.0)
    # The need is a maximum of ratios of linear functions: quasi-convex, so a golden section finds
    # its least value.
    for _ in range(60):
        x1 = hi - _GOLDEN * (hi - lo)
        x2 = lo + _GOLDEN * (hi - lo)
        f1 = friction_need(base + x1[:, None, None] * inner)
        f2 = friction_need(base + x2[:, None, None] * inner)
        left = f1 <= f2
        hi, lo = np.where(left, x2, hi), np.where(left, lo, x1)
    return (lo + hi) / 2
