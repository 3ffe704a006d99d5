"""What a plan leaves its centre of mass, with friction on one face of a corner only."""

from __future__ import annotations

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.planning.plan import Plan
from stairwright.terrain.wheel_path import wheel_path


def firm_com_margins(plan: Plan, shift: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """CoM margins (n,) of a plan's poses [m]; negative: the robot tips.

    Args:
        plan: Whose poses.
        shift: Of the centre of mass from where the plan has it, in the trunk's frame [m].
    """
    path = wheel_path(plan.terrain, plan.robot_description.wheel.radius)
    s = np.array([pose.wheel_progress for pose in plan.poses])
    pitch, x = np.array([(pose.pitch, pose.com[0]) for pose in plan.poses]).T
    x = x + shift[0] * np.cos(pitch) + shift[1] * np.sin(pitch)
    margins: Floats = _core.firm_com_margins(path.native, s, x, plan.friction)
    return margins
