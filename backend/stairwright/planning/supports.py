"""Where the wheels touch, and what the ground can hold there: margins of one pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Robot
from stairwright.robot.kinematics import Frames
from stairwright.statics.contact import GRAVITY, com_interval, least_friction
from stairwright.statics.margin import friction_needed, leg_torques
from stairwright.terrain.wheel_path import WheelPath

Floats = NDArray[np.float64]

CORNER = 1.5e-3  # m; a wheel this near to a concave corner touches both faces


@dataclass(frozen=True)
class Support:
    """Contacts of one pose: up to two per wheel pair.

    Attributes:
        points: (m, 2) contact points [m].
        normals: (m, 2) unit normals out of the terrain.
        owner: (m,) 0 for the front wheels, 1 for the rear ones.
    """

    points: Floats
    normals: Floats
    owner: NDArray[np.int64]

    def com_interval(self, friction: float) -> tuple[float, float]:
        """Least and largest x of the CoM [m] in equilibrium inside the friction cones."""
        low, high = com_interval(self.points, self.normals, len(self.points), friction)
        return float(low), float(high)

    def com_margin(self, friction: float, com_x: float) -> float:
        """How far the CoM may shift, the smaller way [m]; negative outside, -inf without any."""
        low, high = self.com_interval(friction)
        return -np.inf if low > high else min(com_x - low, high - com_x)

    def friction_needed(self, com_x: float) -> float:
        """Least friction that holds the CoM at `com_x`; inf where none does."""
        return float(friction_needed(self.points, self.normals, len(self.points), com_x))

    def forces(self, weight: float, com_x: float) -> Floats | None:
        """Forces (m, 2), x and z [N], of the equilibrium with the least friction need, if any.

        Of a wheel at a corner one face carries all; of all such choices the gentlest counts.
        """
        best: tuple[float, Floats] | None = None
        for front in np.flatnonzero(self.owner == 0):
            for rear in np.flatnonzero(self.owner == 1):
                pair = np.array([front, rear])
                local = np.zeros((2, 2))
                need = least_friction(self.points[pair], self.normals[pair], com_x, 0.0, local)
                if np.isfinite(need) and (best is None or need < best[0]):
                    n = self.normals[pair]
                    tangents = np.stack([n[:, 1], -n[:, 0]], axis=1)
                    force = np.zeros_like(self.points)
                    force[pair] = weight * (local[:, :1] * tangents + local[:, 1:] * n)
                    best = (need, force)
        return None if best is None else best[1]


def support(path: WheelPath, front: float, rear: float) -> Support:
    """Contacts with the wheels at arc lengths `front` and `rear`."""
    points, normals, owner = [], [], []
    for k, s in enumerate((front, rear)):
        centre = path.centres(np.array([s]))[0]
        near = path.corners[np.abs(path.corners - s) < CORNER]
        places = [s] if len(near) == 0 else [near[0] - 1e-7, near[0] + 1e-7]
        for normal in path.normals(np.array(places)):
            points.append(centre - path.radius * normal)
            normals.append(normal)
            owner.append(k)
    return Support(np.array(points), np.array(normals), np.array(owner))


def torque_margin(robot: Robot, frames: Frames, held: Support, forces: Floats) -> float:
    """Limit minus the largest static torque of leg joints and wheels [Nm]."""
    planar = robot.planar
    spare = np.inf
    for leg in range(2):
        mine = held.owner == leg
        total = forces[mine].sum(axis=0)
        # One face of a corner carries the wheel: see `Support.forces`.
        loaded = held.points[mine][np.argmax(np.abs(forces[mine]).sum(axis=1))]
        hip, knee, wheel = (
            np.ascontiguousarray(f[leg]) for f in (frames.hips, frames.knees, frames.wheels)
        )
        thigh, calf = leg_torques(
            planar, hip, knee, wheel, loaded, float(total[0]), float(total[1])
        )
        spare = min(spare, planar.leg_torque - max(thigh, calf))
        tangents = np.stack([held.normals[mine, 1], -held.normals[mine, 0]], axis=1)
        traction = float(np.abs(np.sum(tangents * forces[mine], axis=1).sum()))
        spare = min(spare, planar.wheel_torque - traction * planar.wheel_radius / 2)
    return float(spare)


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
        local = np.zeros((2, 2))
        points, n = np.ascontiguousarray(contacts[i]), np.ascontiguousarray(normals[i])
        if not np.isfinite(least_friction(points, n, float(com_x[i]), 0.0, local)):
            gap = max(points[0, 0] - points[1, 0], 1e-6)
            front = float(np.clip((com_x[i] - points[1, 0]) / gap, 0.0, 1.0))
            for k, share in enumerate((front, 1.0 - front)):
                local[k] = -share * n[k, 0], share * max(n[k, 1], 0.0)
        out[i] = weight * local
    return out


def weight_of(robot: Robot) -> float:
    """Weight of the whole robot [N]."""
    return robot.mass * GRAVITY
