"""Motors: peak torque at standstill that falls linearly to zero at the no-load speed."""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

Floats = NDArray[np.float64]


@nb.njit(cache=True)
def available(torque: float, speed: float, peak: float, no_load: float) -> float:
    """The part of `torque` [Nm] that a motor can give while it turns at `speed` [rad/s].

    Only torque in the direction of motion is limited by speed; braking has the full peak.
    """
    limit = peak
    if torque * speed > 0.0:
        limit = peak * max(0.0, 1.0 - abs(speed) / no_load)
    return min(max(torque, -limit), limit)


@leaf
def limit_torques(
    record: NDArray[np.void], joint_rates: Floats, torques: Floats, out: Floats
) -> None:
    """Write into `out` (12,) what the motors give of `torques` (12,); see `compiled.parameters`."""
    p = record[0]
    for leg in range(4):
        for part in range(3):
            j = 3 * leg + part
            peak, no_load = p.leg_torque, p.leg_speed
            if part == 2:
                peak, no_load = p.wheel_torque, p.wheel_speed
            out[j] = available(torques[j], joint_rates[j], peak, no_load)
