"""What the controller knows about the robot: its state in the world's x-z plane.

Computed from the trunk's pose and the joint angles alone (no look into the simulator), so that
noise and delay on these act on everything. The trunk may roll and yaw a little; points are placed
in 3D and then read in the plane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats
from stairwright.robot.description import Robot
from stairwright.robot.kinematics import lengths, link_com
from stairwright.robot.legs import Leg


@dataclass(frozen=True)
class Measurement:
    """Planar state. SI units, world frame; legs in the order FL, FR, RL, RR.

    Attributes:
        trunk: (2,) trunk point x, z.
        trunk_velocity: (2,) its velocity.
        pitch: about +y; continuous through 90 degrees.
        pitch_rate: [rad/s].
        roll: sine of the lateral axis' rise, the left side up positive.
        roll_rate: its rate [1/s].
        heading: of the lateral axis about z, so that it has no singularity at 90 degrees of pitch.
        yaw_rate: about the world's z axis [rad/s].
        hips, knees, wheels: (4, 2) x, z.
        thighs, calves: (4, 2) x, z of their mass centres.
        com: (2,) centre of mass of the whole robot.
        com_velocity: (2,).
        inertia: of the whole robot about its centre of mass, about y [kg m^2].
        joints: (4, 2) thigh and calf angles.
        joint_rates: (4, 2).
        wheel_rates: (4,) of the wheel joints [rad/s].
        rolling_rates: (4,) absolute: wheel joint, leg and trunk together [rad/s].
    """

    trunk: Floats
    trunk_velocity: Floats
    pitch: float
    pitch_rate: float
    roll: float
    roll_rate: float
    heading: float
    yaw_rate: float
    hips: Floats
    knees: Floats
    wheels: Floats
    thighs: Floats
    calves: Floats
    com: Floats
    com_velocity: Floats
    inertia: float
    joints: Floats
    joint_rates: Floats
    wheel_rates: Floats
    rolling_rates: Floats


def _legs(robot: Robot) -> tuple[Leg, Leg, Leg, Leg]:
    """In the order FL, FR, RL, RR."""
    front, rear = robot.legs
    return front, front, rear, rear


def measure(robot: Robot, qpos: Floats, qvel: Floats) -> Measurement:
    """The planar state of MuJoCo's `qpos` (19,) and `qvel` (18,), or of their measurements."""
    turn = rotation(qpos[3:7])
    spin = qvel[3:6]  # trunk frame, as MuJoCo keeps it
    angles, rates = qpos[7:].reshape(4, 3), qvel[6:].reshape(4, 3)
    thigh, calf = angles[:, 0], angles[:, 0] + angles[:, 1]
    thigh_rate, calf_rate = rates[:, 0], rates[:, 0] + rates[:, 1]
    hips = np.array([leg.hip for leg in _legs(robot)])
    side = robot.hips.half_track * np.array([1.0, -1.0, 1.0, -1.0])

    # Points and their velocities in the trunk frame, (4, 2) x, z.
    upper, lower = _link(thigh), _link(calf)
    first, second = (np.repeat(pair, 2)[:, None] for pair in lengths(robot))
    knees = hips + first * upper
    wheels = knees + second * lower
    knee_v = first * _link_rate(thigh, thigh_rate)
    wheel_v = knee_v + second * _link_rate(calf, calf_rate)
    body = robot.body
    own = np.array([body.com[0], body.com[2]])
    legs = _legs(robot)
    thighs = np.array([link_com(leg.thigh, hips[k], knees[k]) for k, leg in enumerate(legs)])
    calves = np.array([link_com(leg.calf, knees[k], wheels[k]) for k, leg in enumerate(legs)])
    masses, places, speeds, inertia = [body.mass], [own], [np.zeros(2)], body.inertia[1]
    for k, leg in enumerate(legs):
        masses += [leg.thigh.mass, leg.calf.mass, leg.wheel.mass]
        places += [thighs[k], calves[k], wheels[k]]
        speeds += [  # of a point of a link: as its place, a linear map of where the joints are
            link_com(leg.thigh, np.zeros(2), knee_v[k]), link_com(leg.calf, knee_v[k], wheel_v[k]),
            wheel_v[k],
        ]  # fmt: skip
        inertia += sum(part.inertia[1] for part in (leg.thigh, leg.calf, leg.wheel))
    com, com_v = (np.average(rows, axis=0, weights=masses) for rows in (places, speeds))
    inertia += float(np.array(masses) @ ((np.array(places) - com) ** 2).sum(axis=-1))

    def world(points: Floats) -> Floats:
        solid = np.column_stack([points[:, 0], side, points[:, 1]])
        moved: Floats = (qpos[:3] + solid @ turn.T)[:, [0, 2]]
        return moved

    com_solid = np.array([com[0], 0.0, com[1]])
    com_velocity = qvel[:3] + turn @ (
        np.cross(spin, com_solid) + np.array([com_v[0], 0.0, com_v[1]])
    )
    return Measurement(
        trunk=qpos[[0, 2]],
        trunk_velocity=qvel[[0, 2]],
        pitch=math.atan2(turn[0, 2], turn[2, 2]),
        pitch_rate=float(spin[1]),
        roll=float(turn[2, 1]),
        roll_rate=float(turn[2, 2] * spin[0] - turn[2, 0] * spin[2]),
        heading=math.atan2(-turn[0, 1], turn[1, 1]),
        yaw_rate=float(turn[2] @ spin),
        hips=world(hips),
        knees=world(knees),
        wheels=world(wheels),
        thighs=world(thighs),
        calves=world(calves),
        com=(qpos[:3] + turn @ com_solid)[[0, 2]],
        com_velocity=com_velocity[[0, 2]],
        inertia=float(inertia),
        joints=angles[:, :2],
        joint_rates=rates[:, :2],
        wheel_rates=rates[:, 2],
        rolling_rates=rates.sum(axis=1) + spin[1],
    )


def rotation(quaternion: Floats) -> Floats:
    """(3, 3) rotation matrix of a unit quaternion wxyz."""
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _link(angle: Floats) -> Floats:
    return np.stack([-np.sin(angle), -np.cos(angle)], axis=-1)


def _link_rate(angle: Floats, rate: Floats) -> Floats:
    return np.stack([-np.cos(angle), np.sin(angle)], axis=-1) * rate[:, None]
