"""A robot with its own sensors that carries what nobody has told its planner of."""

import math

import numpy as np
import pytest

import stairwright as sw
from stairwright.control.settings import parse_settings
from stairwright.robot.kinematics import com, forward, standing_joints
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.replanning import balanced_at, laden
from stairwright.simulation.run import Run
from stairwright.terrain.stairs import stair

OWN = {"sensing": "robot"}

Place = tuple[float, float]


def weighed(name: str, **deviations: object) -> tuple[float, Place, Place] | None:
    """Mass [kg] and place [m] of the load that the robot finds, or the shift of its own [m]."""
    plan = sw.plan("flat", name, friction=0.6)
    deviation = Disturbance.model_validate(deviations)
    run = Run(plan, 0.6, parse_settings(OWN), deviation, 1, 20.0)
    assert run.native is not None
    for _ in range(11):
        if run.native.load is None:
            run._chunk(moving=False)
    if run.native.load is None:
        return None
    mass, place, shift = run.native.load
    return mass, (place.x, place.z), (shift.x, shift.z)


def test_a_load_and_its_place_are_found_while_the_robot_stands() -> None:
    found = weighed("go2w", payload={"mass": 4.0, "place": [-0.1, 0.0, 0.15]})
    assert found is not None
    assert found[0] == pytest.approx(4.0, abs=0.1)
    assert found[1] == (pytest.approx(-0.1, abs=0.02), pytest.approx(0.15, abs=0.03))


@pytest.mark.parametrize("shift", [(0.015, 0.0), (-0.01, 0.02), (0.0, -0.02)])
def test_a_shifted_mass_centre_is_found_by_a_nod(shift: Place) -> None:
    found = weighed("a1_wheeled", com_x=shift[0], com_z=shift[1], mass=0.05, delay=0.004)
    assert found is not None
    assert found[0] == 0.0
    assert found[2] == (pytest.approx(shift[0], abs=0.002), pytest.approx(shift[1], abs=0.005))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["m20", "anymal_wheels"])
def test_legs_that_swing_together_are_no_shift(name: str) -> None:
    """Knees that bend both ways move along with the nod: what moves them is no force of weight."""
    assert weighed(name) is None
    found = weighed(name, com_z=0.02, delay=0.004)
    assert found is not None
    assert found[2] == (pytest.approx(0.0, abs=0.002), pytest.approx(0.02, abs=0.004))


def test_what_motors_may_be_wrong_by_is_no_load() -> None:
    for scale in (-0.05, 0.05):
        assert weighed("a1_wheeled", torque_scale=scale, mass=0.04) is None


def test_a_load_lies_where_it_was_found_beside_the_payload_that_is_known() -> None:
    robot = sw.load_robot("a1_wheeled")
    once = laden(robot, 2.0, (0.05, math.nan))
    assert once.payload is not None
    top = once.payload.place[1]
    assert top > robot.body.top(0.05)[1]
    twice = laden(once, 2.0, (-0.05, top + 0.1))
    assert twice.mass == pytest.approx(robot.mass + 4.0)
    assert twice.payload is not None
    assert twice.payload.place == pytest.approx((0.0, top + 0.05))


def test_a_robot_balanced_elsewhere_has_its_mass_centre_there() -> None:
    robot = laden(sw.load_robot("go2w"), 2.0, (0.1, 0.1))
    other = balanced_at(robot, (0.01, -0.02))
    body, q = (np.zeros(1),) * 3, standing_joints(robot)[None]
    before, after = (com(r, *body, forward(r, *body, q)) for r in (robot, other))
    assert after - before == pytest.approx(np.array([[0.01, -0.02]]))


@pytest.mark.slow
def test_a_load_is_planned_for_before_the_start() -> None:
    """With the plan for the empty robot it tips forward on the way down."""
    plan = sw.plan("three-stairs-up-down", "go2w", friction=0.6)
    load = {"payload": {"mass": 3.0, "place": [0.25, 0.0, 0.12]}}
    found = sw.rollout(plan, controller=OWN, disturbance=load)
    assert found.outcome == "success", found.reason


@pytest.mark.slow
def test_a_plan_for_where_the_mass_centre_is_replaces_one_that_it_would_tip_on() -> None:
    """An A1 with 19 mm more in height falls backward on the plan for the one that is believed."""
    plan = sw.plan(stair(0.18, 0.28, 5, approach=2.0), "a1_wheeled", friction=0.6)
    off = {"friction": -0.087, "com_z": 0.019, "delay": 0.004}
    found = sw.rollout(plan, controller=OWN, disturbance=off, seed=17)
    assert found.outcome == "success", found.reason


@pytest.mark.slow
def test_a_mass_centre_that_no_plan_is_for_means_not_to_start() -> None:
    """Knees back, an A1 has 5 mm to spare on its way down; 17 mm ahead it tips forward."""
    plan = sw.plan(stair(0.19, 0.26, 5, direction="down", approach=2.0), "a1_wheeled", friction=0.6)
    found = sw.rollout(plan, controller=OWN, disturbance={"com_x": 0.017})
    assert found.outcome == "stopped", found.reason
    assert "mass centre" in found.reason
    assert found.metrics.progress < 0.02


@pytest.mark.slow
def test_no_plan_for_the_load_means_not_to_start() -> None:
    plan = sw.plan("single-stair-036", "go2w", friction=0.6)
    load = {"payload": {"mass": 20.0, "place": [0.25, 0.0, 0.12]}}
    found = sw.rollout(plan, controller=OWN, disturbance=load)
    assert found.outcome == "stopped", found.reason
    assert "kg more than the plan is for" in found.reason
    assert found.metrics.progress < 0.02
    assert found.metrics.link_contacts == 0
