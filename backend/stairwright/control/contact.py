"""Which place and which face of the terrain each wheel is on.

A wheel's place is the arc length of the nearest point of the wheel-centre curve. At a concave
corner the curve has a kink and the wheel touches two faces: projection alone keeps pushing on the
face that the wheel comes from and the robot waits there for ever. So, while the plan is already
past a corner that the wheel has not passed (or the other way round), the *planned* face counts.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.terrain.wheel_path import curve_at, project

Floats = NDArray[np.float64]

WINDOW = 0.15  # m; a wheel is looked for this far from where it was
CORNER_REACH = 0.04  # m; how far from a corner the planned face may count
_BESIDE = 1e-6  # m


@nb.njit(cache=True)
def locate(pieces: Floats, radius: float, x: float, z: float, near: float) -> float:
    """Arc length of the wheel centre (x, z), near where it was; anywhere if `near` is NaN."""
    if math.isnan(near):
        return project(pieces, radius, x, z, 0.0, pieces[-1, 1] + pieces[-1, 2])
    return project(pieces, radius, x, z, max(0.0, near - WINDOW), near + WINDOW)


@nb.njit(cache=True)
def face_normal(
    pieces: Floats, radius: float, corners: Floats, measured: float, planned: float
) -> tuple[float, float]:
    """Unit normal (x, z) of the face that the wheel at `measured` shall push on."""
    at = measured
    if abs(planned - measured) < CORNER_REACH:
        low, high = min(planned, measured), max(planned, measured)
        for corner in corners:
            if low <= corner < high:
                at = corner + _BESIDE if planned > measured else corner - _BESIDE
    _, _, nx, nz = curve_at(pieces, radius, at)
    return nx, nz
