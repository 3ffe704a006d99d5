"""Steps about as high as a wheel's radius, or lower, that are not as drawn."""

from __future__ import annotations

import pytest

import stairwright as sw
from stairwright.terrain.stairs import stair

KERB_AND_STEP = [(-1.3, 0.0), (0.0, 0.0), (0.0, 0.04), (0.56, 0.04), (0.56, 0.1), (1.9, 0.1)]


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "a1_wheeled_x"])
def test_an_edge_higher_than_drawn_is_no_edge_farther_on(robot: str) -> None:
    """Wheels slip that push as if they were round it already."""
    plan = sw.plan(stair(0.053, 0.23, 3), robot, 0.6)
    run = sw.rollout(plan, disturbance={"step_height_error": [-0.02, -0.02, 0.02]})
    assert run.outcome == "success", run.reason


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "b2w"])
def test_behind_a_kerb_the_next_face_may_be_elsewhere_as_well(robot: str) -> None:
    plan = sw.plan({"points": KERB_AND_STEP}, robot, 0.6)
    run = sw.rollout(plan, disturbance={"face_place_error": [0.03, -0.03]})
    assert run.outcome == "success", run.reason
