"""A robot with its own sensors that finds the world other than its plan believes."""

import numpy as np
import pytest

import stairwright as sw
from stairwright.planning.plan import Plan, Pose
from stairwright.planning.standing import StandingPose
from stairwright.simulation import plan_change, replanning
from stairwright.simulation.replanning import (
    Decision,
    after_slip,
    after_weighing,
    plan_anew,
    plan_onward,
)
from stairwright.terrain.wheel_path import wheel_path

SLIPPERY_REAR = {"friction_rear": -0.3}
OWN = {"sensing": "robot"}


@pytest.mark.slow
def test_slippery_wheels_are_found_out_and_planned_for() -> None:
    """A plan made for 0.6 asks more of the rear wheels than the 0.3 that they have."""
    plan = sw.plan("single-stair-036", "go2w", friction=0.6)
    ideal = sw.rollout(plan, controller={"sensing": "ideal"}, disturbance=SLIPPERY_REAR)
    assert ideal.outcome != "success"
    found = sw.rollout(plan, controller=OWN, disturbance=SLIPPERY_REAR)
    assert found.outcome == "success", found.reason


def test_no_plan_for_the_grip_that_is_there_means_not_to_start() -> None:
    plan = sw.plan("single-stair-036", "a1_wheeled", friction=0.6)
    everywhere = {"friction_front": -0.48, "friction_rear": -0.48}
    found = sw.rollout(plan, controller=OWN, disturbance=everywhere)
    assert found.outcome == "stopped", found.reason
    assert "slipped at a friction of 0." in found.reason
    assert found.metrics.progress < 0.02
    assert found.metrics.link_contacts == 0


@pytest.mark.parametrize("friction", [0.25, 0.5])
def test_the_friction_that_is_found_is_that_of_the_ground(
    friction: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    readings = []

    def stop(plan: Plan, need: float, found: float, *, front: bool) -> Decision:
        readings.append(found)
        return Decision(why="that is what was to be read")

    monkeypatch.setattr(plan_change, "after_slip", stop)
    plan = sw.plan("single-stair-036", "go2w", friction=0.7)
    sw.rollout(plan, friction=friction, controller=OWN)
    assert len(readings) == 1
    assert 0.94 * friction < readings[0] < 1.01 * friction


def twice_as_large(name: str) -> sw.Robot:
    """The robot `name` with twice its lengths, eight times its mass and ten times its torques."""
    data = sw.load_robot(name).model_dump(by_alias=True, exclude_none=True)
    data["name"], data["nominal_height"] = "large", 2 * data["nominal_height"]
    trunk, hips = data["trunk"], data["hips"]
    trunk["size"] = [2 * side for side in trunk["size"]]
    for piece in trunk.get("outline", []):
        piece["points"] = [(2 * x, 2 * z) for x, z in piece["points"]]
    hips["half_track"] *= 2
    for pair in ("front", "rear"):
        hips[pair] = [2 * v for v in hips[pair]]
    for body in (trunk, data["thigh"], data["calf"], data["wheel"]):
        body["mass"] *= 2**3
        body["inertia"] = [2**5 * moment for moment in body["inertia"]]
        for length in {"length", "radius", "width"} & body.keys():
            body[length] *= 2
    for link in (data["thigh"], data["calf"]):
        link["com"] = [2 * v for v in link["com"]]
    for motor in data["actuators"].values():
        motor["torque"] *= 10
    return sw.Robot.model_validate(data)


@pytest.mark.slow
def test_weak_motors_and_noise_on_long_legs_are_no_lack_of_grip() -> None:
    """The test before the start asks for 0.54, more than its calves can push."""
    curb = {"points": [(-2.5, 0.0), (0.0, 0.0), (0.0, 0.15), (4.0, 0.15)]}
    plan = sw.plan(curb, twice_as_large("anymal_wheels"), friction=0.6)
    found = sw.rollout(plan, controller=OWN)
    assert found.outcome == "success", found.reason


def test_a_plan_begins_where_the_robot_is_and_where_it_has_arrived_there_is_none() -> None:
    plan = sw.plan("curb-015", "go2w", 0.6)
    path = wheel_path(plan.terrain, plan.robot_description.wheel.radius)

    def at(pose: Pose) -> StandingPose:
        front, rear = (path.project(wheel) for wheel in pose.wheels)
        return StandingPose((front, rear), np.array([pose.x_c, pose.z_c, pose.pitch]))

    middle, end = plan.poses[len(plan.poses) // 2], plan.poses[-1]
    onward = plan_onward(plan, plan.terrain, at(middle), middle.progress)
    assert onward is not None
    assert onward.certificate is not None
    assert onward.certificate.passed
    assert onward.poses[0].progress == middle.progress
    assert abs(onward.poses[0].x_c - middle.x_c) < 0.02
    assert onward.poses[-1].x_c == pytest.approx(end.x_c, abs=1e-6)
    assert plan_onward(plan, plan.terrain, at(end), end.progress) is None


@pytest.fixture(scope="module")
def tolerant() -> Plan:
    asked = {"height": 0.005, "place": 0.005, "friction": 0.1}
    return sw.plan("single-stair-030", "go2w", 0.6, tolerance=asked)


def test_another_plan_keeps_the_tolerance(tolerant: Plan) -> None:
    anew = plan_anew(tolerant, tolerant.terrain, tolerant.friction)
    assert anew is not None
    assert anew.tolerance == tolerant.tolerance
    path = wheel_path(tolerant.terrain, tolerant.robot_description.wheel.radius)
    middle = tolerant.poses[len(tolerant.poses) // 2]
    front, rear = (path.project(wheel) for wheel in middle.wheels)
    here = StandingPose((front, rear), np.array([middle.x_c, middle.z_c, middle.pitch]))
    onward = plan_onward(tolerant, tolerant.terrain, here, middle.progress)
    assert onward is not None
    assert onward.tolerance == tolerant.tolerance


def test_friction_that_was_measured_need_not_be_doubted(tolerant: Plan) -> None:
    anew = plan_anew(tolerant, tolerant.terrain, 0.55)
    assert anew is not None
    assert anew.tolerance is not None
    assert anew.tolerance.asked == {"height": 0.005, "place": 0.005}


def test_a_plan_with_a_tolerance_is_not_given_up_for_one_without(
    tolerant: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While it holds with the mass centre where it was found."""
    without = tolerant.model_copy(update={"tolerance": None})
    monkeypatch.setattr(replanning, "plan_anew", lambda *_: without)
    nowhere = (0.0, float("nan"))
    assert after_weighing(tolerant, 0.0, nowhere, (0.002, 0.0)) == Decision()
    assert after_weighing(without, 0.0, nowhere, (0.002, 0.0)) == Decision(without)
    assert after_weighing(tolerant, 0.5, nowhere, (0.0, 0.0)) == Decision(without)
    assert after_slip(tolerant, 0.6, 0.47, front=True) == Decision()  # it was made for 0.5
    assert after_slip(without, 0.6, 0.47, front=True) == Decision(without)
    assert after_slip(tolerant, 0.6, 0.3, front=True) == Decision(without)
