"""The dense path: plans, their certificates, and input at the edges."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

import stairwright as sw
from stairwright import _core
from stairwright.planning.certificate.certify import certify
from stairwright.planning.path_problem import LAG
from stairwright.robot import kinematics as kin
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

ROBOTS = ("a1_wheeled", "a1_wheeled_x")
STAIR = [(-1.5, 0.0), (0.0, 0.0), (0.0, 0.36), (1.5, 0.36)]


def terrain(points, **more):
    return Terrain.model_validate({"points": points, **more})


@pytest.fixture(scope="module", params=ROBOTS)
def stair_plan(request):
    return sw.plan(terrain(STAIR), request.param, friction=0.6)


def test_single_stair_is_planned_and_certified(stair_plan):
    assert stair_plan.feasible
    assert stair_plan.certificate.passed
    assert {c.name for c in stair_plan.certificate.checks} >= {
        "gap between wheels and ground",
        "clearance of the trunk",
        "gap between front and rear leg",
        "samples out of balance",
    }


def test_poses_are_consistent(stair_plan):
    robot = stair_plan.robot_description
    progress = np.array([p.progress for p in stair_plan.poses])
    time = np.array([p.time for p in stair_plan.poses])
    assert np.all(np.diff(progress) > 0)
    assert np.all(np.diff(time) > 0)
    for pose in stair_plan.poses[::20]:
        frames = kin.forward(robot, pose.x_c, pose.z_c, pose.pitch, np.array(pose.q))
        assert frames.wheels == pytest.approx(np.array(pose.wheels), abs=1e-9)
        assert kin.com(robot, pose.x_c, pose.z_c, pose.pitch, frames) == pytest.approx(
            pose.com, abs=1e-9
        )
        forces = np.array(pose.forces)
        assert np.all(forces[:, 1] > 0)
        assert min(pose.margins.model_dump().values()) > 0


def test_starts_and_ends_standing(stair_plan):
    robot = stair_plan.robot_description
    for pose, ground in ((stair_plan.poses[0], 0.0), (stair_plan.poses[-1], 0.36)):
        assert pose.pitch == pytest.approx(0.0, abs=1e-9)
        assert pose.z_c == pytest.approx(ground + robot.nominal_height, abs=1e-6)
    assert stair_plan.critical[0] == 0
    assert stair_plan.critical[-1] == len(stair_plan.poses) - 1


def test_joint_rates_stay_below_the_limit(stair_plan):
    q = np.array([p.q for p in stair_plan.poses])
    time = np.array([p.time for p in stair_plan.poses])
    assert np.abs(np.diff(q, axis=0)).max(axis=1).max() < 0.35
    assert (np.abs(np.diff(q, axis=0)).max(axis=1) / np.diff(time)).max() <= 1.5 + 1e-6


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize(
    "points",
    [
        [(-1.0, 0.0), (2.0, 0.0)],
        [(-1.5, 0.0), (0.0, 0.0), (0.0, 0.02), (0.3, 0.02), (0.3, 0.0), (1.5, 0.0)],
        [(-1.5, 0.0), (0.0, 0.0), (0.0, -0.4), (0.015, -0.4), (0.015, 0.0), (1.5, 0.0)],
        [(-1.5, 0.0), (0.0, 0.0), (0.433, 0.25), (2.0, 0.25)],
    ],
    ids=["flat", "low curb", "slit", "ramp"],
)
def test_easy_terrain_is_planned(points, robot):
    plan = sw.plan(terrain(points), robot, friction=0.6)
    assert plan.feasible
    assert certify(plan).passed


@pytest.mark.slow
@pytest.mark.parametrize("robot", ROBOTS)
def test_friction_that_is_named_is_enough(robot):
    ramp = terrain([(-1.5, 0.0), (0.0, 0.0), (1.5, 1.05), (2.7, 1.05)])
    plan = sw.plan(ramp, robot, friction=0.4)
    assert not plan.feasible
    assert plan.certificate is None
    assert 0.0 < plan.poses[-1].progress < 1.8
    assert plan.problem.kind == "statics"
    assert plan.problem.limit.needed > 0.7
    assert plan.problem.limit.available == pytest.approx(0.4)
    assert sw.plan(ramp, robot, friction=plan.problem.limit.needed).feasible


def stairs(rise, run, count):
    points = [(-1.2, 0.0), (0.0, 0.0)]
    for k in range(1, count + 1):
        points += [(points[-1][0], k * rise), (run * k if k < count else run * k + 1.2, k * rise)]
    return terrain(points)


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "friction"), [("a1_wheeled", 0.25), ("a1_wheeled_x", 0.35)])
def test_wet_stairs_are_climbed(robot, friction):
    """Wheels come close to each other there, and lean on treads and risers at once."""
    plan = sw.plan(stairs(0.18, 0.28, 3), robot, friction)
    assert plan.feasible
    assert sw.rollout(plan).outcome == "success"


@pytest.mark.slow
def test_where_a_search_comes_through_and_no_plan_does_more_grip_is_named():
    """The least friction is then told by whole plans: it is enough, and much less is not."""
    flight = stairs(0.18, 0.28, 5)
    problem = sw.plan(flight, "a1_wheeled", friction=0.12).problem
    assert problem.limit.quantity == "friction"
    assert problem.limit.needed < 0.25
    assert sw.plan(flight, "a1_wheeled", friction=problem.limit.needed).feasible
    less = 0.8 * problem.limit.needed
    assert not sw.plan(flight, "a1_wheeled", friction=less, diagnose=False).feasible


@pytest.mark.slow
def test_where_nothing_helps_the_height_that_would_do_is_named():
    points = [(-1.2, 0.0), (0.0, 0.0), (0.0, 2.0), (1.5, 2.0)]
    problem = sw.plan(terrain(points), "a1_wheeled", friction=0.6).problem
    limit = problem.limit
    assert limit.quantity == "profile height"
    assert problem.message.startswith("needs profile height of at most 0.")
    assert limit.available == pytest.approx(2.0)
    for share, feasible in ((1.0, True), (1.2, False)):
        low = [(x, z * share * limit.needed / 2.0) for x, z in points]
        planned = sw.plan(terrain(low), "a1_wheeled", friction=0.6, diagnose=False)
        assert planned.feasible == feasible


def test_what_is_infeasible_shows_how_far_it_gets():
    plan = sw.plan(terrain([(-1.5, 0.0), (0.0, 0.0), (0.0, 1.3), (1.5, 1.3)]), friction=0.6)
    assert not plan.feasible
    assert not plan.executable
    assert len(plan.poses) > 10
    assert all(min(pose.margins.model_dump().values()) >= 0.0 for pose in plan.poses)
    assert plan.poses[-1].x_c < 0.2
    assert certify(plan.model_copy(update={"problem": None})).passed


def scaled(name, legs, trunk, wheel):
    """A robot with other dimensions."""
    data = sw.load_robot(name).model_dump()
    for part in ("thigh", "calf"):
        data[part]["length"] *= legs
    data["nominal_height"] *= legs
    data["trunk"]["size"] = [v * trunk for v in data["trunk"]["size"]]
    for end in ("front", "rear"):
        data["hips"][end] = [v * trunk for v in data["hips"][end]]
    data["wheel"]["radius"] *= wheel
    return data


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("size", [(1.4, 1.0, 1.0), (1.0, 0.7, 1.0), (0.8, 1.2, 1.4)])
def test_robots_of_other_dimensions(robot, size):
    rise = 0.25 * size[0]
    stair = terrain([(-1.5, 0.0), (0.0, 0.0), (0.0, rise), (1.5, rise)])
    plan = sw.plan(stair, scaled(robot, *size), friction=0.6)
    assert plan.feasible
    assert plan.certificate.passed


@pytest.mark.slow
def test_a_spike_without_width_is_an_obstacle():
    tall = terrain([(-1.5, 0.0), (0.0, 0.0), (0.0, 1.2), (0.0, 0.0), (1.5, 0.0)])
    assert not sw.plan(tall, friction=0.6, diagnose=False).feasible
    low = terrain([(-1.5, 0.0), (0.0, 0.0), (0.0, 0.05), (0.0, 0.0), (1.5, 0.0)])
    assert sw.plan(low, friction=0.6).feasible


def test_short_first_flat_is_a_start_problem():
    plan = sw.plan(terrain([(-0.1, 0.0), (0.0, 0.0), (0.0, 0.3), (2.0, 0.3)]), friction=0.6)
    assert plan.problem.kind == "start"
    assert plan.problem.limit.needed > plan.problem.limit.available


def test_start_and_goal_are_kept():
    plan = sw.plan(terrain(STAIR, start=-0.8, goal=0.9), friction=0.6)
    assert plan.feasible
    assert plan.poses[0].x_c == pytest.approx(-0.8, abs=1e-6)
    assert plan.poses[-1].x_c == pytest.approx(0.9, abs=1e-6)


def test_certificate_refuses_tampered_plans():
    plan = sw.plan(terrain(STAIR), friction=0.6)
    k = len(plan.poses) // 2
    pose = plan.poses[k]

    def with_pose(**change):
        poses = [*plan.poses[:k], pose.model_copy(update=change), *plan.poses[k + 1 :]]
        return certify(plan.model_copy(update={"poses": poses}))

    def failed(certificate):
        return {c.name for c in certificate.checks if not c.passed}

    assert "gap between wheels and ground" in failed(with_pose(z_c=pose.z_c + 0.02))
    assert "clearance of the trunk" in failed(with_pose(z_c=pose.z_c - 0.4))
    bent = (pose.q[0], pose.q[1] - 1.5, pose.q[2], pose.q[3])
    assert "slack of the joint limits" in failed(with_pose(q=bent))
    assert "samples out of balance" in failed(certify(plan.model_copy(update={"friction": 0.05})))


def links_clearance(plan, samples):
    """Least distance of the links from the ground while poses are interpolated [m], by shapely."""
    robot = plan.robot_description
    knots = np.arange(len(plan.poses))
    at = np.linspace(0, knots[-1], samples * knots[-1] + 1)
    poses = np.array([(p.x_c, p.z_c, p.pitch, *p.q) for p in plan.poses])
    x, z, pitch, *q = (np.interp(at, knots, column) for column in poses.T)
    frames = kin.forward(robot, x, z, pitch, np.stack(q, axis=1))
    ground = shapely.LineString(plan.terrain.vertices)
    least = [
        shapely.distance(ground, shapely.linestrings(np.stack([a, b], axis=2))) - radius
        for a, b, radius in (
            (frames.hips, frames.knees, robot.thigh.radius),
            (frames.knees, frames.wheels, robot.calf.radius),
        )
    ]
    return float(np.min(least))


@pytest.mark.parametrize(("less", "passed"), [(0.0006, True), (-0.0001, False)])
def test_certificate_tells_clearances_apart_to_less_than_a_millimetre(stair_plan, less, passed):
    """However far the robot moves between two samples elsewhere."""
    robot = stair_plan.robot_description
    thicker = links_clearance(stair_plan, 60) - less
    changed = {
        part: getattr(robot, part).model_copy(
            update={"radius": getattr(robot, part).radius + thicker}
        )
        for part in ("thigh", "calf")
    }
    plan = stair_plan.model_copy(update={"robot_description": robot.model_copy(update=changed)})
    (check,) = [c for c in certify(plan).checks if c.name == "clearance of the links"]
    assert check.passed == passed
    assert check.value <= links_clearance(plan, 60) + 1e-9


@pytest.mark.parametrize("robot", ROBOTS)
def test_what_changes_between_two_nodes_is_kept_at_both(robot):
    """Contacts change where no node lies; the CoM keeps what holds there too."""
    path = wheel_path(terrain(STAIR), sw.load_robot(robot).wheel.radius)
    s = np.stack([np.linspace(0.6, path.length - 0.2, 90), np.linspace(0.1, 1.6, 90)], axis=1)
    nodes = np.hstack([s, np.zeros((90, 3))])
    at = _core.contact_changes(path.native, nodes)
    spans = _core.intervals_along(path.native, nodes, 0.6, 0.5, LAG)
    assert len(at) > 4
    for place in at:
        between = np.array([np.interp(place, np.arange(90), column) for column in nodes.T])
        (there,) = _core.intervals_along(path.native, between[None], 0.6, 0.5, LAG)
        for k in (int(np.floor(place)), int(np.ceil(place))):
            assert np.all(spans[k, ::2] >= there[::2])
            assert np.all(spans[k, 1::2] <= there[1::2])


def test_same_question_same_answer():
    first, second = (sw.plan(terrain(STAIR), friction=0.6) for _ in range(2))
    assert first.id == second.id
    assert first.poses == second.poses


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motor", "share", "robot"),
    [("leg", 0.8, "a1_wheeled"), ("leg", 0.05, "a1_wheeled_x"), ("wheel", 0.02, "a1_wheeled")],
)
def test_a_weak_motor_is_named_with_the_torque_that_is_enough(motor, share, robot):
    data = sw.load_robot(robot).model_dump()
    data["actuators"][motor]["torque"] = 10.0 * share
    problem = sw.plan("single-stair-036", data).problem
    assert problem.kind == "torque"
    assert (problem.limit.quantity, problem.limit.unit) == (f"{motor} torque", "Nm")
    assert problem.limit.available == pytest.approx(10.0 * share)
    data["actuators"][motor]["torque"] = problem.limit.needed
    assert sw.plan("single-stair-036", data).feasible
