"""Forward kinematics in CasADi, for optimisation; `kinematics.py` is the same in numpy.

Points are pairs (x, z) of CasADi scalars. The dimensions come in as a vector, so that one compiled
problem serves every robot.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from stairwright.arrays import Floats

from .description import Robot

Scalar = Any  # a CasADi SX or MX scalar, or a float
Point = tuple[Scalar, Scalar]

DIMENSIONS = (
    "hip_front_x",
    "hip_front_z",
    "hip_rear_x",
    "hip_rear_z",
    "half_length",
    "half_height",
    "front_thigh",
    "rear_thigh",
    "front_calf",
    "rear_calf",
    "front_thigh_radius",
    "rear_thigh_radius",
    "front_calf_radius",
    "rear_calf_radius",
    "wheel_radius",
)


def dimensions(robot: Robot) -> Floats:
    """The numbers (15,) that `Shape.from_vector` unpacks, in the order of `DIMENSIONS` [m].

    The trunk is its box here and links are capsules from joint to joint, as thick as their
    thickest; what the robot really is, the certificate looks at.
    """
    front, rear = robot.legs
    length, _, height = robot.trunk.size
    return np.array([
        *front.hip, *rear.hip, length / 2, height / 2,
        front.thigh.length, rear.thigh.length, front.calf.length, rear.calf.length,
        front.thigh.radius, rear.thigh.radius, front.calf.radius, rear.calf.radius,
        robot.wheel.radius,
    ])  # fmt: skip


@dataclass(frozen=True)
class Shape:
    """Dimensions as CasADi scalars [m]; pairs are front, rear."""

    hips: tuple[Point, Point]
    half_length: Scalar
    half_height: Scalar
    thigh: tuple[Scalar, Scalar]
    calf: tuple[Scalar, Scalar]
    thigh_radius: tuple[Scalar, Scalar]
    calf_radius: tuple[Scalar, Scalar]
    wheel_radius: Scalar

    @classmethod
    def from_vector(cls, values: Any) -> Shape:
        """Unpack a vector made by `dimensions`."""
        v = [values[i] for i in range(len(DIMENSIONS))]
        hips, thigh, calf, thick, thin = (
            ((v[0], v[1]), (v[2], v[3])),
            v[6:8],
            v[8:10],
            v[10:12],
            v[12:14],
        )
        return cls(hips, v[4], v[5], tuple(thigh), tuple(calf), tuple(thick), tuple(thin), v[14])


@dataclass(frozen=True)
class Skeleton:
    """Points of one pose in the world [m]; pairs are front, rear."""

    trunk: Point
    pitch: Scalar
    hips: tuple[Point, Point]
    knees: tuple[Point, Point]
    wheels: tuple[Point, Point]


def to_world(trunk: Point, pitch: Scalar, offset: Point) -> Point:
    """A point of the trunk frame in the world."""
    c, s = ca.cos(pitch), ca.sin(pitch)
    return trunk[0] + c * offset[0] + s * offset[1], trunk[1] - s * offset[0] + c * offset[1]


def forward(shape: Shape, x_c: Scalar, z_c: Scalar, pitch: Scalar, q: Any) -> Skeleton:
    """Hips, knees and wheel centres; the trunk at (x_c, z_c, pitch), planar joints `q` (4)."""
    trunk = (x_c, z_c)
    hips, knees, wheels = [], [], []
    for leg in range(2):
        hip = to_world(trunk, pitch, shape.hips[leg])
        thigh = pitch + q[2 * leg]
        calf = thigh + q[2 * leg + 1]
        upper, lower = shape.thigh[leg], shape.calf[leg]
        knee = (hip[0] - upper * ca.sin(thigh), hip[1] - upper * ca.cos(thigh))
        wheel = (knee[0] - lower * ca.sin(calf), knee[1] - lower * ca.cos(calf))
        hips.append(hip)
        knees.append(knee)
        wheels.append(wheel)
    return Skeleton(trunk, pitch, (hips[0], hips[1]), (knees[0], knees[1]), (wheels[0], wheels[1]))


def between(a: Point, b: Point, share: float) -> Point:
    """The point at `share` of the way from `a` to `b`."""
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
