"""Level ground tells no robot where it is: it drifts, arrives all the same, and rolls off nothing."""

from __future__ import annotations

import pytest

import stairwright as sw


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "go2w"])  # wheels with little and with much friction
def test_a_long_way_on_level_ground_succeeds(robot: str) -> None:
    plan = sw.plan({"points": [(-1, 0), (20, 0)]}, robot, timing="fast")
    run = sw.rollout(plan, controller={"speed": 0.7})
    assert run.outcome == "success", run.reason
    way = plan.poses[-1].x_c - plan.poses[0].x_c
    drift = run.series.base_position[-1][0] - plan.poses[-1].x_c
    assert abs(drift) < 0.007 * way
