"""What a rollout is judged by, added up over its control steps; and whether it has diverged."""

from __future__ import annotations

import math

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.control.setpoint import JOINTS, PITCH

_Q, _PITCH = JOINTS.start, PITCH

# Places in the score, a (9,) array.
(
    PITCH_MAX,
    PITCH_SQUARES,
    JOINT_SQUARES,
    LEG_TORQUE,
    WHEEL_TORQUE,
    ENERGY,
    STEPS,
    LAST_PITCH_ERROR,
    TILT,
) = range(9)
SCORES = 9
BEYOND = 1e6  # m, m/s, rad or rad/s, summed up: no robot gets there


def keep_score(
    qpos: Floats, qvel: Floats, torques: Floats, target: Floats, dt: float, score: Floats
) -> None:
    """Add the true state of one control step to the `score`."""
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    r22 = 1 - 2 * (x * x + y * y)
    pitch = math.atan2(2 * (x * z + w * y), r22)
    error = pitch - target[_PITCH]
    error -= 2 * math.pi * math.floor((error + math.pi) / (2 * math.pi))
    score[LAST_PITCH_ERROR] = error
    # Lateral axis against the horizontal: roll, whatever the pitch.
    score[TILT] = abs(math.asin(min(1.0, max(-1.0, 2 * (y * z + w * x)))))
    score[PITCH_MAX] = max(score[PITCH_MAX], abs(error))
    score[PITCH_SQUARES] += error * error
    score[STEPS] += 1.0
    for leg in range(4):
        for part in range(3):
            j = 3 * leg + part
            score[ENERGY] += abs(torques[j] * qvel[6 + j]) * dt
            if part == 2:
                score[WHEEL_TORQUE] = max(score[WHEEL_TORQUE], abs(torques[j]))
            else:
                score[LEG_TORQUE] = max(score[LEG_TORQUE], abs(torques[j]))
                off = qpos[7 + j] - target[_Q + 2 * (leg // 2) + part]
                score[JOINT_SQUARES] += off * off


def numbers(native: _core.Score) -> tuple[float, ...]:
    """The native loop's score in the order of this module's."""
    return (
        native.pitch_error_max,
        native.pitch_error_squares,
        native.joint_error_squares,
        native.leg_torque_max,
        native.wheel_torque_max,
        native.energy,
        native.steps,
        native.pitch_error,
        native.tilt,
    )


def diverged(qpos: Floats, qvel: Floats) -> bool:
    """Whether the state is not one to compute anything from: not finite, or beyond all reason."""
    return not bool(np.abs(qpos).sum() + np.abs(qvel).sum() < BEYOND)
