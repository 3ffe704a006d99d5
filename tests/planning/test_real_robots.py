"""The robots that people own: they plan, roll out, and say what binds and how their knees bend."""

from __future__ import annotations

import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.planning.knees import configurations
from stairwright.planning.plan import Knees
from stairwright.terrain.stairs import stair

REAL = ("go2w", "b2w", "m20", "d1", "anymal_wheels")


@pytest.mark.slow
@pytest.mark.parametrize("robot", REAL)
def test_a_stair_is_climbed(robot):
    plan = sw.plan("single-stair-030", robot)
    assert plan.feasible
    assert plan.certificate.passed
    run = sw.rollout(plan)
    assert run.outcome == "success"
    assert run.metrics.link_contacts == 0


@pytest.mark.slow
def test_a_larger_robot_keeps_farther_from_the_ground():
    """It strays farther from its plan than an A1, for which 16 mm are safe."""
    plan = sw.plan("stairs-building", "anymal_wheels")
    assert min(pose.margins.clearance for pose in plan.poses) > 0.018


# Every terrain once, and every robot; `benchmarks/robots.py` asks all pairs.
PAIRS = [(REAL[k % len(REAL)], terrain) for k, terrain in enumerate(sorted(sw.terrains()))]
DRIVEN = {"m20": "loading-dock", "go2w": "stairs-us-7-11", "d1": "stairs-building"}


@pytest.mark.parametrize(("robot", "terrain"), PAIRS)
def test_every_preset_is_planned_or_refused_with_a_reason(robot, terrain):
    plan = sw.plan(terrain, robot)
    assert plan.feasible or plan.problem.limit is not None


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "terrain"), DRIVEN.items())
def test_what_is_planned_of_a_preset_is_driven(robot, terrain):
    """A dock and two flights; `test_a_stair_is_climbed` drives the other robots."""
    assert sw.rollout(sw.plan(terrain, robot)).outcome == "success"


@pytest.mark.parametrize("method", ["path", "critical"])
def test_a_plan_says_which_way_free_knees_bend(method):
    plan = sw.plan("curb-015", "m20", method=method)
    assert plan.feasible
    joints = plan.robot_description.joints
    for name, bend in (("front", plan.knees.front), ("rear", plan.knees.rear)):
        low, high = getattr(joints, name).calf
        assert (low > 0.0) == (bend == "forward")
        assert (high < 0.0) == (bend == "back")
    again = sw.plan("curb-015", "m20", method=method)
    assert again.id == plan.id
    assert sw.plan("curb-015", "go2w", method=method).knees is None


@pytest.mark.slow
def test_knees_keep_towards_each_other_where_another_stance_has_a_little_more_com_margin():
    """With both forward joints and motors have next to nothing to spare: it fell."""
    plan = sw.plan(stair(0.241, 0.241, 5, approach=2.0), "anymal_wheels", 0.6)
    assert plan.knees == Knees(front="back", rear="forward")
    assert sw.rollout(plan).outcome == "success"


def test_configurations_are_all_ways_the_knees_bend():
    m20 = sw.load_robot("m20")
    found = {tuple(leg.knee for leg in one.legs) for one in configurations(m20)}
    assert found == {(a, b) for a in (-1.0, 1.0) for b in (-1.0, 1.0)}
    a1 = sw.load_robot("a1_wheeled")
    assert list(configurations(a1)) == [a1]


def test_a_knee_that_straightens_and_no_more_bends_one_way():
    data = sw.load_robot("go2w").model_dump()
    data["joints"]["rear"]["calf"] = (-2.7, 0.012)
    robot = sw.Robot.model_validate(data)
    (only,) = configurations(robot)
    assert only.joints.rear.calf == (-2.7, -0.05)
    assert only.joints.front == robot.joints.front
    plan = sw.plan("curb-015", robot)
    assert plan.feasible
    assert plan.knees == Knees(front="back", rear="back")
    data["joints"]["rear"]["calf"] = (-0.03, 0.04)
    with pytest.raises(InputError, match="knee must bend"):
        sw.load_robot(data)


@pytest.mark.parametrize("method", ["path", "critical", "nominal"])
def test_the_margin_that_binds_is_the_least_of_its_kind(method):
    plan = sw.plan("ramp-30deg-025", "go2w", method=method)
    if plan.binding is None:
        assert not plan.poses
        return
    assert any(pose.progress == plan.binding.progress for pose in plan.poses)
    named = {"clearance": "clearance", "com": "com", "friction": "friction", "torque": "torque"}
    if plan.binding.quantity in named:
        least = min(getattr(p.margins, named[plan.binding.quantity]) for p in plan.poses)
        assert plan.binding.value == pytest.approx(least)


def test_knees_towards_each_other_stand_apart():
    """Below hips this close the knees would cross: the wheels stand farther apart."""
    data = sw.load_robot("go2w").model_dump()
    data["joints"]["rear"] = {"thigh": [-3.491, 1.571], "calf": [0.838, 2.723]}
    data["hips"] |= {"front": [0.13, 0.0], "rear": [-0.13, 0.0]}
    plan = sw.plan("curb-015", data)
    assert plan.feasible
    first = plan.poses[0]
    assert first.wheels[0][0] - first.wheels[1][0] > 0.28
