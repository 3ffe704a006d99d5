"""Whether the robot tips: a pair of wheels hangs above the ground, and the trunk leans that way.

On its other pair alone the robot is an inverted pendulum on wheels. What rights it is a force along
the ground towards the side that it falls to, so its place must give way, and the plan must not go
on meanwhile.
"""

from __future__ import annotations

import numpy as np

from stairwright.arrays import Floats
from stairwright.terrain.wheel_path import WheelPath

from .measurement import Measurement

TOUCHES, LIFTED = 0.004, 0.010  # m above the ground
FRONT, REAR = 0, 1


def lift_off(state: Measurement, path: WheelPath, places: Floats, pitch: float) -> float:
    """How far a pair has lifted off: from 0 (not at all) to 1.

    `places` (4,) of the wheels on the wheel-centre curve [m]; `pitch` as it is to be [rad].
    """
    # Nose up, or down: the pair at the other end lifts nothing off.
    pair = FRONT if state.pitch < pitch else REAR
    mine = slice(2 * pair, 2 * pair + 2)
    off = state.wheels[mine] - path.centres(places[mine])
    above = float(np.mean(np.sum(off * path.normals(places[mine]), axis=1)))
    return min(max((above - TOUCHES) / (LIFTED - TOUCHES), 0.0), 1.0)
