"""One control step, compiled: advance the plan, control, limit the motors, keep the score."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.control.compiled import contact_control
from stairwright.control.setpoint import JOINTS, PITCH

from .actuators import limit_torques
from .governor import advance

Floats = NDArray[np.float64]

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


@leaf
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


@nb.njit(cache=True)
def tick(
    record: NDArray[np.void],
    pieces: Floats,
    corners: Floats,
    start: float,
    step: float,
    rows: Floats,
    speeds: Floats,
    leash: float,
    moving: bool,
    dt: float,
    qpos: Floats,
    qvel: Floats,
    sensed_qpos: Floats,
    sensed_qvel: Floats,
    clock: Floats,
    places: Floats,
    forces: Floats,
    learnt: Floats,
    target: Floats,
    wanted: Floats,
    ctrl: Floats,
    score: Floats,
    contacts: Floats,
) -> int:
    """Write the motors' torques into `ctrl`; returns how many contacts the wheels have.

    `qpos` and `qvel` are the truth (motor speeds, score); the controller sees `sensed_*`.
    """
    advance(start, step, rows, speeds, leash, places, moving, dt, clock, target)
    contact_control(
        record,
        pieces,
        corners,
        sensed_qpos,
        sensed_qvel,
        target,
        0.0,
        places,
        forces,
        learnt,
        wanted,
    )
    limit_torques(record, qvel[6:], wanted, ctrl)
    keep_score(qpos, qvel, ctrl, target, dt, score)
    return int(contacts[0] + contacts[4] + contacts[8] + contacts[12])
