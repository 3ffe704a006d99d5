"""Plans with fast timing: the same path, sooner, within limits that are computed here anew."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

import stairwright as sw
from stairwright.errors import InputError
from stairwright.planning import path_planner
from stairwright.planning.plan import Plan
from stairwright.planning.timing import fast as timing
from stairwright.planning.timing.fast import (
    TimingProblem,
    fastest,
    hastened,
    slow_down,
    slow_down_at_drops,
    slow_down_nearby,
)
from stairwright.planning.timing.limits import Pace
from stairwright.planning.timing.path_position import evened
from stairwright.planning.tolerance import Tolerance
from stairwright.terrain.stairs import stair
from stairwright.terrain.wheel_path import wheel_path

Floats = NDArray[np.float64]
G = 9.81


@pytest.fixture(scope="module")
def steady() -> Plan:
    return sw.plan("three-stairs-up", "a1_wheeled_x")


@pytest.fixture(scope="module")
def fast() -> Plan:
    return sw.plan("three-stairs-up", "a1_wheeled_x", timing="fast")


def test_it_is_sooner_and_says_what_binds(steady: Plan, fast: Plan) -> None:
    assert fast.poses[0].time == 0.0
    assert (np.diff([pose.time for pose in fast.poses]) > 0.0).all()
    assert fast.timing.total == fast.poses[-1].time < steady.timing.total / 2.5
    assert fast.id != steady.id
    assert fast.timing.limits is not None
    assert len(fast.timing.limits) == len(fast.poses)
    assert steady.timing.limits is None


def test_a_path_searched_for_speed_is_faster_than_a_steady_one(steady: Plan, fast: Plan) -> None:
    alike, _ = hastened(steady, fast.weights["aggressiveness"])
    assert fast.timing.total < 0.9 * alike.timing.total


@pytest.mark.slow
def test_of_two_smoothings_the_sooner_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    flight = stair(0.17, 0.29, 5, approach=1.18, platform=1.0)
    found = sw.plan(flight, "m20", 0.6, timing="fast", facing="forward")
    monkeypatch.setattr(path_planner, "STRAIGHTER", 1.0)
    alone = sw.plan(flight, "m20", 0.6, timing="fast", facing="forward")
    assert found.timing.total < 0.95 * alone.timing.total


def test_harder_is_sooner() -> None:
    totals = [
        sw.plan(
            "curb-015", "a1_wheeled_x", timing="fast", weights={"aggressiveness": a}
        ).timing.total
        for a in (0.0, 0.5, 1.0)
    ]
    assert totals[0] > 1.2 * totals[1] > 1.2 * totals[2]


def test_joints_and_wheels_keep_their_speeds(fast: Plan) -> None:
    robot = fast.robot_description
    time = np.array([pose.time for pose in fast.poses])
    joints = np.diff([pose.q for pose in fast.poses], axis=0) / np.diff(time)[:, None]
    wheels = np.diff([pose.wheel_progress for pose in fast.poses], axis=0) / np.diff(time)[:, None]
    assert np.abs(joints).max() < 0.5 * robot.leg_speed
    assert np.abs(wheels).max() < 0.9 * robot.wheel_speed * robot.wheel.radius


def _damped(wheels: float) -> sw.Robot:
    """An A1 whose wheels' joints have that damping [Nm s/rad]."""
    robot = sw.load_robot("a1_wheeled").model_dump() | {"schema": "stairwright/robot/2"}
    wheel = robot["actuators"]["wheel"] | {"damping": wheels}
    return sw.load_robot(robot | {"actuators": robot["actuators"] | {"wheel": wheel}})


def test_damping_of_the_joints_leaves_torque() -> None:
    """About half of what a wheel's motor has at its speed goes into damping."""
    robot, motor = _damped(2.0), _damped(2.0).actuators.wheel
    plan = sw.plan("curb-015", robot, timing="fast")
    time = np.array([pose.time for pose in plan.poses])
    along = np.array([pose.wheel_progress for pose in plan.poses])
    speeds = np.abs(np.diff(along, axis=0) / np.diff(time)[:, None]) / robot.wheel.radius
    there = motor.torque * (1.0 - speeds.max() / motor.speed)
    assert 0.4 * there < 2.0 * speeds.max() < 0.6 * there  # between poses a little more


