"""When each pose is reached, from the mean wheel speed (eqs 25 and 26)."""

from __future__ import annotations

import numpy as np

from stairwright.arrays import Floats


def pose_times(wheel_progress: Floats, speed: float) -> Floats:
    """Times (n,) of poses whose wheels are at `wheel_progress` (n, 2) [m], from 0 [s].

    Eqs 25 and 26 divide the front wheel's way by the wheel speed: to the face Δx - R, over it
    h / sin(gamma) + R. Poses are placed by the same two lengths, so their front wheel's way along
    the wheel-centre curve is that way. From the last pose to the standing one at the end the rear
    wheels may have the longer way; the longer one counts.
    """
    step = np.diff(wheel_progress, axis=0).max(axis=1)
    return np.concatenate([[0.0], np.cumsum(np.maximum(step, 1e-6))]) / speed
