"""Problems of which the path begins where a robot is, and not where it would stand at the start."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stairwright.planning.path_planner import PathPlanner
from stairwright.planning.smoothing.refine import node_margins
from stairwright.planning.standing import StandingPose, scale

# Poses that are looked at: steps of the trunk's x and z, for legs of 0.4 m, and its pitch.
_REACH = (0.05, 0.04, 0.2)  # m, m, rad; the farthest
_STEPS = np.stack(np.meshgrid(*3 * [np.linspace(-1.0, 1.0, 9)], indexing="ij"), axis=-1)
_NEAR = _STEPS.reshape(-1, 3)
_SLACK = 0.002  # m; that a pose must have for a path to begin there


def underway(planner: PathPlanner, here: StandingPose) -> PathPlanner | None:
    """The same problem, but begun at the sound pose nearest to `here`, wheels where they are.

    Returns:
        Nothing where no pose near to it keeps its bounds.
    """
    size = scale(planner.robot)
    bodies = here.body + _NEAR * _REACH * np.array([size, size, 1.0])
    slack = node_margins(planner, np.tile(here.wheels, (len(bodies), 1)), bodies).least_slack
    sound = np.flatnonzero(slack >= _SLACK)
    if len(sound) == 0:
        return None
    nearest = sound[np.linalg.norm(_NEAR[sound], axis=1).argmin()]
    begin = replace(here, body=bodies[nearest])
    return replace(planner, ends=(begin, planner.ends[1]), searches={})
