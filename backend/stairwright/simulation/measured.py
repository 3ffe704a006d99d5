"""The numbers that a rollout is told by."""

from __future__ import annotations

import math

import numpy as np

from stairwright._core import GRAVITY
from stairwright.arrays import Floats
from stairwright.robot.description import Robot

from . import score
from .outcome import Ending, LinkLoads
from .result import Metrics, Series

SETTLE = 0.4  # s at rest before the plan starts and after it ends
_HUGE = 1e6  # stands for what is not finite, or overflowed on the way there


def measured(
    ending: Ending,
    loads: LinkLoads,
    scores: Floats,
    robot: Robot,
    series: Series,
    wall: float,
    dt: float,
    speed_stairs: float | None,
) -> Metrics:
    """What is made of the sums of a rollout.

    Args:
        ending: How it ended.
        loads: Of trunk and links.
        scores: (SCORES,) sums over control steps, see `score`.
        robot: Whose mass and motors count.
        series: What happened, sample by sample.
        wall: Time that it took to compute [s].
        dt: Time of a control step [s].
        speed_stairs: See `crossing.speed_over_faces` [m/s].
    """
    # A diverged run still has a document.
    s = np.nan_to_num(scores, posinf=_HUGE, neginf=-_HUGE)
    steps = max(1.0, s[score.STEPS])
    reached, total = ending.progress
    rms = _torque_rms(series)
    weight_way = robot.mass * GRAVITY * reached
    return Metrics(
        duration=ending.time,
        pitch_error_max=s[score.PITCH_MAX],
        pitch_error_rms=math.sqrt(s[score.PITCH_SQUARES] / steps),
        joint_error_rms=math.sqrt(s[score.JOINT_SQUARES] / steps / 8),
        torque_peak=s[score.LEG_TORQUE],
        wheel_torque_peak=s[score.WHEEL_TORQUE],
        torque_rms=float(rms.reshape(4, 3)[:, :2].max()),
        continuous_share=_continuous_share(rms, robot),
        energy=s[score.ENERGY],
        link_contacts=loads.contacts,
        link_force_peak=min(loads.peak, _HUGE),
        self_contacts=loads.self_contacts,
        end_error=min(ending.error, _HUGE),
        progress=reached / total,
        speed_mean=reached / max(ending.time - SETTLE, dt),
        speed_stairs=speed_stairs,
        cost_of_transport=s[score.ENERGY] / weight_way if weight_way > 0.0 else None,
        real_time_factor=ending.time / max(wall, 1e-9),
    )


def _torque_rms(series: Series) -> Floats:
    """(12,) of each joint [Nm]; what heats a motor goes with the square of its torque."""
    return np.sqrt(np.mean(np.square(series.torque), axis=0)) if len(series) else np.zeros(12)


def _continuous_share(rms: Floats, robot: Robot) -> float | None:
    """Largest share of the torque that a motor holds without end, of those where that is known."""
    known = [
        torque / motor.continuous
        for torque, motor in zip(rms, robot.motors, strict=True)
        if motor.continuous is not None
    ]
    return max(known, default=None)
