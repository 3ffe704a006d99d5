"""Edges so low that they may be none, for heights are off by as much."""

from __future__ import annotations

import pytest

import stairwright as sw


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "b2w"])
def test_a_low_edge_that_is_none_is_not_taken_for_one_that_comes_later(robot):
    points = [(-1.5, 0.0), (0.0, 0.0), (1.0, 0.1), (1.0, 0.08), (2.5, 0.08)]
    plan = sw.plan({"points": points}, robot, 0.6)
    run = sw.rollout(plan, disturbance={"step_height_error": [0.02]})
    assert run.outcome == "success", run.reason
