"""What a planned motion takes of the motors: the work of their static torques along its poses."""

from __future__ import annotations

import numpy as np

from stairwright._core import GRAVITY
from stairwright.arrays import Floats
from stairwright.documents import Deferred
from stairwright.planning.carrying import holding_torques
from stairwright.planning.plan import Plan
from stairwright.robot import spatial


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
    torques = holding_torques(plan)
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
