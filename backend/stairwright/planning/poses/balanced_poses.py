"""Where the centre of mass passes between critical poses so that the ground holds the robot."""

from __future__ import annotations

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.terrain.wheel_path import WheelPath

ROOM = 0.03  # m of CoM margin wanted on the way
EASE = 0.06  # m of progress over which the CoM moves aside before and after it must


def com_ways(path: WheelPath, friction: float, wheels: Floats, spare: float) -> Floats:
    """Least and largest x (n, 2) of the CoM with room to spare [m]; infinite where nothing holds.

    Args:
        path: The wheel-centre curve.
        friction: Between wheels and terrain.
        wheels: (n, 2) arc lengths of front and rear wheels.
        spare: Room wanted, or half of what there is [m].
    """
    a, b = _core.com_intervals(path.native, wheels, friction).T
    held = a <= b
    room = np.minimum(spare, np.where(held, b - a, 0.0) / 2)
    # Where no CoM is held at all (both wheels on one wall), moving it is of no use.
    return np.stack([np.where(held, a + room, -np.inf), np.where(held, b - room, np.inf)], axis=1)


def eased_shift(progress: Floats, com: Floats, low: Floats, high: Floats) -> Floats:
    """Smooth shift (n,) of `com` that brings it between `low` and `high` wherever it can [m].

    What is missing is spread to `EASE` before and behind, then averaged over the same window, so
    the shift is nowhere smaller than what is missing, unless both sides ask. It
    is zero at both ends, where the poses are known.
    """
    ahead = _eased(progress, np.maximum(low - com, 0.0))
    back = _eased(progress, np.maximum(com - high, 0.0))
    shift: Floats = np.clip(ahead - back, low - com, high - com)
    shift[[0, -1]] = 0.0
    return shift


def _eased(progress: Floats, missing: Floats) -> Floats:
    first = np.searchsorted(progress, progress - EASE)
    last = np.searchsorted(progress, progress + EASE, side="right")
    windows = np.stack([first, last], axis=1).ravel()
    most = np.maximum.reduceat(np.append(missing, 0.0), windows)[::2]
    mean: Floats = np.add.reduceat(np.append(most, 0.0), windows)[::2] / (last - first)
    return mean
