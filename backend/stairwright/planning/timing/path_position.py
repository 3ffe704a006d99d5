"""What a plan advances along when it is carried out, and derivatives by it."""

from __future__ import annotations

import math

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.poses.pose_reference import Reference

STEP = 0.0025  # m of path between samples
SWING = 0.3  # of the trunk's motion counts as rolling, where that is more than the progress
TURN = 0.25  # m that a radian of the trunk's pitch counts as


def path_positions(reference: Reference) -> Floats:
    """(n,) the plan's progress [m], and a share of the trunk's motion where that is more.

    So a trunk that swings above wheels that hardly roll takes its time. It rises strictly.
    """
    trunk = np.diff(reference.trunk, axis=0)
    moved = np.hypot(trunk[:, 0], trunk[:, 1]) + TURN * np.abs(trunk[:, 2])
    steps = np.maximum(np.diff(reference.progress), SWING * moved)
    position: Floats = reference.progress[0] + np.concatenate([[0.0], np.cumsum(steps)])
    return position


def even_grid(position: Floats) -> Floats:
    """(m,) from the first position to the last, about `STEP` apart [m]."""
    return np.linspace(
        position[0], position[-1], max(3, math.ceil((position[-1] - position[0]) / STEP) + 1)
    )


def slopes(grid: Floats, at: Floats, values: Floats, reach: float) -> Floats:
    """Derivatives (m, ...) at `grid` of `values` (n, ...) given `at`, over `reach` both ways."""
    low, high = np.maximum(grid - reach, grid[0]), np.minimum(grid + reach, grid[-1])
    columns = values.reshape(len(at), -1).T
    rise = [np.interp(high, at, each) - np.interp(low, at, each) for each in columns]
    slope: Floats = (np.array(rise) / (high - low)).T.reshape(len(grid), *values.shape[1:])
    return slope


def evened(grid: Floats, values: Floats, reach: float) -> Floats:
    """Means (n,) of values (n,) over `reach` both ways.

    Between two poses a plan's times tell one speed, which makes a staircase of speeds. Its slopes
    over `reach` still jump where another pose comes within it, their means do not.
    """
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(grid)
    area = np.concatenate([[0.0], np.cumsum(steps)])
    return slopes(grid, grid, area, reach)


def least_within(values: Floats, reach: int) -> Floats:
    """Least of values (n,) up to `reach` samples before and after each."""
    padded = np.pad(values, reach, mode="edge")
    least: Floats = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1).min(axis=1)
    return least
