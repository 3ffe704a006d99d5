"""The plan's clock: how it goes with wheels that are not where it is."""

from __future__ import annotations

import numpy as np
import pytest

from stairwright import _core
from stairwright.control.setpoint import RATES, WHEELS, WIDTH

AT = 0.5  # m along the plan


def position_after(front: float, rear: float) -> float:
    """Where the clock is after half a second beside wheels that stay ahead of `AT` by that [m]."""
    grid = np.linspace(0.0, 1.0, 201)
    rows = np.zeros((len(grid), WIDTH))
    rows[:, WHEELS] = grid[:, None]
    rows[:, RATES : RATES + 2] = 1.0
    first = 100
    follower = _core.PlanFollower(
        AT, grid[1], rows[first:], np.full(len(grid) - first, 0.1), maximum_lead=0.012
    )
    places = AT + np.array([front, front, rear, rear])
    for _ in range(250):
        follower.advance(places, True, 0.002)
    return float(follower.position)


@pytest.mark.parametrize(("front", "rear"), [(0.04, 0.04), (0.015, 0.0), (0.04, 0.0), (0.0, 0.04)])
def test_it_goes_on_with_wheels_that_are_ahead(front: float, rear: float) -> None:
    assert position_after(front, rear) > AT + 0.01


def test_it_brakes_as_hard_as_planned() -> None:
    """From 0.8 to 0.2 m/s within 5 cm: 6 m/s^2."""
    grid = np.linspace(0.0, 1.0, 2001)
    rows = np.zeros((len(grid), WIDTH))
    rows[:, WHEELS] = grid[:, None]
    rows[:, RATES : RATES + 2] = 1.0
    speeds = np.sqrt(np.interp(grid, [0.4, 0.45], [0.8**2, 0.2**2]))
    follower = _core.PlanFollower(0.0, grid[1], rows, speeds, maximum_lead=0.012)
    while follower.position < 0.5:
        follower.advance(np.full(4, follower.position), True, 0.002)
        planned = float(np.interp(follower.position, grid, speeds))
        assert follower.rate < 1.1 * planned
