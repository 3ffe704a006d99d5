import numpy as np
import pytest

import stairwright as sw
from stairwright.planning.pose_locations import find_obstacles
from stairwright.planning.weights import CriticalWeights
from stairwright.terrain.profile import Terrain
from stairwright.terrain.stairs import ramp, stair
from stairwright.terrain.wheel_path import wheel_path
from tests.planning.drawn import random_profile
from tests.shapely_checker import check_pose, skeleton

A1S = ("a1_wheeled", "a1_wheeled_x")

CASES = [(terrain, robot) for robot in A1S for terrain in sw.terrains()]


def assert_sound(plan, poses=None):
    """Every pose passes the independent checker, and its margins say the same."""
    robot, vertices = plan.robot_description, plan.terrain.vertices
    for pose in plan.poses if poses is None else poses:
        verdict = check_pose(robot, vertices, pose)
        assert verdict.wheel_gap < 1e-5
        assert verdict.closure < 1e-9
        assert verdict.clearance > 0.0
        assert verdict.joint_slack > -1e-9
        assert verdict.legs_apart > 0.005
        assert pose.margins.clearance == pytest.approx(min(verdict.clearance, 0.5), abs=1e-6)


@pytest.mark.parametrize(("terrain", "robot"), CASES)
def test_presets_are_solved(terrain, robot):
    plan = sw.plan(terrain, robot, method="critical")
    assert plan.status == "feasible"
    assert plan.problem is None
    assert_sound(plan)
    assert plan.certificate.scope == "poses"
    assert plan.certificate.passed, plan.certificate.checks
    assert all(pose.margins.com > 0.0 for pose in plan.poses)
    assert all(pose.margins.torque > 0.0 for pose in plan.poses)
    progress = [pose.progress for pose in plan.poses]
    assert progress[0] == 0.0
    assert np.all(np.diff(progress) > 0.0)
    assert all(len(pose.collision_points) == 25 for pose in plan.poses)
    assert np.all(np.diff([pose.time for pose in plan.poses]) > 0.0)


@pytest.mark.parametrize("robot", A1S)
@pytest.mark.parametrize(
    ("terrain", "obstacles", "rests"),
    [("flat", 0, 0), ("single-stair-036", 1, 0), ("ramp-30deg-025", 1, 0),
     ("three-stairs-up", 3, 0), ("three-stairs-up-down", 6, 1), ("loading-dock", 4, 1)],
)  # fmt: skip
def test_two_poses_for_each_obstacle(terrain, robot, obstacles, rests):
    """And a standing pose on each platform that has room for it."""
    plan = sw.plan(terrain, robot, method="critical")
    assert len(plan.critical) == 2 * obstacles
    assert len(plan.poses) == 2 + 2 * obstacles + rests


@pytest.mark.parametrize("robot", A1S)
def test_rear_contact_stays_behind_the_rear_hip(robot):
    """Eq 20, at the critical poses."""
    plan = sw.plan("single-stair-036", robot, method="critical")
    for k in plan.critical:
        pose = plan.poses[k]
        hip = skeleton(plan.robot_description, pose.x_c, pose.z_c, pose.pitch, pose.q)["rear"][0]
        assert pose.contacts[1][0] <= hip[0] + 1e-6


@pytest.mark.parametrize("robot", A1S)
@pytest.mark.parametrize("tilt", [0.02, 0.0, -0.02])
def test_treads_need_not_be_level(tilt, robot):
    """Two poses for each stair of a flight, the same two again where what lies before repeats."""
    points, run, rise = [[-1.5, 0.0]], 0.3, 0.16
    for k in range(5):
        foot = k * (rise + tilt)
        points += [[k * run, foot], [k * run, foot + rise]]
    plan = sw.plan({"points": [*points, [3.2, points[-1][1]]]}, robot, method="critical")
    assert plan.feasible
    assert len(plan.poses) == 12
    assert plan.certificate.motion is None
    for before, after in zip(plan.poses[5:7], plan.poses[7:9], strict=True):
        shift = np.subtract(after.wheels, before.wheels)
        assert np.allclose(shift, [run, rise + tilt], atol=1e-6)
        assert np.allclose(after.q, before.q, atol=1e-6)


@pytest.mark.parametrize("robot", A1S)
@pytest.mark.parametrize(
    "terrain",
    [
        {"points": [[-2, -0.2], [2, 0.2]]},
        {"points": [[-2, 0.2], [2, -0.2]]},
        {"points": [[-2, -0.2], [0, 0], [2, 0]]},
        {"points": [[-2, 0.4], [0, 0], [2, 0.4]]},
        {"points": [[-1, 0], [0, 0], [2, 0.6], [4, 0.6]], "start": 1.0, "goal": 3.4},
    ],
)
def test_a_robot_that_starts_on_a_slope_goes_on(terrain, robot):
    """The front wheel never goes back to the foot of the slope on which it stands."""
    plan = sw.plan(terrain, robot, method="critical", friction=0.6)
    assert plan.feasible, plan.problem
    assert plan.certificate.passed
    assert plan.certificate.motion is None
    assert_sound(plan)
    assert np.all(np.diff([pose.wheel_progress[0] for pose in plan.poses]) >= 0.0)


