"""Static forces along a plan: what each wheel pair shall rest on while nothing else is asked for.

The controller's QP is pulled to them (eq 11). They are the smallest forces that hold the robot at
rest with part of the friction kept in reserve. Small matters as much as reserve: wheels on opposite
faces of a curb could always need less friction by pinching it harder, but pinching overloads legs
and turns a small error of a normal into a large sideways force.

Forces are kept in world axes, because a wheel near a corner may have another contact frame by the
time that it gets there.
"""

from __future__ import annotations

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
    held, A, S = np.empty(8), np.empty((3, 8)), (1.0, 1.0, _MOMENT)
    H, g, mu, forces = np.empty((8, 8)), np.empty(8), np.empty(4), np.zeros(8)
    normals = np.empty((2, 2))
    for k in range(len(places)):
        ways = np.empty(2, np.int64)
        for pair in range(2):
            ways[pair] = 3 if _in_corner(corners, places[k, pair]) else 1
        for share, limit in STAGES:
            best = np.inf
            for way in range(ways[0] * ways[1]):
                leans = (BOTH - way % ways[0], BOTH - way // ways[0])
                for wheel in range(4):
                    pair, t, n = wheel // 2, 2 * wheel, 2 * wheel + 1
                    s, lean = places[k, pair], leans[pair]
                    # What leans on both faces takes no friction: else one of them would do.
                    usable = 0.0 if lean == BOTH and ways[pair] > 1 else share * friction
                    support(pieces, radius, corners, s, s, usable, lean, held)
                    x, z, _, _ = curve_at(pieces, radius, s)
                    nx, nz, mu[wheel], reach = held[0], held[1], held[2], held[3]
                    normals[pair, 0], normals[pair, 1] = nx, nz
                    lx, lz = x - reach * nx - com[k, 0], z - reach * nz - com[k, 1]
                    A[0, t], A[1, t], A[2, t] = nz, -nx, lz * nz + lx * nx
                    A[0, n], A[1, n], A[2, n] = nx, nz, lz * nx - lx * nz
                for i in range(8):
                    for j in range(8):
                        H[i, j] = _SMALL if i == j else 0.0
                        for r in range(3):
                            H[i, j] += S[r] * A[r, i] * A[r, j]
                    g[i] = -A[1, i] * weight
                solve_native(H, g, mu, limit * weight, forces)
                missed = size = 0.0
                for i in range(8):
                    size += forces[i] * forces[i]
                for r in range(3):
                    total = -weight if r == 1 else 0.0
                    for i in range(8):
                        total += A[r, i] * forces[i]
                    missed += S[r] * total * total
                holds = missed < (_HELD * weight) ** 2
                value = size if holds else weight * weight * 1e6 + missed
                if value >= best:
                    continue
                best = value
                out[k, 4], out[k, 5], out[k, 6] = share, leans[0], leans[1]
                for pair in range(2):
                    nx, nz = normals[pair, 0], normals[pair, 1]
                    t = forces[4 * pair] + forces[4 * pair + 2]
                    n = forces[4 * pair + 1] + forces[4 * pair + 3]
                    out[k, 2 * pair], out[k, 2 * pair + 1] = t * nz + n * nx, n * nz - t * nx
            if best < weight * weight * 1e6:
                break


@leaf
def _in_corner(corners: Floats, s: float) -> bool:
    for corner in corners:  # noqa: SIM110 (compiled)
        if abs(s - corner) < CORNER_PLANNED:
            return True
    return False
