"""The robot along a path, and what moving along it takes: derivatives by it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.poses.pose_reference import Reference
from stairwright.planning.standing import enlargement
from stairwright.robot.description import Robot

from .path_position import even_grid, path_positions, slopes

_REACH = 0.0125  # m, for legs of 0.4 m or less: more than poses of a plan are apart


def reach_of(robot: Robot) -> float:
    """How far, both ways, differences are taken for derivatives [m]."""
    return _REACH * enlargement(robot)


@dataclass(frozen=True)
class MovingRobot:
    """A motion on an even grid of path positions (n,) [m].

    Attributes:
        position: (n,) [m].
        progress: (n,) the plan's [m].
        values: (n, 11) wheels, joints, pitch, CoM, trunk: `Reference.planned`.
        first: (n, 11) their derivatives by it.
        second: (n, 11) second derivatives.
    """

    position: Floats
    progress: Floats
    values: Floats
    first: Floats
    second: Floats

    @property
    def step(self) -> float:
        """Between samples [m]."""
        return float(self.position[1] - self.position[0])


def moving_robot(reference: Reference, reach: float) -> MovingRobot:
    """The robot along `reference`; for `reach` see `reach_of`."""
    at = path_positions(reference)
    grid = even_grid(at)
    columns = reference.planned
    first = slopes(grid, at, columns, reach)
    return MovingRobot(
        position=grid,
        progress=np.interp(grid, at, reference.progress),
        values=np.column_stack([np.interp(grid, at, column) for column in columns.T]),
        first=np.ascontiguousarray(first),
        second=np.ascontiguousarray(slopes(grid, grid, first, reach)),
    )
