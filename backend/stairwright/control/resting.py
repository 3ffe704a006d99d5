"""Static forces along a plan: what each wheel pair shall rest on while nothing else is asked for.

The controller's QP is pulled to them (eq 11). They are the smallest forces that hold the robot at
rest with part of the friction kept in reserve. Small matters as much as reserve: wheels on opposite
faces of a curb could always need less friction by pinching it harder, but pinching overloads legs
and turns a small error of a normal into a large sideways force.

Forces are kept in world axes, because a wheel near a corner may have another contact frame by the
time that it gets there.
"""

from __future__ import annotations

from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.terrain.wheel_path import curve_at

from .contact import BOTH, CORNER_PLANNED, support
from .qp import solve_native

Floats = NDArray[np.float64]

# Shares of the friction and largest normal force of a wheel in weights, tried in turn until the
# forces hold the robot: little friction first, but not at the price of pinching.
STAGES = ((0.6, 0.6), (0.75, 0.6), (0.9, 0.6), (1.0, 0.6), (1.0, 10.0))
_HELD = 0.01  # of the weight; forces that miss less than this hold it
_MOMENT = 20.0  # 1/m^2, weight of the moment against the forces
_SMALL = 1e-4  # weight of the forces' size


@nb.njit(cache=True)
def resting_forces(
    pieces: Floats,
    corners: Floats,
    radius: float,
    weight: float,
    friction: float,
    places: Floats,
    com: Floats,
    out: Floats,
) -> None:
    """Forces of the ground on each wheel pair at rest, into `out` [N].

    Args:
        pieces: Of the `WheelPath`, as `corners` [m] and `radius` [m].
        weight: Of the robot [N].
        friction: Coulomb friction of the plan.
        places: (n, 2) arc length of the wheel pairs, front and rear [m].
        com: (n, 2) centre of mass [m].
        out: (n, 7) filled with front x, z and rear x, z in world axes, the share of the friction
            that they keep to, and what the front and the rear wheels lean on in a corner.
    """
    tried = Trial(np.empty((3, 8)), np.empty(4), np.zeros(8), np.empty((4, 2)))
    for k in range(len(places)):
        front, rear = _ways(corners, places[k, 0]), _ways(corners, places[k, 1])
        for share, limit in STAGES:
            held, best = False, np.inf
            for way in range(front * rear):
                leans = (BOTH - way % front, BOTH - way // front)
                # What leans on both faces takes no friction: else one of them would do.
                usable = (
                    0.0 if leans[0] == BOTH and front > 1 else share * friction,
                    0.0 if leans[1] == BOTH and rear > 1 else share * friction,
                )
                missed = _rest(
                    pieces, corners, radius, weight, places[k], com[k], leans, usable, limit, tried
                )
                holds = missed < (_HELD * weight) ** 2
                value = (tried.forces**2).sum() if holds else missed
                if holds < held or (holds == held and value >= best):
                    continue
                held, best = holds, value
                out[k, 4], out[k, 5], out[k, 6] = share, leans[0], leans[1]
                for pair in range(2):
                    nx, nz = tried.normals[2 * pair]
                    t = tried.forces[4 * pair] + tried.forces[4 * pair + 2]
                    n = tried.forces[4 * pair + 1] + tried.forces[4 * pair + 3]
                    out[k, 2 * pair], out[k, 2 * pair + 1] = t * nz + n * nx, n * nz - t * nx
            if held:
                break


class Trial(NamedTuple):
    """One way to rest.

    Attributes:
        A: (3, 8) map from forces to the body's wrench (eqs 3-7).
        friction: (4,) that each wheel may use.
        forces: (8,) per wheel tangential and normal [N].
        normals: (4, 2) of the faces that the wheels rest on.
    """

    A: Floats
    friction: Floats
    forces: Floats
    normals: Floats


@nb.njit(cache=True)
def _rest(
    pieces: Floats,
    corners: Floats,
    radius: float,
    weight: float,
    places: Floats,
    com: Floats,
    leans: tuple[int, int],
    usable: tuple[float, float],
    limit: float,
    trial: Trial,
) -> float:
    """Fill `trial` with the smallest forces that come nearest to holding the robot.

    Args:
        pieces, corners, radius, weight: See `resting_forces`.
        places, com: (2,) at one instant.
        leans: What front and rear wheels lean on in a corner.
        usable: Friction that front and rear wheels may use.
        limit: Largest normal force of a wheel in weights.
        trial: Filled.

    Returns:
        Weighted square of the wrench by which they miss it [N^2].
    """
    A, S, support_of = trial.A, (1.0, 1.0, _MOMENT), np.empty(8)
    for wheel in range(4):
        pair, t, n = wheel // 2, 2 * wheel, 2 * wheel + 1
        s = places[pair]
        support(pieces, radius, corners, s, s, usable[pair], leans[pair], support_of)
        x, z, _, _ = curve_at(pieces, radius, s)
        nx, nz, trial.friction[wheel], reach = support_of[:4]
        trial.normals[wheel, 0], trial.normals[wheel, 1] = nx, nz
        lx, lz = x - reach * nx - com[0], z - reach * nz - com[1]
        A[0, t], A[1, t], A[2, t] = nz, -nx, lz * nz + lx * nx
        A[0, n], A[1, n], A[2, n] = nx, nz, lz * nx - lx * nz
    H, g = np.empty((8, 8)), np.empty(8)
    for i in range(8):
        for j in range(8):
            H[i, j] = _SMALL if i == j else 0.0
            for r in range(3):
                H[i, j] += S[r] * A[r, i] * A[r, j]
        g[i] = -A[1, i] * weight
    solve_native(H, g, trial.friction, limit * weight, trial.forces)
    missed = 0.0
    for r in range(3):
        total = -weight if r == 1 else 0.0
        for i in range(8):
            total += A[r, i] * trial.forces[i]
        missed += S[r] * total * total
    return missed


@leaf
def _ways(corners: Floats, s: float) -> int:
    """In how many ways a wheel at `s` may lean on the ground."""
    for corner in corners:
        if abs(s - corner) < CORNER_PLANNED:
            return 3
    return 1
