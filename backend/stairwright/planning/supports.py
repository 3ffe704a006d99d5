"""What the ground's forces ask of the legs: gentlest equilibrium, static torques (numba)."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.robot.description import Planar, Robot
from stairwright.statics.contact import GRAVITY, least_friction
from stairwright.statics.margin import leg_torques

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def weight_of(robot: Robot) -> float:
    """Weight of the whole robot [N]."""
    return robot.mass * GRAVITY


@nb.njit(cache=True)
def gentlest_forces(
    points: Floats, normals: Floats, owner: Ints, count: int, com_x: float, forces: Floats
) -> bool:
    """Equilibrium with the least friction need; False if there is none.

    Of a wheel at a corner one face carries all; of all such choices the gentlest counts.

    Args:
        points: (m, 2) contact points [m].
        normals: (m, 2) unit normals out of the terrain.
        owner: (m,) 0 for the front wheels, 1 for the rear ones.
        count: Number of contacts.
        com_x: Centre of mass [m].
        forces: (m, 2) filled with (tangential, normal) forces, in robot weights.
    """
    pair, n, local = np.empty((2, 2)), np.empty((2, 2)), np.empty((2, 2))
    best = np.inf
    forces[:] = 0.0
    for front in range(count):
        for rear in range(count):
            if owner[front] != 0 or owner[rear] != 1:
                continue
            pair[0], pair[1] = points[front], points[rear]
            n[0], n[1] = normals[front], normals[rear]
            need = least_friction(pair, n, com_x, 0.0, local)
            if need < best:
                best = need
                forces[:] = 0.0
                forces[front], forces[rear] = local[0], local[1]
    return math.isfinite(best)


@leaf
def torque_margin(
    robot: Planar, skeleton: Floats, points: Floats, normals: Floats, owner: Ints, count: int,
    forces: Floats,
) -> float:  # fmt: skip
    """Limit minus the largest static torque of leg joints and wheels [Nm].

    Args:
        robot: The robot.
        skeleton: (6, 2) hips, knees and wheel centres; each front, rear [m].
        points, normals, owner, count: Contacts, see `gentlest_forces`.
        forces: (m, 2) tangential and normal forces [N].
    """
    spare = np.inf
    for leg in range(2):
        fx, fz, traction, most, loaded = 0.0, 0.0, 0.0, -1.0, 0
        for k in range(count):
            if owner[k] != leg:
                continue
            t, f = forces[k, 0], forces[k, 1]
            fx += t * normals[k, 1] + f * normals[k, 0]
            fz += f * normals[k, 1] - t * normals[k, 0]
            traction += t
            if abs(t) + abs(f) > most:
                most, loaded = abs(t) + abs(f), k
        hip, knee, wheel = skeleton[leg], skeleton[2 + leg], skeleton[4 + leg]
        thigh, calf = leg_torques(robot, hip, knee, wheel, points[loaded], fx, fz)
        spare = min(spare, robot.leg_torque - max(thigh, calf))
        spare = min(spare, robot.wheel_torque - abs(traction) * robot.wheel_radius / 2)
    return spare


@nb.njit(cache=True)
def contact_forces(weight: float, com_x: Floats, contacts: Floats, normals: Floats) -> Floats:
    """Forces (n, 2, 2) [N] of many poses: wheel pair, then (tangential, normal).

    The equilibrium with the least friction need. Where two pushing contacts hold no equilibrium,
    each wheel's share of the weight by its lever, in the contact's frame.

    Args:
        weight: Of the whole robot [N].
        com_x: (n,) centre of mass [m].
        contacts: (n, 2, 2) contact points [m].
        normals: (n, 2, 2) unit normals out of the terrain.
    """
    out = np.empty((len(com_x), 2, 2))
    for i in range(len(com_x)):
        points, n = contacts[i], normals[i]
        if not math.isfinite(least_friction(points, n, com_x[i], 0.0, out[i])):
            gap = max(points[0, 0] - points[1, 0], 1e-6)
            front = min(max((com_x[i] - points[1, 0]) / gap, 0.0), 1.0)
            for k in range(2):
                share = front if k == 0 else 1.0 - front
                out[i, k, 0], out[i, k, 1] = -share * n[k, 0], share * max(n[k, 1], 0.0)
    return weight * out