@pytest.mark.slow
@pytest.mark.parametrize("damping", [0.5, 2.0])
def test_robots_with_damped_wheels_are_as_fast_as_planned(damping: float) -> None:
    """They fell behind their plans, and off a ramp."""
    ramp = {"points": [(-1.0, 0), (0, 0), (0.6, 0.35), (1.2, 0.35)]}
    run = sw.rollout(sw.plan(ramp, _damped(damping), timing="fast"))
    assert run.success, run.reason


def test_wheels_meet_risers_gently(fast: Plan) -> None:
    path = wheel_path(fast.terrain, fast.robot_description.wheel.radius)
    time = np.array([pose.time for pose in fast.poses])
    most = Pace.of(fast.weights["aggressiveness"]).impact_speed
    places = np.array([pose.wheel_progress for pose in fast.poses])
    met = [np.interp([c - 0.01, c], wheel, time) for c in path.corners for wheel in places.T]
    speeds = 0.01 / np.diff(met)[:, 0]
    assert len(speeds) == 6
    assert 0.5 * most < speeds.max() < 1.05 * most


def test_speeds_of_poses_far_apart_rise_evenly() -> None:
    grid = np.linspace(0.0, 1.0, 401)
    stairs = np.floor(grid / 0.034) * 0.034  # one speed between two poses
    once = evened(grid, stairs, 0.05)
    ripple, bursts = (
        np.ptp(np.gradient(each, grid)[60:-60]) for each in (evened(grid, once, 0.05), once)
    )
    assert ripple < 0.05 < 0.15 < bursts


