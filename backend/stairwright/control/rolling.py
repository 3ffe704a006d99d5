"""Rolling control: wheel torque from speed, and yaw from the difference of sides (eqs 14-16)."""

from __future__ import annotations

import numpy as np

from stairwright.arrays import Floats

SIDES = np.array([-1.0, 1.0, -1.0, 1.0])  # left wheels turn slower for a positive yaw rate


def wheel_rates(speeds: Floats, radius: float) -> Floats:
    """(4,) wheel rates [rad/s] for centre `speeds` [m/s] along the terrain (eq 15)."""
    rates: Floats = np.asarray(speeds) / radius
    return rates


def yaw_difference(damping: float, desired: float, measured: float, scale: float) -> Floats:
    """(4,) change of the wheel rates [rad/s] that turns the robot (eq 16).

    Args:
        damping: K_d of eq 16, in units of `scale`.
        desired: Yaw rate [rad/s].
        measured: Yaw rate [rad/s].
        scale: Half track per wheel radius: the rate difference that turns without slip.
    """
    return SIDES * (scale * (desired + damping * (desired - measured)))


def wheel_torques(damping: float | Floats, desired: Floats, measured: Floats) -> Floats:
    """(4,) ``K_d,wheel (qdot_des - qdot)`` (eq 14) [Nm]."""
    torques: Floats = damping * (desired - measured)
    return torques
