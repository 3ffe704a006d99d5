import numpy as np
import pytest

import stairwright as sw
from stairwright.robot.kinematics import standing_joints
from tests.shapely_checker import check_pose

A1S = ("a1_wheeled", "a1_wheeled_x")

CASES = [(terrain, robot) for robot in A1S for terrain in sw.terrains()]


@pytest.mark.parametrize(("terrain", "robot"), CASES)
def test_standing_pose_rolls_with_both_wheels_on_the_ground(terrain, robot):
    plan = sw.plan(terrain, robot, method="nominal")
    standing = standing_joints(plan.robot_description)
    assert len(plan.poses) > 20
    for pose in plan.poses[:: max(1, len(plan.poses) // 40)]:
        assert pose.q == pytest.approx(standing, abs=1e-9)
        verdict = check_pose(plan.robot_description, plan.terrain.vertices, pose)
        assert verdict.wheel_gap < 1e-5
        assert pose.margins.clearance == pytest.approx(min(verdict.clearance, 0.5), abs=2e-3)
    assert np.all(np.diff([pose.progress for pose in plan.poses]) > 0)
    bad = [p for p in plan.poses if p.margins.clearance < 0 or p.margins.com < 0]
    assert (plan.status == "infeasible") == bool(bad)
    if bad:
        assert plan.problem.progress == bad[0].progress
        assert plan.problem.kind in ("clearance", "statics")


@pytest.mark.parametrize("robot", A1S)
def test_accessible_ramps_need_no_optimisation(robot):
    assert sw.plan("ramp-1-12", robot, method="nominal").feasible
    assert not sw.plan("ramp-30deg-025", robot, method="nominal").feasible


def test_com_falls_behind_on_the_ramp():
    """The paper's observation without pose optimisation on the 30 degree ramp."""
    plan = sw.plan("ramp-30deg-025", method="nominal")
    first = next(p for p in plan.poses if p.margins.com < 0)
    assert first.com[0] < first.contacts[1][0] + 0.02
