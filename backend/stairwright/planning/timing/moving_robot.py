"""The robot along a path, and what moving along it takes: derivatives by the way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stairwright.planning.poses.pose_reference import Reference

from .way import even_grid, slopes, way_of

Floats = NDArray[np.float64]

REACH = 0.0125  # m; derivatives are differences over this far, both ways


@dataclass(frozen=True)
class MovingRobot:
    """A motion on an even grid of way (n,) [m].

    Attributes:
        way: (n,) [m].
        progress: (n,) the plan's [m].
        values: (n, 11) wheels, joints, pitch, CoM, trunk: `Reference.planned`.
        first: (n, 11) their derivatives by the way.
        second: (n, 11) second derivatives.
    """

    way: Floats
    progress: Floats
    values: Floats
    first: Floats
    second: Floats

    @property
    def step(self) -> float:
        """Between samples [m]."""
        return float(self.way[1] - self.way[0])


def moving_robot(reference: Reference) -> MovingRobot:
    """The robot along `reference`."""
    at = way_of(reference)
    grid = even_grid(at)
    columns = reference.planned
    first = slopes(grid, at, columns, REACH)
    return MovingRobot(
        way=grid,
        progress=np.interp(grid, at, reference.progress),
        values=np.column_stack([np.interp(grid, at, column) for column in columns.T]),
        first=np.ascontiguousarray(first),
        second=np.ascontiguousarray(slopes(grid, grid, first, REACH)),
    )
