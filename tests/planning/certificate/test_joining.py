"""The motion between sparse poses: checked exactly, and objected to where it would fail."""

import numpy as np
import pytest

import stairwright as sw
from stairwright.planning.certificate.joining import certify_motion
from stairwright.terrain.stairs import stair

A1S = ("a1_wheeled", "a1_wheeled_x")


@pytest.mark.parametrize("robot", A1S)
@pytest.mark.parametrize("terrain", ["single-stair-036", "three-stairs-up", "loading-dock"])
def test_the_motion_between_critical_poses_passes_the_exact_check(terrain, robot):
    plan = sw.plan(terrain, robot, method="critical")
    assert plan.certificate.motion is None
    certificate = certify_motion(plan)
    assert certificate.scope == "motion"
    assert certificate.passed, [check for check in certificate.checks if not check.passed]


def test_a_plan_says_where_its_poses_cannot_be_joined():
    """Both knees back, the robot tips between the poses at the edge that it steps down from."""
    plan = sw.plan("three-stairs-up-down", "a1_wheeled", method="critical")
    assert plan.certificate.scope == "poses"
    assert plan.certificate.motion.kind == "statics"
    assert plan.certificate.motion.at[0] == pytest.approx(2.4, abs=0.4)
    assert not certify_motion(plan).passed


@pytest.mark.slow
@pytest.mark.parametrize(
    ("terrain", "friction", "robot", "kind", "words"),
    [
        (stair(0.166, 0.291, 3), 0.50, "a1_wheeled", "reach", "joints would have to jump"),
        (stair(0.101, 0.344, 3), 0.52, "a1_wheeled_x", "statics", "loses its balance"),
        (stair(0.162, 0.335, 2), 0.49, "a1_wheeled", "statics", "from where balance ends"),
    ],
)
def test_motion_that_would_fail_in_a_rollout_is_named(terrain, friction, robot, kind, words):
    """The poses of all of these are sound, and their rollouts fail where the motion is not."""
    plan = sw.plan(terrain, robot, friction, method="critical")
    assert plan.feasible
    assert plan.certificate.passed
    motion = plan.certificate.motion
    assert motion is not None
    assert motion.kind == kind
    assert words in motion.message
    run = sw.rollout(plan)
    assert run.outcome != "success"
    assert plan.poses[0].progress < motion.progress < plan.poses[-1].progress


def test_motion_that_motors_cannot_hold_is_named():
    """The poses themselves take less than the motion between them."""
    robot = sw.load_robot("a1_wheeled").model_dump(mode="json")
    free = sw.plan("single-stair-036", robot, method="critical")
    assert free.certificate.motion is None
    robot["actuators"]["leg"]["torque"] = 9.0
    plan = sw.plan("single-stair-036", robot, method="critical")
    motion = plan.certificate.motion
    assert motion.kind == "torque"
    assert "motors would have to hold" in motion.message
    assert "9 Nm is all" in motion.message
    assert sw.rollout(plan).outcome != "success"


@pytest.mark.slow
def test_motion_without_objection_succeeds():
    """Random stairs up and down; most have no objection, and of these every rollout succeeds."""
    rng, driven = np.random.default_rng(3), 0
    for k in range(12):
        count = int(rng.integers(1, 5))
        height = rng.uniform(0.08, 0.38 if count == 1 else 0.2)
        terrain = stair(height, rng.uniform(0.25, 0.4), count, direction=("up", "down")[k % 2])
        robot, friction = A1S[k // 2 % 2], rng.uniform(0.45, 0.8)
        plan = sw.plan(terrain, robot, friction, method="critical")
        if plan.feasible and plan.certificate.motion is None:
            assert certify_motion(plan).passed
            run = sw.rollout(plan)
            assert run.outcome == "success", (terrain.name, robot, friction, run.reason)
            driven += 1
    assert driven >= 6
