"""A robot with its own sensors that carries what nobody has told its planner of."""

import pytest

import stairwright as sw
from stairwright.control.settings import parse_settings
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.replanning import laden
from stairwright.simulation.run import Run

OWN = {"sensing": "robot"}


def weighed(name: str, **deviations: object) -> tuple[float, float] | None:
    """Mass [kg] and place ahead of the trunk point [m] of the load that the robot finds, if any."""
    plan = sw.plan("flat", name, friction=0.6)
    deviation = Disturbance.model_validate(deviations)
    run = Run(plan, 0.6, parse_settings(OWN), deviation, 1, 20.0)
    for _ in range(4):
        if run.native is not None and run.native.load is None:
            run._chunk(moving=False)
    return run.native.load if run.native is not None else None


def test_a_load_and_its_place_are_found_while_the_robot_stands() -> None:
    found = weighed("go2w", payload={"mass": 4.0, "place": [-0.1, 0.0, 0.15]})
    assert found is not None
    assert found[0] == pytest.approx(4.0, abs=0.1)
    assert found[1] == pytest.approx(-0.1, abs=0.03)


def test_what_motors_may_be_wrong_by_is_no_load() -> None:
    for scale in (-0.05, 0.05):
        assert weighed("a1_wheeled", torque_scale=scale, mass=0.04) is None


def test_a_load_lies_on_top_beside_the_payload_that_is_known() -> None:
    robot = sw.load_robot("a1_wheeled")
    once = laden(robot, 2.0, 0.05, 0.0)
    twice = laden(once, 2.0, -0.05, 0.0)
    assert once.payload is not None
    assert twice.payload is not None
    assert twice.mass == pytest.approx(robot.mass + 4.0)
    assert twice.payload.place[0] == pytest.approx(0.0)
    assert twice.payload.place[1] == once.payload.place[1] > robot.body.top(0.0)[1]


@pytest.mark.slow
def test_a_load_is_planned_for_before_the_start() -> None:
    """With the plan for the empty robot it tips forward on the way down."""
    plan = sw.plan("three-stairs-up-down", "go2w", friction=0.6)
    load = {"payload": {"mass": 3.0, "place": [0.25, 0.0, 0.12]}}
    found = sw.rollout(plan, controller=OWN, disturbance=load)
    assert found.outcome == "success", found.reason


@pytest.mark.slow
def test_no_plan_for_the_load_means_not_to_start() -> None:
    plan = sw.plan("single-stair-036", "go2w", friction=0.6)
    load = {"payload": {"mass": 20.0, "place": [0.25, 0.0, 0.12]}}
    found = sw.rollout(plan, controller=OWN, disturbance=load)
    assert found.outcome == "stopped", found.reason
    assert "kg more than the plan is for" in found.reason
    assert found.metrics.progress < 0.02
    assert found.metrics.link_contacts == 0
