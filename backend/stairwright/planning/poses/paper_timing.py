"""When each pose is reached, from the mean wheel speed (eqs 25 and 26)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def time_to_face(distance: float, radius: float, speed: float) -> float:
    """Eq 25: time until the front wheel touches a face `distance` ahead of its centre [s].

    Args:
        distance: From wheel centre to face, along x [m].
        radius: Of the wheel [m].
        speed: Mean wheel speed R * qdot [m/s].
    """
    return (distance - radius) / speed


def time_over_face(face: float, radius: float, speed: float) -> float:
    """Eq 26: time from there until the wheel has passed a face of length h / sin(gamma) [s]."""
    return (face + radius) / speed


def pose_times(wheel_progress: Floats, speed: float) -> Floats:
    """Times (n,) of poses whose wheels are at `wheel_progress` (n, 2) [m], from 0 [s].

    Eqs 25 and 26 divide the front wheel's way by the wheel speed: to the face Δx - R, over it
    h / sin(gamma) + R. Poses are placed by the same two lengths, so their front wheel's way along
    the wheel-centre curve is that way. From the last pose to the standing one at the end the rear
    wheels may have the longer way; the longer one counts.
    """
    step = np.diff(wheel_progress, axis=0).max(axis=1)
    return np.concatenate([[0.0], np.cumsum(np.maximum(step, 1e-6))]) / speed
