"""Where a plan starts and ends, and what is said where it cannot."""

import pytest

import stairwright as sw

METHODS = ("path", "critical", "nominal")
STAIR = [[-1.5, 0.0], [0.0, 0.0], [0.0, 0.2], [2.0, 0.2]]


@pytest.mark.parametrize("method", METHODS)
def test_a_goal_at_the_start_is_refused(method):
    plan = sw.plan({"points": STAIR, "start": -1.0, "goal": -1.0 + 1e-7}, method=method)
    assert plan.problem.kind == "goal"
    assert plan.problem.limit.needed > plan.problem.limit.available == pytest.approx(1e-7)


@pytest.mark.parametrize("method", METHODS)
def test_a_goal_a_little_ahead_is_planned(method):
    plan = sw.plan({"points": STAIR, "start": -1.0, "goal": -0.9999}, method=method)
    assert plan.feasible
    assert len(plan.poses) >= 2
