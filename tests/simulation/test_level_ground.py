"""Level ground tells no robot where it is: it drifts, and arrives all the same."""

from __future__ import annotations

import pytest

import stairwright as sw


@pytest.mark.slow
# Wheels with little friction in their motors, and with much.
@pytest.mark.parametrize("robot", ["a1_wheeled", "go2w"])
def test_a_long_way_on_level_ground_succeeds(robot: str) -> None:
    plan = sw.plan({"points": [(-1, 0), (5, 0)]}, robot, timing="fast")
    run = sw.rollout(plan, controller={"speed": 0.7})
    assert run.outcome == "success", run.reason
    way = plan.poses[-1].x_c - plan.poses[0].x_c
    drift = run.series.base_position[-1][0] - plan.poses[-1].x_c
    assert abs(drift) < 0.01 * way
