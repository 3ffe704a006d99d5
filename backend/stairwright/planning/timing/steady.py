"""Steady plans: with another speed, and where motors have little to spare.

Poses are held with up to nine tenths of the motors' torque. What is left moves the robot, and where
wheels press on opposite faces a small horizontal force takes much of it: there the plan slows down.
"""

from __future__ import annotations

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.certificate.dynamics import dynamics_of
from stairwright.planning.firm_margins import firm_com_margins
from stairwright.planning.plan import Plan
from stairwright.planning.pose_arrays import PoseArrays
from stairwright.planning.smoothing.path_document import poses_at
from stairwright.planning.smoothing.path_timing import (
    even_times,
    pose_times,
    standing_effort,
    stretched,
)

STRAINED = 0.8  # of a motor's torque for standing, from which on moving is looked at
_MOST = 0.98  # of the torque that standing and moving may take
_SLOWEST = 3.0  # times slower, at most, in one round
_ROUNDS = 3


def retimed(plan: Plan, speed: float) -> Plan:
    """A path plan's poses at the times that it would have with another wished `speed` [m/s]."""
    poses = PoseArrays.of(plan)
    effort = standing_effort(plan)
    margin = firm_com_margins(plan)
    times = pose_times(plan.robot_description, poses.s, poses.body, poses.q, margin, effort, speed)
    return slowed_where_strained(_timed(plan, times), effort)


def slowed_where_strained(plan: Plan, effort: Floats) -> Plan:
    """The same poses, later where their motion would overload motors.

    Args:
        plan: A feasible plan of method ``path``.
        effort: (n,) largest share of a motor's torque that standing takes at its poses.
    """
    strained = np.flatnonzero(effort > STRAINED)
    if not len(strained):
        return plan
    standing = effort[strained]
    spare = np.maximum(_MOST - standing, 1e-3)
    times = PoseArrays.of(plan).time
    for _ in range(_ROUNDS):
        found = dynamics_of(plan, times, strained)
        # What motion takes falls with the square of the speed.
        slower = np.sqrt(np.maximum((found.share - standing) / spare, 1.0))
        if slower.max() == 1.0:
            break
        even = even_times(times)
        factor = np.ones(len(even))
        places = np.searchsorted(even, found.time).clip(0, len(even) - 1)
        np.maximum.at(factor, places, np.minimum(slower, _SLOWEST))
        times = stretched(times, even, factor)
    return _timed(plan, times)


def _timed(plan: Plan, times: Floats) -> Plan:
    """The plan with its poses at other times (n,) [s]."""
    timing = plan.timing.model_copy(update={"total": float(times[-1])})
    return plan.model_copy(update={"poses": poses_at(plan, times), "timing": timing})
