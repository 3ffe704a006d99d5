"""Planned energy, against what lifting the robot takes: a balance that knows no torque."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright._core import GRAVITY
from stairwright.planning.energy import joint_work


@pytest.mark.parametrize("terrain", ["three-stairs-up", "single-stair-036"])
def test_at_rest_in_every_pose_the_motors_do_what_lifts_the_robot(terrain):
    plan = sw.plan(terrain, "a1_wheeled_x")
    lifted = plan.robot_description.mass * GRAVITY * (plan.poses[-1].com[1] - plan.poses[0].com[1])
    assert joint_work(plan).sum() == pytest.approx(lifted, rel=0.03)
    assert plan.energy == pytest.approx(np.abs(joint_work(plan)).sum())
    assert plan.energy > lifted
    weight = plan.robot_description.mass * GRAVITY
    assert plan.cost_of_transport == pytest.approx(plan.energy / weight / plan.poses[-1].progress)


def test_wheels_alone_pay_for_the_height_of_a_ramp_and_for_nothing_on_the_level():
    slope = {"points": [[-2.0, 0.0], [0.0, 0.0], [1.0, 0.15], [3.0, 0.15]]}
    climbed = sw.plan(slope, "a1_wheeled_x", method="nominal")
    lifted = climbed.poses[-1].com[1] - climbed.poses[0].com[1]
    height = climbed.robot_description.mass * GRAVITY * lifted
    assert climbed.feasible
    assert climbed.energy == pytest.approx(height, rel=0.03)
    assert sw.plan("flat", "a1_wheeled_x", method="nominal").energy == pytest.approx(0.0, abs=1e-6)


def test_it_stands_in_the_document_and_older_documents_have_none():
    plan = sw.plan("single-stair-030", "a1_wheeled_x")
    document = plan.model_dump(mode="json")
    assert document["energy"] == pytest.approx(plan.energy)
    again = type(plan).model_validate(document)
    assert (again.energy, again.cost_of_transport) == (plan.energy, plan.cost_of_transport)
    del document["energy"], document["cost_of_transport"]
    older = type(plan).model_validate(document)
    assert (older.energy, older.cost_of_transport) == (None, None)


@pytest.mark.slow
def test_poses_too_far_apart_and_ways_that_end_have_none():
    assert sw.plan("single-stair-030", "a1_wheeled_x", method="critical").energy is None
    wall = {"points": [[-2.0, 0.0], [0.0, 0.0], [0.0, 1.2], [2.0, 1.2]]}
    assert sw.plan(wall, "a1_wheeled_x").energy is None