def test_poses_repeat_on_a_uniform_flight():
    plan = sw.plan(stair(0.18, 0.28, 6), method="critical")
    shift = np.array([0.28, 0.18])
    for k in range(5, len(plan.poses) - 1):
        before, after = plan.poses[k - 2], plan.poses[k]
        assert np.allclose(np.subtract(after.wheels, before.wheels), shift, atol=1e-6)
        assert np.allclose(after.q, before.q, atol=1e-6)


def test_same_question_same_answer():
    first, second = (sw.plan("three-stairs-up", method="critical") for _ in range(2))
    assert first.id == second.id
    assert first.poses == second.poses


def test_weights_pull():
    """A stronger pull to a level trunk gives a leveller trunk; eq 17."""
    loose = sw.plan("single-stair-036", method="critical", weights={"pitch": 1e-3})
    stiff = sw.plan("single-stair-036", method="critical", weights={"pitch": 50.0})
    assert abs(stiff.poses[2].pitch) < abs(loose.poses[2].pitch)
    assert CriticalWeights().com_z < CriticalWeights().com_x / 10


def test_points_alone_solve_too():
    plan = sw.plan("three-stairs-up", method="critical", weights={"exact_links": False})
    assert plan.status == "feasible"
    vertices = plan.terrain.vertices
    for pose in plan.poses:
        points = np.array(pose.collision_points)
        height = np.array([plan.terrain.height(x) for x in points[:, 0]])
        assert np.all(points[:, 1] > height)
        assert check_pose(plan.robot_description, vertices, pose).wheel_gap < 1e-5


@pytest.mark.parametrize("robot", A1S)
@pytest.mark.parametrize("seed", range(12))
def test_drawn_profiles(seed, robot):
    """Solved, or a named reason with a place; poses found before it are sound either way."""
    plan = sw.plan(random_profile(seed), robot, method="critical")
    assert_sound(plan)
    if plan.status == "infeasible":
        assert plan.problem.message
        x0, x1 = plan.terrain.points[0][0], plan.terrain.points[-1][0]
        assert x0 <= plan.problem.at[0] <= x1


@pytest.mark.parametrize("robot", A1S)
def test_a_wall_stops_the_robot(robot):
    plan = sw.plan(stair(1.2), robot, method="critical")
    assert plan.status == "infeasible"
    assert plan.problem.kind == "reach"
    assert plan.problem.at == pytest.approx([0.02, 1.2], abs=0.03)
    assert plan.problem.limit.needed > plan.problem.limit.available
    assert len(plan.poses) >= 1


def test_ice_stops_the_robot():
    """Both wheels on a long ramp need friction above its slope."""
    plan = sw.plan(ramp(1.0, 0.5), friction=0.3, method="critical")
    assert plan.problem is not None
    assert plan.problem.kind == "statics"
    assert plan.problem.limit.needed == pytest.approx(np.tan(0.5), rel=0.1)
    assert plan.problem.limit.available == 0.3


def test_no_room_to_stand():
    plan = sw.plan(Terrain(points=[(0, 0), (0.1, 0), (0.1, 0.2), (2, 0.2)]), method="critical")
    assert plan.status == "infeasible"
    assert plan.problem.kind == "start"
    assert plan.poses == []


def test_extreme_profiles_never_raise():
    spike = Terrain(points=[(-1, 0), (0, 0), (0, 0.3), (0, 0), (2, 0)])
    comb = [(x, z) for k in range(40) for x, z in ((0.05 * k, 0.0), (0.05 * k, 0.03))]
    many = [(0.002 * k, 0.01 * float(np.sin(0.05 * k))) for k in range(2000)]
    for terrain in (
        spike,
        Terrain(points=[(-1, 0), *comb, (3, 0)]),
        Terrain(points=many),
        Terrain(points=[(0, 0), (100, 0)]),
        Terrain(points=[(0, 0), (1e-3, 50)]),
    ):
        plan = sw.plan(terrain, method="critical")
        assert (plan.status == "feasible") == (plan.problem is None)


def test_obstacles():
    path = wheel_path(stair(0.2, 0.3, 3, direction="up-down", platform=1.0), 0.05)
    found = find_obstacles(path, 0.2, path.length - 0.2)
    assert [round(o.height, 6) for o in found] == [0.2] * 3 + [-0.2] * 3
    assert all(o.face == pytest.approx(0.2) for o in found)
    # The first face begins where the wheel touches floor and riser.
    assert path.centres(np.array([found[0].begin]))[0] == pytest.approx([-0.05, 0.05])


def test_small_bumps_are_no_obstacles():
    bumpy = [(0.02 * k, 0.003 * (k % 2)) for k in range(150)]
    path = wheel_path(Terrain(points=[(-1, 0), *bumpy, (4, 0)]), 0.05)
    assert find_obstacles(path, 0.1, path.length - 0.1) == []
