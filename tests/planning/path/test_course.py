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


WALLS = [  # a face at an end of the profile, and the ground beside it: from x to x, z
    ([[0, 0], [0, 0.4], [3, 0.4]], (0.0, 3.0, 0.4)),
    ([[0, 0], [0, 0.05], [3, 0.05]], (0.0, 3.0, 0.05)),
    ([[0, 0], [0, 1], [3, 1]], (0.0, 3.0, 1.0)),
    ([[0, 0], [0, -0.05], [3, -0.05]], (0.0, 3.0, -0.05)),
    ([[0, 0], [0, -0.4], [3, -0.4]], (0.0, 3.0, -0.4)),
    ([[-3, 0], [0, 0], [0, -0.4]], (-3.0, 0.0, 0.0)),
    ([[-3, 0], [0, 0], [0, 0.05]], (-3.0, 0.0, 0.0)),
    ([[-3, 0], [0, 0], [0, 1]], (-3.0, 0.0, 0.0)),
]


@pytest.mark.parametrize("robot", sw.robots())
@pytest.mark.parametrize(("points", "ground"), WALLS)
def test_nobody_stands_on_a_face_at_an_end_of_the_profile(points, ground, robot):
    low, high, z = ground
    for method in METHODS:
        plan = sw.plan({"points": points}, robot, method=method)
        assert plan.feasible, plan.problem
        contacts = [contact for k in (0, -1) for contact in plan.poses[k].contacts]
        assert [contact[1] for contact in contacts] == pytest.approx([z] * 4)
        assert all(low < contact[0] < high for contact in contacts)


def test_a_ledge_at_the_start_is_no_flat_stretch():
    """What lies behind the face counts, not the face."""
    plan = sw.plan({"points": [[0, 0], [0, 0.4], [0.02, 0.4], [0.02, 0], [3, 0]]})
    assert plan.problem.kind == "start"
    assert plan.problem.limit.available == pytest.approx(0.02, abs=1e-6)
