"""Forces that the motors can give.

The balance QP (eqs 11-12) knows friction alone. Where motors have little to spare it asks for
forces that they do not have, most often to press wheels on opposite faces against each other for a
small horizontal force or moment; what the motors then lack is the weight. Torques beyond limits
cost far more than the wrench here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.robot.description import Robot

from . import balance
from .measurement import Measurement

_FIRM = 20.0  # times the weight of a force: of a force beyond what a motor can give
_ROUNDS = 4  # in which motors are found that the forces before overload


@dataclass(frozen=True)
class MotorTorques:
    """Torques (12,) [Nm] of thigh, calf and wheel of each leg, as the wheels' forces make them.

    Attributes:
        slopes: (12, 8) per N of the wheels' tangential and normal forces [m].
        rest: (12,) of the legs' weight and inertia.
    """

    slopes: Floats
    rest: Floats

    @classmethod
    def of(
        cls, state: Measurement, frames: Floats, points: Floats, reach: Floats, rest: Floats
    ) -> Self:
        """For forces at `points` (4, 2) in contact `frames` (4, 2, 2), `reach` (4,) below centres.

        In a corner (`reach` 0) both faces carry, and the wheel's motor is not looked at.
        """
        slopes = np.zeros((4, 3, 4, 2))
        wheels = np.arange(4)
        for axis in (0, 1):
            legs = balance.force_torques(state, points, frames[:, :, axis])
            slopes[wheels, :2, wheels, axis] = legs
        slopes[wheels, 2, wheels, 0] = reach
        return cls(slopes.reshape(12, 8), rest.ravel())

    def at(self, forces: Floats) -> Floats:
        """(4, 3) of the wheels' forces (8,)."""
        torques: Floats = (self.slopes @ forces + self.rest).reshape(4, 3)
        return torques


def solve_within_motors(
    solve: Callable[[Floats, Floats], Floats], H: Floats, g: Floats, motors: MotorTorques,
    robot: Robot, joint_rates: Floats, force_weight: float,
) -> Floats:  # fmt: skip
    """The minimiser F (8,) that `solve` gives for a Hessian and a gradient, or where it overloads
    motors at `joint_rates` (12,) [rad/s], that with the cost of it.
    """
    forces = solve(H, g)
    H, g = H.copy(), g.copy()
    limited = np.zeros(12, np.bool_)
    for _ in range(_ROUNDS):
        asked = motors.at(forces).ravel()
        given = _core.limit_torques(robot.native, joint_rates, asked)
        more = (given != asked) & ~limited & motors.slopes.any(axis=1)
        if not more.any():
            break
        limited |= more
        for slope, rest, torque in zip(
            motors.slopes[more], motors.rest[more], given[more], strict=True
        ):
            weight = _FIRM * force_weight / (slope @ slope)
            H += weight * np.outer(slope, slope)
            g += weight * slope * (rest - torque)
        forces = solve(H, g)
    return forces
