"""What a robot's own joint controllers are told to do for a plan, and where that takes the robot.

The plan's motion between its poses is the one that its certificate judges and that the simulated
controller follows. It is retimed from rest to rest, see `retiming`; the plan itself stays as it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.plan import Plan
from stairwright.planning.poses.interpolation import reference
from stairwright.planning.static_torques import static_torques
from stairwright.robot import spatial
from stairwright.robot.description import Robot
from stairwright.robot.kinematics import all_joints

from .retiming import Limits, Retimed, retime

SPEED_SHARE = 0.6  # of a motor's no-load speed: the rest leaves torque
LEG_SPEED = 1.5  # rad/s; what the simulated controller allows along a plan
LEG_ACCELERATION, WHEEL_ACCELERATION = 12.0, 60.0  # rad/s^2
LEG_JERK, WHEEL_JERK = 1200.0, 6000.0  # rad/s^3
PROGRESS_ACCELERATION = 0.4  # m/s^2; the simulated controller's
TOLERANCE = 9e-4  # rad; how far leg joints cut the corners of the plan's motion
_LEGS, _WHEELS, _TRUNK, _PROGRESS, _TORQUES = (
    slice(0, 4), slice(4, 6), slice(6, 9), 9, slice(10, 16),
)  # fmt: skip
_LIMITED = 10  # channels before the torques


@dataclass(frozen=True)
class JointCommands:
    """Samples at even times from 0. SI units; joints are the 12 in the contract's order.

    Attributes:
        time: (n,).
        position, velocity, acceleration: (n, 12); wheels start at 0.
        effort: (n, 12) torques that hold each sample's pose at rest, no larger than the motors'.
        base_position: (n, 3) trunk point in the world.
        base_quaternion: (n, 4) trunk, wxyz.
    """

    time: Floats
    position: Floats
    velocity: Floats
    acceleration: Floats
    effort: Floats
    base_position: Floats
    base_quaternion: Floats


def joint_commands(plan: Plan, rate: float) -> JointCommands:
    """Commands `rate` times a second for a plan of at least two poses.

    Raises:
        InputError: If the plan has fewer poses, or lasts too long for that rate.
    """
    robot = plan.robot_description
    motion = reference(plan, joint_rate=LEG_SPEED)
    held = static_torques(robot, motion.trunk, motion.q, motion.contacts, motion.forces)
    _, _, joints = spatial.lift(robot, motion.trunk, motion.q, motion.wheel_progress)
    wheels = joints[:, [2, 8]] - joints[0, [2, 8]]
    progress = motion.progress[:, None]
    torques = held[:, [0, 1, 2, 6, 7, 8]]  # the left legs'; the right ones bear the same
    path = np.concatenate([motion.q, wheels, motion.trunk, progress, torques], axis=1)
    made = retime(motion.time, path, _limits(robot), rate)
    return JointCommands(
        time=made.time,
        position=all_joints(made.values[:, _LEGS], made.values[:, _WHEELS]),
        velocity=all_joints(made.rates[:, _LEGS], made.rates[:, _WHEELS]),
        acceleration=all_joints(made.accelerations[:, _LEGS], made.accelerations[:, _WHEELS]),
        effort=_bounded(robot, _mirrored(made)),
        base_position=np.insert(made.values[:, _TRUNK][:, :2], 1, 0.0, axis=1),
        base_quaternion=spatial.quaternion_y(made.values[:, _TRUNK][:, 2]),
    )


def _limits(robot: Robot) -> Limits:
    """Limits of the path's channels: leg joints, wheels and progress have some."""
    leg = min(LEG_SPEED, SPEED_SHARE * robot.leg_speed)
    wheel = SPEED_SHARE * robot.wheel_speed
    none = np.full(_LIMITED + 6, np.inf)
    speed, acceleration, jerk, tolerance = none.copy(), none.copy(), none.copy(), none.copy()
    speed[_LEGS], acceleration[_LEGS], jerk[_LEGS] = leg, LEG_ACCELERATION, LEG_JERK
    speed[_WHEELS], acceleration[_WHEELS], jerk[_WHEELS] = wheel, WHEEL_ACCELERATION, WHEEL_JERK
    acceleration[_PROGRESS] = PROGRESS_ACCELERATION
    tolerance[_LEGS] = TOLERANCE
    return Limits(speed, acceleration, jerk, tolerance)


def _mirrored(made: Retimed) -> Floats:
    front, rear = np.split(made.values[:, _TORQUES], 2, axis=1)
    return np.concatenate([front, front, rear, rear], axis=1)


def _bounded(robot: Robot, torques: Floats) -> Floats:
    most = np.repeat(robot.torque_limits, 2, axis=0).ravel()
    return np.clip(torques, -most, most)
