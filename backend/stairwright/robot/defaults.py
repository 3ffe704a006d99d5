"""What a robot's document may leave out: gains and collision points that suit it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .legs import Leg, LinkForm
from .parts import (
    MOST_DAMPING,
    MOST_STIFFNESS,
    MOST_WHEEL_DAMPING,
    CollisionPoints,
    Gains,
    Trunk,
)

# Of the robot that the gains were tuned on: mass [kg], length of a leg [m], its gains.
_MASS, _LEG, _RADIUS = 11.84, 0.4, 0.05
_TUNED = Gains(joint_stiffness=40.0, joint_damping=1.2, wheel_damping=0.6)
_PERIOD = 0.002  # s, of the controller
# Of the damping at which a wheel or a leg in the air would swing from step to step.
_STABLE_WHEEL, _STABLE_LEG = 0.25, 0.6
_BOX = [(x, -0.5) for x in (-0.5, -0.25, 0.0, 0.25, 0.5)] + [
    (-0.5, 0.5), (0.5, 0.5), (-0.5, 0.0), (0.5, 0.0),
]  # fmt: skip


def suitable_gains(robot_mass: float, legs: Sequence[Leg]) -> Gains:
    """Gains that turn joints and wheels as far for their share of the robot's weight.

    Stiffness grows with weight times leg length, damping with that and the time in which the robot
    tips (the root of the length), the wheels' damping with mass times radius squared: as far as
    wheels and legs in the air allow.
    """
    mass = robot_mass / _MASS
    length = min(leg.reach for leg in legs) / _LEG
    leg = legs[0]
    free = (leg.wheel.inertia[1] + leg.wheel_motor.armature) / _PERIOD
    wheel = _TUNED.wheel_damping * mass * (leg.wheel.radius / _RADIUS) ** 2
    swinging = min(map(_least_inertia, legs)) / _PERIOD
    joint = _TUNED.joint_damping * mass * length**1.5
    return Gains(
        joint_stiffness=min(_TUNED.joint_stiffness * mass * length, MOST_STIFFNESS),
        joint_damping=min(joint, _STABLE_LEG * swinging, MOST_DAMPING),
        wheel_damping=min(wheel, _STABLE_WHEEL * free, MOST_WHEEL_DAMPING),
    )


def _least_inertia(leg: Leg) -> float:
    """Least inertia that hip and knee of a leg in the air show together [kg m^2].

    It is least where the leg is as straight as its range allows.
    """
    thigh, calf, wheel = leg.thigh, leg.calf, leg.wheel.mass
    bend = 0.0 if leg.limits.straightens else leg.knee * min(map(abs, leg.limits.calf))
    shank = _inertia(calf) + wheel * calf.length**2
    along, across = wheel * calf.length - calf.mass * calf.com[1], calf.mass * calf.com[0]
    cross = thigh.length * (along * math.cos(bend) + across * math.sin(bend))
    whole = _inertia(thigh) + (calf.mass + wheel) * thigh.length**2 + shank + 2.0 * cross
    rotors = np.diag([leg.thigh_motor.armature, leg.calf_motor.armature])
    inertia = np.array([[whole, shank + cross], [shank + cross, shank]]) + rotors
    return float(np.linalg.eigvalsh(inertia)[0])


def _inertia(link: LinkForm) -> float:
    """About its upper joint [kg m^2]."""
    return link.inertia[1] + link.mass * (link.com[0] ** 2 + link.com[1] ** 2)


def standard_points(trunk: Trunk) -> CollisionPoints:
    """The paper's 25 points, and the corners of a trunk that is more than its box."""
    length, _, height = trunk.size
    corners = [(x / length, z / height) for piece in trunk.outline for x, z in piece.points]
    beyond = [point for point in corners if max(map(abs, point)) > 0.5 + 1e-9]
    return CollisionPoints(
        trunk=_BOX + beyond, thigh=[0.25, 0.5, 0.75, 1.0], calf=[0.2, 0.4, 0.6, 0.8]
    )
