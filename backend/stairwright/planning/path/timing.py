"""When each node is passed: speed within the limits of wheels, joints and margins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Robot

Floats = NDArray[np.float64]

JOINT_RATE = 1.5  # rad/s; faster legs swing more than a controller can follow
_PITCH_RATE = 0.8  # rad/s
_ALONE = 1.5  # one wheel may roll this much faster than the speed along the course
_ACCELERATION = 0.4  # m/s^2 along the path
_THIN = 0.03  # m; below this CoM margin the robot slows down
_SLOWEST = 0.4  # of the wished speed


def path_parameter(s: Floats, body: Floats) -> Floats:
    """Progress (n,) [m]: mean arc length that the wheels have rolled, forward or back.

    Where the trunk moves above standing wheels it grows by a thousandth of the trunk's motion, so
    that it rises strictly.
    """
    rolled = 0.5 * np.abs(np.diff(s, axis=0)).sum(axis=1)
    moved = np.abs(np.diff(body, axis=0)).sum(axis=1)
    return np.concatenate([[0.0], np.cumsum(rolled + 1e-3 * moved + 1e-7)])


def pose_times(
    robot: Robot, s: Floats, body: Floats, q: Floats, margin: Floats, speed: float
) -> Floats:
    """Times (n,) [s] of the nodes.

    Args:
        robot: Its actuators' speeds bound wheels and joints.
        s: (n, 2) arc lengths.
        body: (n, 3) trunk poses.
        q: (n, 4) joints.
        margin: (n,) CoM margin [m]; thin margins slow the robot down.
        speed: Wished mean wheel speed [m/s].
    """
    wheel_cap = 0.5 * robot.actuators.wheel.speed * robot.wheel.radius
    joint_cap = min(JOINT_RATE, 0.3 * robot.actuators.leg.speed)
    ds = np.abs(np.diff(s, axis=0))
    length = np.diff(path_parameter(s, body))
    thin = np.clip(np.minimum(margin[:-1], margin[1:]) / _THIN, _SLOWEST, 1.0)
    least = np.maximum.reduce(
        [
            0.5 * ds.sum(axis=1) / (speed * thin),
            ds.max(axis=1) / np.minimum(_ALONE * speed * thin, wheel_cap),
            np.abs(np.diff(q, axis=0)).max(axis=1) / joint_cap,
            np.abs(np.diff(body[:, 2])) / _PITCH_RATE,
        ]
    )
    # Accelerate and brake gently between the speeds that the segments allow.
    fastest = length / np.maximum(least, 1e-9)
    node = np.minimum(np.append(fastest, fastest[-1]), np.insert(fastest, 0, fastest[0]))
    node[0] = node[-1] = min(0.02, 0.2 * speed)
    for order in (range(1, len(node)), range(len(node) - 2, -1, -1)):
        for k in order:
            before = k - 1 if order.step > 0 else k + 1
            ahead = length[min(k, before)]
            node[k] = min(node[k], (node[before] ** 2 + 2 * _ACCELERATION * ahead) ** 0.5)
    mean = np.maximum(0.5 * (node[:-1] + node[1:]), 1e-6)
    steps = np.maximum(least, length / mean)
    return np.concatenate([[0.0], np.cumsum(steps)])
