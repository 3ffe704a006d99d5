"""Closed-form kinematics of the robot in the x-z plane (numpy, any batch shape).

A leg at absolute angle `a` points along (-sin a, -cos a): down at zero, and a positive angle (about
+y) swings it backward. Absolute thigh angle = pitch + thigh joint; absolute calf angle adds the
calf joint.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats

from .description import Robot
from .legs import LinkForm


@dataclass(frozen=True)
class Frames:
    """Points of one or many poses in the world [m]; each array is (..., 2, 2): front/rear, x/z."""

    hips: Floats
    knees: Floats
    wheels: Floats


def along(angle: Floats) -> Floats:
    """Unit vector (..., 2) of a link at absolute `angle` (...)."""
    return _vectors(-np.sin(angle), -np.cos(angle))


def _vectors(x: Floats, z: Floats) -> Floats:
    """(x, z) vectors (..., 2) of coordinates (...), in half of the time of `np.stack`."""
    out = np.empty((*np.shape(x), 2))
    out[..., 0], out[..., 1] = x, z
    return out


def rotate(pitch: Floats, vector: Floats) -> Floats:
    """Turn (x, z) vectors (..., 2) of the trunk frame by `pitch` (...) about +y."""
    c, s = np.cos(pitch), np.sin(pitch)
    x, z = vector[..., 0], vector[..., 1]
    return _vectors(c * x + s * z, -s * x + c * z)


def lengths(robot: Robot) -> tuple[Floats, Floats]:
    """Lengths (2,) of the thighs and of the calves, front and rear [m]."""
    legs = robot.legs
    return np.array([leg.thigh.length for leg in legs]), np.array([leg.calf.length for leg in legs])


def hips(robot: Robot, x_c: Floats, z_c: Floats, pitch: Floats) -> Floats:
    """Hip axes (..., 2, 2) in the world [m]."""
    trunk = _vectors(np.asarray(x_c, float), np.asarray(z_c, float))
    offsets = np.array([robot.hips.front, robot.hips.rear])
    return trunk[..., None, :] + rotate(np.asarray(pitch)[..., None], offsets)


def forward(robot: Robot, x_c: Floats, z_c: Floats, pitch: Floats, q: Floats) -> Frames:
    """Hips, knees and wheel centres of poses: trunk (...) and planar joints `q` (..., 4)."""
    q = np.asarray(q, float)
    hip = hips(robot, x_c, z_c, pitch)
    thigh = np.asarray(pitch)[..., None] + q[..., 0::2]
    upper, lower = lengths(robot)
    knee = hip + upper[:, None] * along(thigh)
    wheel = knee + lower[:, None] * along(thigh + q[..., 1::2])
    return Frames(hip, knee, wheel)


def inverse(robot: Robot, x_c: Floats, z_c: Floats, pitch: Floats, wheels: Floats) -> Floats:
    """Planar joints (..., 4) that put the wheel centres at `wheels` (..., 2, 2).

    The knee bends the way its limits say; the thigh angle is the representative nearest to the
    middle of its range. NaN where a wheel is out of reach. Limits are not applied.
    """
    leg = np.asarray(wheels, float) - hips(robot, x_c, z_c, pitch)
    l1, l2 = lengths(robot)
    square = np.sum(leg**2, axis=-1)
    cosine = (square - l1 * l1 - l2 * l2) / (2 * l1 * l2)
    knee = np.array([leg.knee for leg in robot.legs])
    with np.errstate(invalid="ignore"):
        calf = knee * np.arccos(np.where(np.abs(cosine) <= 1.0, cosine, np.nan))
    bearing = np.arctan2(-leg[..., 0], -leg[..., 1])
    thigh = bearing - np.arctan2(l2 * np.sin(calf), l1 + l2 * np.cos(calf))
    middle = np.array([np.mean(robot.joints.front.thigh), np.mean(robot.joints.rear.thigh)])
    thigh = thigh - np.asarray(pitch)[..., None] - middle
    thigh = middle + (thigh + math.pi) % (2 * math.pi) - math.pi
    return np.stack([thigh, calf], axis=-1).reshape(*thigh.shape[:-1], 4)


def com(robot: Robot, x_c: Floats, z_c: Floats, pitch: Floats, frames: Frames) -> Floats:
    """Centre of mass (..., 2) of the whole robot in the world [m]."""
    body = robot.body
    turn = np.asarray(pitch)
    place = _vectors(np.asarray(x_c, float), np.asarray(z_c, float))
    total = body.mass * (place + rotate(turn, np.array([body.com[0], body.com[2]])))
    for k, leg in enumerate(robot.legs):
        hip, knee, wheel = (p[..., k, :] for p in (frames.hips, frames.knees, frames.wheels))
        total = total + 2 * (
            leg.thigh.mass * link_com(leg.thigh, hip, knee)
            + leg.calf.mass * link_com(leg.calf, knee, wheel)
            + leg.wheel.mass * wheel
        )
    centre: Floats = total / robot.mass
    return centre


def link_com(link: LinkForm, upper: Floats, lower: Floats) -> Floats:
    """Mass centre (..., 2) of a link between its joints (..., 2) [m]."""
    along, across = link.com_along
    d = lower - upper
    centre: Floats = upper + along * d
    return centre if across == 0.0 else centre + across * _vectors(-d[..., 1], d[..., 0])


def collision_points(robot: Robot, x_c: Floats, z_c: Floats, pitch: Floats, q: Floats) -> Floats:
    """The collision points (..., n, 2): trunk, front thigh, front calf, rear thigh, rear calf."""
    layout = robot.points
    frames = forward(robot, x_c, z_c, pitch, q)
    trunk = np.stack([np.asarray(x_c, float), np.asarray(z_c, float)], axis=-1)
    size = np.array([robot.trunk.size[0], robot.trunk.size[2]])
    parts = [
        trunk[..., None, :]
        + rotate(np.asarray(pitch)[..., None], np.asarray(layout.trunk, float) * size)
    ]
    for leg in range(2):
        hip, knee, wheel = (
            f[..., leg, None, :] for f in (frames.hips, frames.knees, frames.wheels)
        )
        parts.append(hip + np.asarray(layout.thigh, float)[:, None] * (knee - hip))
        parts.append(knee + np.asarray(layout.calf, float)[:, None] * (wheel - knee))
    return np.concatenate(parts, axis=-2)


def standing_joints(robot: Robot) -> Floats:
    """Planar joints (4,) of the nominal pose: wheels below the hips, trunk level."""
    offsets = np.array([robot.hips.front, robot.hips.rear])
    ground = robot.wheel.radius - robot.nominal_height
    wheels = np.stack([offsets[:, 0], np.full(2, ground)], axis=-1)
    zero = np.zeros(())
    return inverse(robot, zero, zero, zero, wheels)


def all_joints(legs: Floats, wheels: Floats | None = None) -> Floats:
    """Positions or rates (..., 12) of the joints of FL, FR, RL, RR.

    Args:
        legs: (..., 4) planar joints: thigh and calf, front and rear.
        wheels: (..., 2) of both pairs; by default at 0.
    """
    turned = np.zeros((*legs.shape[:-1], 2)) if wheels is None else wheels
    front = np.concatenate([legs[..., :2], turned[..., :1]], axis=-1)
    rear = np.concatenate([legs[..., 2:], turned[..., 1:]], axis=-1)
    return np.concatenate([front, front, rear, rear], axis=-1)


def limits(robot: Robot) -> Floats:
    """Limits (4, 2) of the planar joints [rad]."""
    front, rear = robot.joints.front, robot.joints.rear
    return np.array([front.thigh, front.calf, rear.thigh, rear.calf])
