"""Where a plan starts and ends, and what is said where it cannot."""

import numpy as np
import pytest

import stairwright as sw
from stairwright import _core
from stairwright.planning.path_planner import path_planner
from stairwright.planning.standing import StandingPose, find_standing_poses, stance
from stairwright.planning.weights import PathWeights
from stairwright.planning.wheel_samples import sample_wheel_places
from stairwright.robot.kinematics import inverse
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

A1S = ("a1_wheeled", "a1_wheeled_x")

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


@pytest.mark.parametrize("robot", A1S)
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


@pytest.mark.parametrize(
    "points",
    [
        lambda length: [[0, 0], [length, 0]],
        lambda length: [[0, 0], [length, 0], [length, 0.1], [length + 2, 0.1]],
        lambda length: [[0, 0], [length, 0], [length, -0.1], [length + 2, -0.1]],
        lambda length: [[-2, 0], [0, 0], [0, 0.1], [length, 0.1]],
        lambda length: [[-2, 0], [0, 0], [0, 0.1], [length, 0.1], [length, 0.4]],
    ],
)
def test_the_length_that_is_needed_is_enough(points):
    for short in (0.12, 0.16):
        limit = sw.plan({"points": points(short)}).problem.limit
        assert limit.quantity == "length"
        assert limit.available == pytest.approx(short)
        enough = sw.plan({"points": points(limit.needed)}, method="nominal").problem
        assert enough is None or enough.kind not in ("start", "goal")
        less = sw.plan({"points": points(limit.needed - 1e-4)}, method="nominal").problem
        assert less.kind in ("start", "goal")


@pytest.mark.parametrize("end", ["start", "goal"])
def test_a_trunk_that_cannot_stand_there_is_told_where_it_can(end):
    refused = sw.plan({"points": STAIR, end: 0.0}, method="nominal").problem
    assert refused.kind == end
    assert refused.limit.available == 0.0
    moved = sw.plan({"points": STAIR, end: refused.limit.needed}, method="nominal")
    assert moved.problem is None or moved.problem.kind != end


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_calves_thicker_than_their_wheels_are_refused_for_that(method):
    robot = sw.load_robot("a1_wheeled").model_dump(mode="json")
    robot["calf"]["radius"] = 0.055
    problem = sw.plan({"points": STAIR}, robot, method=method).problem
    assert problem.kind == "start"
    assert problem.limit.quantity == "wheel radius"
    assert (problem.limit.needed, problem.limit.available) == pytest.approx((0.055, 0.05))
    assert "calves are thicker than their wheels" in problem.message
    robot["calf"]["radius"] = 0.05 / 1.02
    assert sw.plan({"points": [[-1.5, 0.0], [1.5, 0.0]]}, robot).feasible


def test_wheels_too_large_for_the_hips_stand_apart():
    robot = sw.load_robot("a1_wheeled").model_dump(mode="json")
    robot["hips"] |= {"front": [0.04, 0.0], "rear": [-0.04, 0.0]}
    assert stance(sw.load_robot(robot)) == pytest.approx(0.11, abs=0.01)


@pytest.mark.parametrize("length", [0.3, 0.5])
def test_a_trunk_that_hangs_over_stands_clear_of_the_step_behind(length):
    robot = sw.load_robot("a1_wheeled").model_dump(mode="json")
    robot["trunk"]["size"][0] = length + robot["hips"]["front"][0] - robot["hips"]["rear"][0]
    robot = sw.load_robot(robot)
    terrain = sw.load_terrain({"points": [[-1.5, 0.0], [0.0, 0.0], [0.0, -0.25], [3.0, -0.25]]})
    path = wheel_path(terrain, robot.wheel.radius)
    begin, end = find_standing_poses(terrain, robot, path)
    ground = _core.Terrain(path.vertices)

    def clearance(pose):
        q = inverse(robot, *map(float, pose.body), path.centres(np.array(pose.wheels)))
        return _core.least_clearance(ground, robot.native, pose.body, q)

    assert clearance(begin) >= 0.02
    assert clearance(end) >= 0.02
    # No farther off than it takes: a stride nearer the trunk would come too near.
    near = StandingPose(tuple(s - 0.05 for s in end.wheels), end.body - [0.05, 0.0, 0.0])
    assert clearance(near) < 0.02


@pytest.mark.slow
def test_a_saw_of_many_teeth_is_planned_on_a_lattice_of_bounded_size():
    """Every tooth has a corner; with samples at all of them one plan took 5.8 GiB."""
    saw = Terrain(points=[(0.0025 * i, 0.05 * (i // 2 % 2)) for i in range(2000)])
    planner = path_planner(saw, sw.load_robot("a1_wheeled"), 0.6, PathWeights())
    assert len(planner.path.corners) > 400
    samples = sample_wheel_places(planner.path, *planner.ends, 0.05, 1.0)
    assert len(samples) < 300
    assert np.diff(samples).max() <= 0.05 + 1e-9
    assert len(sample_wheel_places(planner.path, *planner.ends, 0.05, 1.0, brinks=True)) < 300
    assert sw.plan(saw).feasible
