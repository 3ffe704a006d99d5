"""Which margin of a plan binds: the one that is least against what it is a margin of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.plan import Binding, Pose, Quantity
from stairwright.robot import kinematics
from stairwright.robot.description import Robot


@dataclass(frozen=True)
class Margins:
    """Margins of n poses, each with what it is measured against.

    Attributes:
        robot: Whose motors and joints bound them.
        friction: There is.
        own: (4, n) clearance [m], CoM [m], friction, torque [Nm].
        q: (n, 4) planar joints [rad].
        tangential: (n, 2) force of the front and the rear wheel pair, where it is known [N].
    """

    robot: Robot
    friction: float
    own: Floats
    q: Floats
    tangential: Floats | None

    @classmethod
    def of(cls, robot: Robot, friction: float, poses: Sequence[Pose]) -> Self:
        """Those of poses."""
        own = np.array([
            (m.clearance, m.com, m.friction, m.torque) for m in (pose.margins for pose in poses)
        ]).T  # fmt: skip
        known = all(pose.forces is not None for pose in poses)
        forces = [[force[0] for force in pose.forces or ()] for pose in poses] if known else None
        tangential = None if forces is None else np.array(forces)
        return cls(robot, friction, own, np.array([pose.q for pose in poses]), tangential)

    def measured(self) -> dict[Quantity, tuple[Floats, float]]:
        """Margins (n,), each with what it is measured against.

        Clearance [m] against the wheels' radius, CoM [m] against half the distance of the hips,
        friction against the friction there is, torques [Nm] against the weakest motor of the kind,
        joint limits [rad] against the narrowest range.
        """
        robot, own = self.robot, self.own
        front, rear = robot.legs
        low, high = kinematics.limits(robot).T
        slack = np.minimum(self.q - low, high - self.q).min(axis=1)
        limits: dict[Quantity, tuple[Floats, float]] = {
            "clearance": (own[0], robot.wheel.radius),
            "com": (own[1], (front.hip[0] - rear.hip[0]) / 2),
            "friction": (own[2], self.friction),
            "torque": (own[3], float(robot.torque_limits[:, :2].min())),
            "joint_limit": (slack, float((high - low).min())),
        }
        if self.tangential is not None:
            most = robot.torque_limits[:, 2]
            torque = np.abs(self.tangential) / 2 * robot.wheel.radius  # of one wheel of a pair
            limits["wheel_torque"] = ((most - torque).min(axis=1), float(most.min()))
        return limits

    def binding(self, progress: Floats) -> Binding:
        """The margin that binds, and where of `progress` (n,) [m]."""
        margins = self.measured()
        shares = {name: float(values.min()) / scale for name, (values, scale) in margins.items()}
        name = min(shares, key=lambda quantity: shares[quantity])
        values = margins[name][0]
        k = int(values.argmin())
        return Binding(quantity=name, value=float(values[k]), progress=float(progress[k]))


def binding_of(robot: Robot, friction: float, poses: Sequence[Pose]) -> Binding | None:
    """The margin that binds, and where; None without poses."""
    if not poses:
        return None
    progress = np.array([pose.progress for pose in poses])
    return Margins.of(robot, friction, poses).binding(progress)
