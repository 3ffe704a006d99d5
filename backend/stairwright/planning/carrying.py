"""What holds a plan's poses at rest: the faces that carry, and the motors' torques."""

from __future__ import annotations

import numpy as np

from stairwright._core import GRAVITY
from stairwright.arrays import Floats
from stairwright.planning.plan import Plan
from stairwright.planning.static_torques import static_torques
from stairwright.terrain.wheel_path import WheelPath, wheel_path

TOUCH = 1e-4  # m; a wheel this near to a concave corner, by arc length, touches both faces
_BESIDE = 1e-7  # m; either side of a corner


def carrying_normals(path: WheelPath, mass: float, s: Floats, forces: Floats) -> Floats:
    """Unit normals (n, 2, 2) that forces on the wheel pairs are told along.

    A wheel in a concave corner leans on one of two faces or, along their bisector, on both: on
    what holds up the weight together with the other pair's force.

    Args:
        path: Of the wheels' centres.
        mass: Of the robot [kg].
        s: (n, 2) places of the front and the rear wheels on `path` [m].
        forces: (n, 2, 2) (tangential, normal) force on each wheel pair [N].
    """
    normals = _faces(path, s)
    forward = np.stack([normals[..., 1], -normals[..., 0]], axis=-1)
    force = forces[:, :, None, :1] * forward + forces[:, :, None, 1:] * normals
    held = force[:, 0, :, None] + force[:, 1, None, :] - np.array([0.0, mass * GRAVITY])
    ways = normals.shape[2]
    best = np.square(held).sum(axis=-1).reshape(len(s), ways**2).argmin(axis=1)
    chosen = np.stack(np.divmod(best, ways), axis=1)
    carrying: Floats = np.take_along_axis(normals, chosen[:, :, None, None], axis=2)[:, :, 0]
    return carrying


def _faces(path: WheelPath, s: Floats) -> Floats:
    """Normals (n, 2, 3, 2) of the faces behind and ahead of the places `s`, and their bisector."""
    beside = np.stack([s, s], axis=-1)
    if len(path.corners):
        corner = path.corners[np.abs(s[..., None] - path.corners).argmin(axis=-1)]
        inside = np.abs(s - corner) <= TOUCH
        beside[inside] = corner[inside, None] + np.array([-_BESIDE, _BESIDE])
    faces = path.normals(beside.ravel()).reshape(*beside.shape, 2)
    middle = faces.sum(axis=2)
    length = np.linalg.norm(middle, axis=-1, keepdims=True)
    # Opposite walls have no direction between them.
    middle = np.where(length < 0.2, faces[:, :, 0], middle / np.maximum(length, 1e-9))
    return np.concatenate([faces, middle[:, :, None]], axis=2)


def holding_torques(plan: Plan) -> Floats:
    """Torques (n, 12) [Nm] that hold each pose at rest, in the contract's joint order.

    Zero where a pose has no planned forces.
    """
    robot = plan.robot_description
    torques = np.zeros((len(plan.poses), 12))
    held = [i for i, pose in enumerate(plan.poses) if pose.forces is not None]
    if not held:
        return torques
    poses = [plan.poses[i] for i in held]
    trunk = np.array([(pose.x_c, pose.z_c, pose.pitch) for pose in poses])
    q, s, wheels, forces = (
        np.array([getattr(pose, name) for pose in poses])
        for name in ("q", "wheel_progress", "wheels", "forces")
    )
    path = wheel_path(plan.terrain, robot.wheel.radius)
    contacts = wheels - path.radius * carrying_normals(path, robot.mass, s, forces)
    torques[held] = static_torques(robot, trunk, q, contacts, forces)
    return torques
