"""What a planned motion takes of the motors: the work of their static torques along its poses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stairwright._core import GRAVITY
from stairwright.documents import Deferred
from stairwright.planning.plan import Plan
from stairwright.planning.static_torques import static_torques
from stairwright.robot import spatial
from stairwright.terrain.wheel_path import wheel_path

Floats = NDArray[np.float64]

TOUCH = 1.5e-3  # m; a face counts as touched within 1 mm


def carrying_contacts(plan: Plan) -> Floats:
    """Contact points (n, 2, 2) of front and rear wheels that their forces belong to [m].

    A wheel in a concave corner touches two faces, and a pose names one of them, which need not be
    the one that carries: that is the one whose force holds up the weight together with the other
    pair's.
    """
    robot, poses = plan.robot_description, plan.poses
    path = wheel_path(plan.terrain, robot.wheel.radius)
    s = np.array([pose.wheel_progress for pose in poses])
    forces = np.array([pose.forces for pose in poses])
    # Of each pair the faces behind, at and ahead of its place: normals and forces (n, 2, 3, 2).
    near = np.clip(s[..., None] + np.array([-TOUCH, 0.0, TOUCH]), 0.0, path.length)
    normals = path.normals(near.ravel()).reshape(*near.shape, 2)
    forward = np.stack([normals[..., 1], -normals[..., 0]], axis=-1)
    force = forces[:, :, None, :1] * forward + forces[:, :, None, 1:] * normals
    held = force[:, 0, :, None] + force[:, 1, None, :] - np.array([0.0, robot.mass * GRAVITY])
    best = np.square(held).sum(axis=-1).reshape(len(poses), 9).argmin(axis=1)
    chosen = np.stack([best // 3, best % 3], axis=1)
    normal = np.take_along_axis(normals, chosen[:, :, None, None], axis=2)[:, :, 0]
    wheels = np.array([pose.wheels for pose in poses])
    contacts: Floats = wheels - robot.wheel.radius * normal
    return contacts


def joint_work(plan: Plan) -> Floats:
    """Work (n - 1, 12) that each motor does from pose to pose [J], in the contract's joint order.

    Mean static torque of both poses times the joint's turn; wheels roll without slip.

    Args:
        plan: Its n poses have forces.
    """
    robot = plan.robot_description
    poses = plan.poses
    trunk = np.array([(pose.x_c, pose.z_c, pose.pitch) for pose in poses])
    q = np.array([pose.q for pose in poses])
    forces = np.array([pose.forces for pose in poses])
    torques = static_torques(robot, trunk, q, carrying_contacts(plan), forces)
    _, _, angles = spatial.lift(robot, trunk, q, np.array([pose.wheel_progress for pose in poses]))
    work: Floats = (torques[:-1] + torques[1:]) / 2 * np.diff(angles, axis=0)
    return work


def energy(plan: Plan) -> float | None:
    """Work that the motors do or take up, as rollouts count it: the sum of its amounts [J].

    None where the poses are too sparse to tell, or not all of them can be held.
    """
    if not plan.feasible or plan.method == "critical" or len(plan.poses) < 2:
        return None
    if any(pose.forces is None for pose in plan.poses):
        return None
    return float(np.abs(joint_work(plan)).sum())


def with_energy(plan: Plan) -> Plan:
    """The same plan with energy and cost of transport, found when they are first needed."""
    work = Deferred(lambda: energy(plan))

    def cost_of_transport() -> float | None:
        if work.value is None:
            return None
        weight = plan.robot_description.mass * GRAVITY
        return float(work.value / (weight * plan.poses[-1].progress))

    cost = Deferred(cost_of_transport)
    return plan.model_copy(update={"energy": work, "cost_of_transport": cost})
