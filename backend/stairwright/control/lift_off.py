"""Whether the robot tips: a pair of wheels hangs above the ground, and the trunk leans that way.

On its other pair alone the robot is an inverted pendulum on wheels. What rights it is a force along
the ground towards the side that it falls to, so its place must give way, that pair must roll
freely, and the plan must not go on meanwhile.
"""

from __future__ import annotations

import numpy as np

from stairwright.arrays import Floats
from stairwright.terrain.wheel_path import WheelPath

from .measurement import Measurement
from .setpoint import Setpoint

TOUCHES, LIFTED = 0.004, 0.010  # m above the ground
NEAR, FAR = 0.10, 0.15  # m that the other pair may roll for that, else it would run away
FRONT, REAR = 0, 1


def lifting_pair(state: Measurement, pitch: float) -> int:
    """The pair that lifts off if any does: the front one where the nose is too high."""
    return FRONT if state.pitch < pitch else REAR


def lift_off(state: Measurement, path: WheelPath, places: Floats, target: Setpoint) -> float:
    """How far that pair has lifted off: from 0 (not at all) to 1.

    `places` (4,) of the wheels on the wheel-centre curve [m].
    """
    pair = lifting_pair(state, target.pitch)
    mine, others = (slice(2 * one, 2 * one + 2) for one in (pair, 1 - pair))
    off = state.wheels[mine] - path.centres(places[mine])
    above = float(np.mean(np.sum(off * path.normals(places[mine]), axis=1)))
    rolled = abs(float(places[others].mean() - target.wheel_progress[1 - pair]))
    lifted = min(max((above - TOUCHES) / (LIFTED - TOUCHES), 0.0), 1.0)
    return lifted * min(max((FAR - rolled) / (FAR - NEAR), 0.0), 1.0)
