"""Poses of a plan as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from stairwright.arrays import Floats
from stairwright.documents import Deferred
from stairwright.planning.plan import Plan


@dataclass(frozen=True)
class PoseArrays:
    """The n poses of a plan.

    Attributes:
        progress: (n,) way since the start [m].
        time: (n,) planned time since the start [s].
        body: (n, 3) x and z of the trunk [m] and its pitch [rad].
        q: (n, 4) joint angles [rad].
        s: (n, 2) progress of the front and the rear wheels [m].
    """

    progress: Floats
    time: Floats
    body: Floats
    q: Floats
    s: Floats

    @classmethod
    def of(cls, plan: Plan) -> Self:
        """Of documents, or of what these are still to be made of."""
        source = Deferred.source_of(plan, "poses")
        if hasattr(source, "arrays"):
            made: Self = source.arrays
            return made
        poses = plan.poses
        progress, time = np.array([(pose.progress, pose.time) for pose in poses]).T
        body = np.array([(pose.x_c, pose.z_c, pose.pitch) for pose in poses])
        q = np.array([pose.q for pose in poses])
        s = np.array([pose.wheel_progress for pose in poses])
        return cls(progress, time, body, q, s)
