"""The paper's results, each a row: planned by its method, driven in MuJoCo."""

import math

import pytest

import stairwright as sw

A1S = ("a1_wheeled", "a1_wheeled_x")

pytestmark = pytest.mark.slow

ROWS = ["ramp-30deg-025", "single-stair-030", "single-stair-036", "three-stairs-up"]


@pytest.mark.parametrize("robot", A1S)
@pytest.mark.parametrize("terrain", ROWS)
def test_critical_poses_pass(terrain, robot):
    """No link touches; the pitch error stays under 3 degrees."""
    plan = sw.plan(terrain, robot, friction=0.6, method="critical")
    run = sw.rollout(plan, friction=0.6, seed=0)
    assert run.outcome == "success"
    assert run.metrics.link_contacts == 0
    assert run.metrics.pitch_error_max < math.radians(3.0)


@pytest.mark.parametrize("robot", A1S)
def test_ramp_without_pose_optimisation_does_visibly_worse(robot):
    nominal = sw.rollout(sw.plan("ramp-30deg-025", robot, method="nominal"))
    critical = sw.rollout(sw.plan("ramp-30deg-025", robot, method="critical"))
    assert nominal.outcome != "success"
    assert nominal.metrics.pitch_error_max > 10 * critical.metrics.pitch_error_max


def test_up_and_down_with_front_knees_forward():
    plan = sw.plan("three-stairs-up-down", "a1_wheeled_x", method="critical")
    assert sw.rollout(plan).outcome == "success"
