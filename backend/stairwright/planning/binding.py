"""Which margin of a plan binds: the one that is least against what it is a margin of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stairwright.robot import kinematics
from stairwright.robot.description import Robot

from .plan import Binding, Pose, Quantity

Floats = NDArray[np.float64]


def margins_along(
    robot: Robot, friction: float, poses: Sequence[Pose]
) -> dict[Quantity, tuple[Floats, float]]:
    """Margins (n,) of poses, each with what it is measured against.

    Clearance [m] against the wheels' radius, CoM [m] against half the distance of the hips,
    friction against the friction there is, torques [Nm] against the weakest motor of the kind,
    joint limits [rad] against the narrowest range.
    """
    front, rear = robot.legs
    own = np.array([
        (m.clearance, m.com, m.friction, m.torque) for m in (pose.margins for pose in poses)
    ]).T  # fmt: skip
    low, high = kinematics.limits(robot).T
    q = np.array([pose.q for pose in poses])
    limits: dict[Quantity, tuple[Floats, float]] = {
        "clearance": (own[0], robot.wheel.radius),
        "com": (own[1], (front.hip[0] - rear.hip[0]) / 2),
        "friction": (own[2], friction),
        "torque": (own[3], float(robot.torque_limits[:, :2].min())),
        "joint_limit": (np.minimum(q - low, high - q).min(axis=1), float((high - low).min())),
    }
    if all(pose.forces is not None for pose in poses):
        tangential = np.array([[force[0] for force in pose.forces or ()] for pose in poses])
        most = robot.torque_limits[:, 2]
        torque = np.abs(tangential) / 2 * robot.wheel.radius  # of one wheel of a pair
        limits["wheel_torque"] = ((most - torque).min(axis=1), float(most.min()))
    return limits


def binding_of(robot: Robot, friction: float, poses: Sequence[Pose]) -> Binding | None:
    """The margin that binds, and where; None without poses."""
    if not poses:
        return None
    margins = margins_along(robot, friction, poses)
    shares = {name: float(values.min()) / scale for name, (values, scale) in margins.items()}
    name = min(shares, key=lambda quantity: shares[quantity])
    values = margins[name][0]
    k = int(values.argmin())
    return Binding(quantity=name, value=float(values[k]), progress=poses[k].progress)
