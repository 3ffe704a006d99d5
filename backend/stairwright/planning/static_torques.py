"""Torques that hold the robot at rest on its planned contact forces."""

from __future__ import annotations

import numpy as np

from stairwright._core import GRAVITY
from stairwright.arrays import Floats
from stairwright.robot import spatial
from stairwright.robot.description import Robot
from stairwright.robot.kinematics import link_com


def static_torques(
    robot: Robot, trunk: Floats, q: Floats, contacts: Floats, forces: Floats
) -> Floats:
    """Torques (n, 12) [Nm] about +y, in the contract's order of joints.

    Each joint balances what lies beyond it: the moment about +y of a force (fx, fz) at the lever
    (rx, rz) is ``rz fx - rx fz``.

    Args:
        robot: Gives lengths and masses.
        trunk: (n, 3) x, z [m] and pitch [rad].
        q: (n, 4) planar joints [rad].
        contacts: (n, 2, 2) contact point of the front and the rear wheels [m].
        forces: (n, 2, 2) (tangential, normal) force on each wheel *pair* [N], in the frame of the
            line from the contact to the wheel's centre.
    """
    bodies = spatial.place_planar(robot, trunk, q, np.zeros((len(trunk), 2)))
    torques = np.zeros((len(trunk), 4, 3))
    for leg in range(4):
        hip, knee, wheel = (p[:, leg, [0, 2]] for p in (bodies.hips, bodies.knees, bodies.wheels))
        contact = contacts[:, leg // 2]
        normal = wheel - contact
        normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
        forward = np.stack([normal[:, 1], -normal[:, 0]], axis=1)
        along, across = (forces[:, leg // 2] / 2).T
        force = along[:, None] * forward + across[:, None] * normal
        own = robot.legs[leg // 2]
        loads = [
            (wheel, own.wheel.mass),
            (link_com(own.calf, knee, wheel), own.calf.mass),
            (link_com(own.thigh, hip, knee), own.thigh.mass),
        ]
        for j, (joint, carried) in enumerate(((hip, 3), (knee, 2), (wheel, 1))):
            lever = contact - joint
            moment = lever[:, 1] * force[:, 0] - lever[:, 0] * force[:, 1]
            for place, mass in loads[:carried]:
                moment = moment + (place - joint)[:, 0] * mass * GRAVITY
            torques[:, leg, j] = -moment
    return torques.reshape(-1, 12)
