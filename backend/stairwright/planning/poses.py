"""Completing a pose: from trunk and wheel places to the whole document, margins included."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

from .clearance import clearance
from .plan import Margins, Pose
from .supports import Support, contact_forces, support, torque_margin, weight_of

Floats = NDArray[np.float64]

WORST = -1e3  # written where a margin has no finite value: nothing holds the robot there


def complete_pose(
    robot: Robot,
    path: WheelPath,
    friction: float,
    trunk: tuple[float, float, float],
    wheel_progress: tuple[float, float],
    *,
    q: Floats | None = None,
    progress: float = 0.0,
    time: float = 0.0,
) -> Pose:
    """The pose document of a trunk pose with the wheels at places of the wheel-centre curve.

    Args:
        robot: The robot.
        path: Wheel-centre curve of the terrain.
        friction: Between wheels and terrain.
        trunk: x, z [m] and pitch [rad].
        wheel_progress: Arc lengths of the front and the rear wheels [m].
        q: (4,) planar joints; found by inverse kinematics if left out. They count where a wheel is
            out of reach.
        progress: Mean arc length since the start [m].
        time: Planned time since the start [s].
    """
    x, z, pitch = (np.asarray(value, float) for value in trunk)
    wheels = path.centres(np.array(wheel_progress))
    joints = kinematics.inverse(robot, x, z, pitch, wheels)
    if q is not None:
        joints = np.where(np.isfinite(joints), joints, q)
    joints = _snap(robot, joints)
    frames = kinematics.forward(robot, x, z, pitch, joints)
    com = kinematics.com(robot, x, z, frames)
    held = support(path, *wheel_progress)
    normals = path.normals(np.array(wheel_progress))
    contacts = path.contacts(np.array(wheel_progress))
    forces = contact_forces(weight_of(robot), com[None, 0], contacts[None], normals[None])[0]
    return Pose(
        progress=progress,
        time=time,
        x_c=float(x),
        z_c=float(z),
        pitch=float(pitch),
        q=(float(joints[0]), float(joints[1]), float(joints[2]), float(joints[3])),
        wheels=_pairs(frames.wheels),
        wheel_progress=(float(wheel_progress[0]), float(wheel_progress[1])),
        contacts=_pairs(contacts),
        com=(float(com[0]), float(com[1])),
        collision_points=[
            (float(px), float(pz))
            for px, pz in kinematics.collision_points(robot, x, z, pitch, joints)
        ],
        forces=_pairs(forces),
        margins=margins(robot, path, friction, trunk, joints, held, frames, float(com[0])),
    )


def margins(
    robot: Robot,
    path: WheelPath,
    friction: float,
    trunk: tuple[float, float, float],
    q: Floats,
    held: Support,
    frames: kinematics.Frames,
    com_x: float,
) -> Margins:
    """All margins of one pose; the arguments are those of `complete_pose` and what it derived."""
    forces = held.forces(weight_of(robot), com_x)
    torque = WORST if forces is None else torque_margin(robot, frames, held, forces)
    return Margins(
        clearance=clearance(robot, path.vertices, trunk, q)[0],
        com=_finite(held.com_margin(friction, com_x)),
        friction=_finite(friction - held.friction_needed(com_x)),
        torque=torque,
    )


def _snap(robot: Robot, q: Floats) -> Floats:
    """Joints with a rounding error beyond a limit put onto it."""
    limits = kinematics.limits(robot)
    inside = np.clip(q, limits[:, 0], limits[:, 1])
    return np.where(np.abs(q - inside) < 1e-6, inside, q)


def _finite(value: float) -> float:
    return max(value, WORST) if math.isfinite(value) else WORST


def _pairs(rows: Floats) -> tuple[tuple[float, float], tuple[float, float]]:
    (a, b), (c, d) = rows
    return (float(a), float(b)), (float(c), float(d))