def test_motion_leaves_what_a_thin_com_margin_has(
    steady: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A fifth of it may go, however thin it is."""
    times, pace = [], Pace.of(1.0)
    for com in (1e-6, 0.015, 1.0):
        monkeypatch.setattr(Pace, "of", lambda _, com=com: replace(pace, com=com))
        times.append(TimingProblem.of(steady, 1.0).least_time())
    assert times[0] < times[1] < times[2] < 3.0 * times[0]


@pytest.fixture
def reckless(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """Plans driven far harder than what the certificate allows."""
    pace = Pace(0.9, 0.015, 30.0, 300.0, 2000.0, 90.0, 30.0, 9.0)
    monkeypatch.setattr(Pace, "of", lambda _: pace)
    return monkeypatch


def test_however_hard_it_is_driven_the_certificate_holds(reckless: pytest.MonkeyPatch) -> None:
    """Also where it takes many rounds of slowing down: here each one hardly slows."""
    reckless.setattr(timing, "_SLOWER", 0.985)
    plan = sw.plan("three-stairs-up", "a1_wheeled_x", timing="fast")
    assert plan.feasible
    assert plan.certificate.passed


@pytest.mark.slow
def test_where_places_are_not_enough_all_is_slowed_down(reckless: pytest.MonkeyPatch) -> None:
    in_places = sw.plan("three-stairs-up", "a1_wheeled_x", timing="fast")
    reckless.setattr(timing, "_LOCAL", 0)
    everywhere = sw.plan("three-stairs-up", "a1_wheeled_x", timing="fast")
    assert everywhere.certificate.passed
    assert everywhere.timing.total > in_places.timing.total


def test_slowing_down_reaches_the_poses_next_to_one(steady: Plan) -> None:
    """The certificate takes straight lines from pose to pose, however far they are apart."""
    problem = TimingProblem.of(steady, 1.0)
    squares = fastest(problem)
    times = problem.pose_times(squares)
    longest = int(np.diff(times).argmax())
    flags = np.arange(len(times)) == longest
    slow_down(problem, {"balance": flags}, squares)
    low, high = problem.poses[[longest, longest + 1]]
    between = (problem.motion.position >= low) & (problem.motion.position <= high)
    assert between.any()
    assert np.allclose(problem.limits.caps["balance"][between], 0.64 * squares[between])
    assert np.isinf(problem.limits.caps["balance"]).any()


def test_where_an_edge_down_may_come_sooner_it_takes_twice_the_time() -> None:
    down = sw.plan(stair(0.12, 0.4, 1, direction="down"), "a1_wheeled_x", diagnose=False)
    problem = TimingProblem.of(down, 0.5)
    path = wheel_path(down.terrain, down.robot_description.wheel.radius)
    freely = fastest(problem)
    slow_down_at_drops(problem, path, 1.0)
    slowly = fastest(problem)
    drop = path.normals(problem.motion.values[:, 0])
    drops = (drop[:, 0] > 0.0) & (drop[:, 1] < 0.4)
    assert drops.any()
    assert (slowly[drops] <= 0.25 * freely[drops] * (1.0 + 1e-9)).all()
    np.testing.assert_allclose(slowly[:20], freely[:20], rtol=1e-6)


def test_with_a_tolerance_it_is_slow_wherever_faces_may_be(steady: Plan) -> None:
    problem = TimingProblem.of(steady, 0.5)
    freely, position = fastest(problem), problem.motion.position
    slow_down_nearby(problem, 0.02)
    slowly = fastest(problem)
    middle = (position > position[0] + 0.3) & (position < position[-1] - 0.3)
    for at in np.flatnonzero(middle):
        near = np.abs(position - position[at]) < 0.0199
        assert slowly[at] <= freely[near].min() * (1.0 + 1e-9)
    # It starts as it did: what holds it back there is rest, which is at no other place.
    np.testing.assert_allclose(slowly[:5], freely[:5], rtol=1e-6)
    sooner = hastened(steady, 0.5)[0].timing.total
    tolerant = steady.model_copy(update={"tolerance": Tolerance(place=0.02)})
    assert sooner < hastened(tolerant, 0.5)[0].timing.total < 1.5 * sooner


def test_inertia_tips_nothing(fast: Plan) -> None:
    """On single faces: the zero-moment point stays between the contacts."""
    time = np.array([pose.time for pose in fast.poses])
    even = np.arange(0.0, time[-1], 0.02)
    columns = np.array([(*pose.com, pose.pitch) for pose in fast.poses]).T
    window = np.hanning(9) / np.hanning(9).sum()
    x, z, _ = (np.convolve(np.interp(even, time, c), window, "same") for c in columns)
    ax, az = (np.gradient(np.gradient(c, 0.02), 0.02) for c in (x, z))
    contacts = np.array([[np.interp(even, time, [p.contacts[k][i] for p in fast.poses])
                          for i in range(2)] for k in range(2)])  # fmt: skip
    level = np.abs(contacts[0, 1] - contacts[1, 1]) < 1e-6
    level[:8] = level[-8:] = False
    height = z - contacts[1, 1]
    zmp = x - height * ax / (G + az)
    assert level.sum() > 20
    assert (zmp[level] < contacts[0, 0][level]).all()
    assert (zmp[level] > contacts[1, 0][level]).all()


def test_bad_questions_name_the_field() -> None:
    with pytest.raises(InputError) as error:
        sw.plan("flat", timing="quick")  # type: ignore[arg-type]
    assert error.value.field == ("timing",)
    with pytest.raises(InputError) as error:
        sw.plan("flat", method="critical", timing="fast")
    assert error.value.field == ("timing",)
    with pytest.raises(InputError) as error:
        sw.plan("flat", timing="fast", weights={"aggressiveness": 2.0})
    assert error.value.field == ("weights", "aggressiveness")


def test_an_impossible_terrain_is_told_all_the_same() -> None:
    wall = sw.Terrain(points=[(-1, 0), (0, 0), (0, 1.2), (2, 1.2)])
    plan = sw.plan(wall, timing="fast", diagnose=False)
    assert not plan.feasible
    assert plan.timing.limits is None


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "go2w"])
def test_it_rolls_out_sooner(robot: str) -> None:
    steady = sw.rollout(sw.plan("curb-015", robot))
    fast = sw.rollout(sw.plan("curb-015", robot, timing="fast"))
    assert fast.outcome == steady.outcome == "success"
    assert fast.metrics.speed_stairs is not None
    assert steady.metrics.speed_stairs is not None
    assert fast.metrics.speed_stairs > 2.0 * steady.metrics.speed_stairs
