"""Plans with little to spare: they succeed, or are not called feasible."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright.control.settings import parse_settings
from stairwright.planning.certificate.certify import ROOM
from stairwright.planning.planner import plan as make_plan
from stairwright.planning.smoothing.node_margins import FIRM_GRIP, THIN_COM
from stairwright.simulation.disturbance import parse_disturbance
from stairwright.simulation.run import Run
from stairwright.terrain.stairs import stair

# Height, tread, number, friction: down short treads, knees back, where the CoM has little room.
FLIGHTS = [
    (0.197, 0.312, 2, 0.44),
    (0.101, 0.182, 3, 0.33),
    (0.106, 0.185, 2, 0.38),
]


@pytest.mark.slow
@pytest.mark.parametrize(("height", "tread", "count", "friction"), FLIGHTS)
def test_a_plan_that_is_called_feasible_succeeds(height, tread, count, friction):
    plan = sw.plan(stair(height, tread, count, direction="down"), "a1_wheeled", friction)
    if not plan.feasible:
        assert plan.problem.limit.quantity in ("friction", "calf range")
        assert plan.problem.limit.needed > plan.problem.limit.available
        return
    room = np.array([pose.margins.com for pose in plan.poses])
    grip = np.array([pose.margins.friction for pose in plan.poses])
    assert ((room >= THIN_COM - 1e-6) | (grip >= FIRM_GRIP * friction - 1e-6)).all()
    assert sw.rollout(plan).outcome == "success"  # with as little as 4 mm of CoM margin


# Direction, height, tread, number, friction, robot: plans of these tipped while one wheel was in a
# corner or on an edge.
STEADY = [
    ("up", 0.138, 0.233, 3, 0.46, "a1_wheeled"),
    ("up", 0.124, 0.224, 5, 0.31, "a1_wheeled_x"),
    ("down", 0.208, 0.197, 4, 0.65, "a1_wheeled"),
    ("down", 0.182, 0.202, 3, 0.68, "a1_wheeled"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("direction", "height", "tread", "count", "friction", "robot"), STEADY)
def test_a_wheel_in_a_corner_or_on_an_edge_tips_no_robot(
    direction, height, tread, count, friction, robot
):
    plan = sw.plan(stair(height, tread, count, direction=direction), robot, friction)
    assert plan.feasible
    assert sw.rollout(plan).outcome == "success"


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.385, 0.39])
def test_an_edge_that_a_light_wheel_nears_is_where_the_map_has_it(friction):
    """The plan leaves 7 mm; the edge after a bump of 7 cm was taken to come 1 cm early."""
    bump = [(-1.3, 0.0), (0.0, 0.0), (0.0, 0.0806), (0.0694, 0.0806), (0.0694, 0.0), (1.4, 0.0)]
    plan = sw.plan({"points": bump}, "a1_wheeled", friction)
    assert plan.feasible
    assert [sw.rollout(plan, seed=seed).outcome for seed in range(3)] == 3 * ["success"]


@pytest.mark.slow
def test_a_ramp_near_its_friction_angle_is_planned():
    """There the CoM has ample room: grip alone may be scarce."""
    run = 1.3
    points = [(-1.2, 0.0), (0.0, 0.0), (run, 0.57 * run), (run + 1.5, 0.57 * run)]
    plan = sw.plan({"points": points}, "a1_wheeled", 0.585)
    assert plan.feasible
    assert min(pose.margins.friction for pose in plan.poses) < FIRM_GRIP * plan.friction
    assert sw.rollout(plan).outcome == "success"


# Height, friction, robot: plans of these stood on the rear wheels, front ones all but unloaded,
# with so little room that they tipped over backward, or hung from an edge (1.10 m) by next to all
# the friction; they fell also where all was known to them.
WALLS = [(1.14, 0.9, "go2w"), (1.1, 0.6, "go2w"), (0.89, 0.6, "a1_wheeled"), (1.81, 0.6, "b2w")]


@pytest.mark.slow
@pytest.mark.parametrize(("height", "friction", "name"), WALLS)
def test_a_robot_that_stands_on_one_pair_of_wheels_is_not_called_feasible_to_a_hair(
    height, friction, name
):
    robot = sw.load_robot(name)
    wall = stair(height, 0.3, 1, approach=2.0 + robot.legs[0].reach, platform=3.0)
    plan = make_plan(wall, robot, friction, diagnose=False)
    if plan.feasible:
        assert sw.rollout(plan, controller={"sensing": "ideal"}).outcome == "success"


# Up walls by its own sensors an A1 touched with a calf, where the robot's place drifted along the
# wall; slid off the edge, where its wheels crept back as they waited there; touched with the trunk,
# whose clearance fell to 0.3 mm between poses.
HIGH = [(0.825, 0.4), (0.725, 0.8), (0.65, 0.4)]


@pytest.mark.slow
@pytest.mark.parametrize(("height", "friction"), HIGH)
def test_a_wall_is_climbed_by_own_sensors(height, friction):
    plan = sw.plan(stair(height, 0.3, 1, approach=1.5, platform=3.0), "a1_wheeled", friction)
    nearest = [c for c in plan.certificate.checks if c.name.startswith("clearance")]
    assert min(check.value for check in nearest) > ROOM
    assert {sw.rollout(plan, seed=seed).outcome for seed in (0, 1)} == {"success"}


@pytest.mark.slow
def test_the_place_along_a_wall_does_not_drift_while_wheels_climb_it():
    plan = sw.plan(stair(0.825, 0.3, 1, approach=1.5, platform=3.0), "a1_wheeled", 0.4)
    run = Run(plan, 0.4, parse_settings(None), parse_disturbance(None), seed=0, record_hz=100.0)
    run.simulate(None)
    assert run.native is not None
    place = run.native.judged[:, 7]
    assert np.abs(place).max() < 0.004  # m; 0.009 before


# Up a slope of 73 degrees in front while the rear wheels climb 3.4 cm, with 8 mm for the CoM.
STEEP = [
    *[(-1.3, 0.0), (0.0, 0.0), (0.232, -0.082), (0.278, -0.097), (0.383, -0.107), (0.522, -0.109)],
    *[(0.653, -0.095), (0.786, -0.058), (0.998, -0.06), (1.104, -0.033), (1.104, 0.001)],
    *[(1.394, 0.001), (1.504, 0.376), (1.619, 0.401), (1.619, 0.46), (1.96, 0.545)],
    *[(1.963, 0.588), (2.276, 0.614), (2.345, 0.888), (2.87, 0.971), (4.17, 0.971)],
]


@pytest.mark.slow
@pytest.mark.parametrize("sensing", ["ideal", "robot"])
def test_rear_wheels_do_not_stand_in_a_corner_while_the_plan_climbs(sensing):
    plan = sw.plan({"points": STEEP}, "a1_wheeled_x", 0.6)
    assert sw.rollout(plan, controller={"sensing": sensing}).outcome == "success"


def ramp(slope: float, run: float = 1.5) -> dict[str, list[tuple[float, float]]]:
    return {"points": [(-1.5, 0.0), (0.0, 0.0), (run, run * slope), (run + 2.0, run * slope)]}


@pytest.mark.slow
@pytest.mark.parametrize("timing", ["steady", "fast"])
def test_a_ramp_that_takes_almost_all_friction_is_climbed(timing):
    plan = sw.plan(ramp(0.35 * 0.979), "d1", 0.35, timing=timing)
    assert sw.rollout(plan).outcome == "success"


@pytest.mark.slow
def test_the_longer_a_ramp_the_more_friction_it_must_leave():
    """A robot is a centimetre off per metre up it; one like this slid back from its end."""
    long = ramp(0.3 * 0.965, run=3.8)
    plan = sw.plan(long, "anymal_wheels", 0.3)
    needed = plan.problem.limit.needed
    assert plan.problem.limit.quantity == "friction"
    assert 0.3 < needed < 0.335
    enough = sw.plan(long, "anymal_wheels", needed)
    assert [sw.rollout(enough, seed=seed).outcome for seed in range(2)] == 2 * ["success"]


@pytest.mark.slow
def test_a_ramp_that_leaves_no_friction_to_roll_with_is_refused():
    plan = sw.plan(ramp(0.35 * 0.99), "d1", 0.35)
    assert plan.problem.limit.quantity == "friction"
    assert plan.problem.limit.needed == pytest.approx(0.35 * 0.99 / 0.98, rel=0.02)
