"""Where every part of the robot is in the world, for one state or for many at once.

A state is the base's position and quaternion (wxyz) and the 12 joints in the contract's order. The
joints turn about the body's +y, so a part's orientation is the base's times a turn about y.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats

from .description import Robot
from .kinematics import lengths


def quaternion_y(angle: Floats) -> Floats:
    """Quaternions wxyz (..., 4) of turns about +y by `angle` (...) [rad]."""
    half = np.asarray(angle, float) / 2
    zero = np.zeros_like(half)
    return np.stack([np.cos(half), zero, np.sin(half), zero], axis=-1)


def multiply(a: Floats, b: Floats) -> Floats:
    """Hamilton product of quaternions wxyz (..., 4)."""
    aw, ax, ay, az = np.moveaxis(a, -1, 0)
    bw, bx, by, bz = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ],
        axis=-1,
    )


def turn(q: Floats, v: Floats) -> Floats:
    """Vectors `v` (..., 3) turned by unit quaternions `q` (..., 4)."""
    w, u = q[..., :1], q[..., 1:]
    t = 2.0 * np.cross(u, v)
    turned: Floats = v + w * t + np.cross(u, t)
    return turned


@dataclass(frozen=True)
class Bodies:
    """Parts of n states in the world. Legs run FL, FR, RL, RR; positions in m, quaternions wxyz.

    Attributes:
        trunk: (n, 3) trunk point.
        trunk_turn: (n, 4).
        hips, knees, wheels: (n, 4, 3) joint axes and wheel centres.
        thigh_turn, calf_turn, wheel_turn: (n, 4, 4).
        com: (n, 3) centre of mass of the whole robot.
        points: (n, m, 3) collision points on both sides: right side first, then left.
    """

    trunk: Floats
    trunk_turn: Floats
    hips: Floats
    knees: Floats
    wheels: Floats
    thigh_turn: Floats
    calf_turn: Floats
    wheel_turn: Floats
    com: Floats
    points: Floats


def place(robot: Robot, position: Floats, quaternion: Floats, q: Floats) -> Bodies:
    """All parts for base positions (n, 3), quaternions wxyz (n, 4) and joints (n, 12) [rad]."""
    position, quaternion = np.atleast_2d(position), np.atleast_2d(quaternion)
    angles = np.atleast_2d(q).reshape(-1, 4, 3)
    base = quaternion[:, None, :]
    thigh = multiply(base, quaternion_y(angles[..., 0]))
    calf = multiply(base, quaternion_y(angles[..., 0] + angles[..., 1]))
    wheel = multiply(base, quaternion_y(angles.sum(axis=-1)))
    hips = position[:, None, :] + turn(base, hip_offsets(robot))
    down = np.array([0.0, 0.0, -1.0])
    upper, lower = (np.repeat(pair, 2)[:, None] for pair in lengths(robot))
    knees = hips + upper * turn(thigh, down)
    wheels = knees + lower * turn(calf, down)
    return Bodies(
        trunk=position,
        trunk_turn=quaternion,
        hips=hips,
        knees=knees,
        wheels=wheels,
        thigh_turn=thigh,
        calf_turn=calf,
        wheel_turn=wheel,
        com=_com(robot, position, quaternion, hips, thigh, knees, calf, wheels),
        points=_points(robot, position, quaternion, hips, knees, wheels),
    )


def place_planar(robot: Robot, trunk: Floats, q: Floats, rolled: Floats) -> Bodies:
    """Parts for planar states: trunk (n, 3) = x, z, pitch; joints (n, 4); see `lift`."""
    return place(robot, *lift(robot, trunk, q, rolled))


def lift(robot: Robot, trunk: Floats, q: Floats, rolled: Floats) -> tuple[Floats, Floats, Floats]:
    """Planar states as base positions (n, 3), quaternions (n, 4) and 12 joints.

    Args:
        robot: Gives the wheel radius.
        trunk: (n, 3) x, z [m] and pitch [rad].
        q: (n, 4) planar joints [rad].
        rolled: (n, 2) arc length rolled by the front and the rear wheels [m].
    """
    n = len(trunk)
    position = np.column_stack([trunk[:, 0], np.zeros(n), trunk[:, 1]])
    joints = np.empty((n, 4, 3))
    for leg in range(4):
        pair = leg // 2
        thigh, calf = q[:, 2 * pair], q[:, 2 * pair + 1]
        joints[:, leg, 0], joints[:, leg, 1] = thigh, calf
        # Rolling without slip sets the absolute turn; the joint's is what the leg leaves of it.
        joints[:, leg, 2] = rolled[:, pair] / robot.wheel.radius - trunk[:, 2] - thigh - calf
    return position, quaternion_y(trunk[:, 2]), joints.reshape(n, 12)


def hip_offsets(robot: Robot) -> Floats:
    """Hip axes (4, 3) in the trunk frame [m]: FL, FR, RL, RR."""
    (fx, fz), (rx, rz), y = robot.hips.front, robot.hips.rear, robot.hips.half_track
    return np.array([(fx, y, fz), (fx, -y, fz), (rx, y, rz), (rx, -y, rz)])


def _com(
    robot: Robot, trunk: Floats, base: Floats, hips: Floats, thigh: Floats, knees: Floats,
    calf: Floats, wheels: Floats,
) -> Floats:  # fmt: skip
    body = robot.body
    total = body.mass * (trunk + turn(base, np.array(body.com)))
    for leg in range(4):
        own = robot.legs[leg // 2]
        for link, joint, turned in ((own.thigh, hips, thigh), (own.calf, knees, calf)):
            x, z = link.com
            total = total + link.mass * (joint[:, leg] + turn(turned[:, leg], np.array([x, 0, z])))
        total = total + own.wheel.mass * wheels[:, leg]
    com: Floats = total / robot.mass
    return com


def _points(
    robot: Robot, trunk: Floats, base: Floats, hips: Floats, knees: Floats, wheels: Floats
) -> Floats:
    layout = robot.points
    length, width, height = robot.trunk.size
    flat = np.array([(x * length, 0.0, z * height) for x, z in layout.trunk])
    on_thigh, on_calf = np.array(layout.thigh)[:, None], np.array(layout.calf)[:, None]
    parts = []
    for side, legs in ((-1.0, (1, 3)), (1.0, (0, 2))):
        offset = flat + np.array([0.0, side * width / 2, 0.0])
        parts.append(trunk[:, None, :] + turn(base[:, None, :], offset[None]))
        for leg in legs:
            hip, knee, wheel = (p[:, leg, None, :] for p in (hips, knees, wheels))
            parts.append(hip + on_thigh * (knee - hip))
            parts.append(knee + on_calf * (wheel - knee))
    return np.concatenate(parts, axis=1)
