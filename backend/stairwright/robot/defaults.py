"""What a robot's document may leave out: gains and collision points that suit it."""

from __future__ import annotations

from collections.abc import Sequence

from .legs import Leg
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
_STABLE = 0.25  # of the damping at which a free wheel would swing from step to step
_BOX = [(x, -0.5) for x in (-0.5, -0.25, 0.0, 0.25, 0.5)] + [
    (-0.5, 0.5), (0.5, 0.5), (-0.5, 0.0), (0.5, 0.0),
]  # fmt: skip


def suitable_gains(robot_mass: float, legs: Sequence[Leg]) -> Gains:
    """Gains that turn joints and wheels as far for their share of the robot's weight.

    Stiffness grows with weight times leg length, damping with that and the time in which the robot
    tips (the root of the length), the wheels' damping with mass times radius squared: as far as a
    wheel in the air allows.
    """
    mass = robot_mass / _MASS
    length = min(leg.reach for leg in legs) / _LEG
    leg = legs[0]
    free = (leg.wheel.inertia[1] + leg.wheel_motor.armature) / _PERIOD
    wheel = _TUNED.wheel_damping * mass * (leg.wheel.radius / _RADIUS) ** 2
    return Gains(
        joint_stiffness=min(_TUNED.joint_stiffness * mass * length, MOST_STIFFNESS),
        joint_damping=min(_TUNED.joint_damping * mass * length**1.5, MOST_DAMPING),
        wheel_damping=min(wheel, _STABLE * free, MOST_WHEEL_DAMPING),
    )


def standard_points(trunk: Trunk) -> CollisionPoints:
    """The paper's 25 points, and the corners of a trunk that is more than its box."""
    length, _, height = trunk.size
    corners = [(x / length, z / height) for piece in trunk.outline for x, z in piece.points]
    beyond = [point for point in corners if max(map(abs, point)) > 0.5 + 1e-9]
    return CollisionPoints(
        trunk=_BOX + beyond, thigh=[0.25, 0.5, 0.75, 1.0], calf=[0.2, 0.4, 0.6, 0.8]
    )
