"""A plan's commands, fed to ros2_control's rules: it takes them and follows the plan smoothly."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.export.joint_commands import (
    LEG_ACCELERATION,
    LEG_JERK,
    LEG_SPEED,
    SPEED_SHARE,
    WHEEL_ACCELERATION,
    WHEEL_JERK,
)
from stairwright.export.table import PLAN_FORMATS
from stairwright.planning.carrying import holding_torques
from stairwright.planning.plan import Plan
from stairwright.planning.poses.interpolation import reference
from stairwright.robot.description import JOINTS
from tests.export.mcap_reading import messages, metadata
from tests.export.ros2_control import accepted, field, integrated, sampled, times
from tests.export.test_retiming import distance
from tests.scene.example import example_plan

LEGS = [name for name in JOINTS if not name.endswith("wheel")]
WHEELS = [name for name in JOINTS if name.endswith("wheel")]
FOLLOWED = 1e-3  # rad
TERRACE = {
    "points": [(-1, 0), (0, 0), (0, 0.12), (0.3, 0.12), (0.3, 0.24), (1, 0.24), (1, 0), (2, 0)]
}
PLANS = {
    "stair": ("single-stair-036", "a1_wheeled_x", "path"),
    "critical": ("single-stair-030", "a1_wheeled_x", "critical"),
    "stairs": (TERRACE, "a1_wheeled", "path"),
}


@cache
def planned(name: str) -> Plan:
    terrain, robot, method = PLANS[name]
    return sw.plan(terrain, robot, method=method)


@cache
def commands(name: str, rate: float = 100.0) -> dict:
    topics = messages(PLAN_FORMATS["mcap"].write(planned(name), rate))
    wanted = ("/joint_trajectory", "/joint_trajectory_without_effort", "/wheel_trajectory")
    return {topic: topics[topic][0][1] for topic in wanted}


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANS)
def test_a_trajectory_controller_takes_them(name) -> None:
    made = commands(name)
    legs, bare = made["/joint_trajectory"], made["/joint_trajectory_without_effort"]
    assert list(legs.joint_names) == list(bare.joint_names) == LEGS
    assert accepted(legs, LEGS, effort=True)
    assert not accepted(legs, LEGS, effort=False)
    assert accepted(bare, LEGS, effort=False)
    wheels = made["/wheel_trajectory"]
    assert accepted(wheels, WHEELS, effort=False, integrate=True)
    assert not field(wheels, "positions").size
    for name_ in ("positions", "velocities", "accelerations"):
        np.testing.assert_array_equal(field(legs, name_), field(bare, name_))
    assert legs.header.stamp.sec == legs.header.stamp.nanosec == 0  # "start now"


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANS)
def test_both_ends_rest(name) -> None:
    made = commands(name)
    for end in (0, -1):
        assert not field(made["/joint_trajectory"], "velocities")[end].any()
        assert not field(made["/joint_trajectory"], "accelerations")[end].any()
        assert not field(made["/wheel_trajectory"], "velocities")[end].any()


@pytest.mark.slow
@pytest.mark.parametrize("degree", [3, 5])
@pytest.mark.parametrize("name", PLANS)
def test_limits_hold_between_the_points(name, degree) -> None:
    """Cubic or quintic: speed, acceleration and jerk of what the controller samples."""
    legs = commands(name)["/joint_trajectory"]
    assert np.abs(sampled(legs, degree, 1)).max() <= LEG_SPEED * (1 + 1e-6)
    assert np.abs(sampled(legs, degree, 2)).max() <= LEG_ACCELERATION * (1 + 1e-6)
    # Times are whole nanoseconds: a third derivative over 10 ms shows that in its seventh digit.
    assert np.abs(sampled(legs, degree, 3)).max() <= LEG_JERK * (1 + 1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANS)
def test_the_acceleration_has_no_steps(name) -> None:
    legs = commands(name)["/joint_trajectory"]
    samples = sampled(legs, 3, 2, per_segment=1).reshape(-1, 2, len(LEGS))
    assert np.abs(samples[1:, 0] - samples[:-1, 1]).max() < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANS)
def test_wheels_stay_within_their_motors(name) -> None:
    wheels, motor = commands(name)["/wheel_trajectory"], planned(name).robot_description.actuators
    speed, time = field(wheels, "velocities"), times(wheels)
    gain = np.diff(speed, axis=0) / np.diff(time)[:, None]
    assert np.abs(speed).max() <= SPEED_SHARE * motor.wheel.speed
    assert np.abs(gain).max() <= WHEEL_ACCELERATION
    assert np.abs(np.diff(gain, axis=0)).max() * 100.0 <= WHEEL_JERK * (1 + 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("degree", [3, 5])
@pytest.mark.parametrize("name", PLANS)
def test_the_plan_is_followed(name, degree) -> None:
    """What is sampled stays within a milliradian of the plan's own motion, from end to end."""
    plan, legs = planned(name), commands(name)["/joint_trajectory"]
    motion = reference(plan).q
    position = sampled(legs, degree, 0, per_segment=2)
    pairs = position[:, [0, 1, 4, 5]]
    np.testing.assert_array_equal(pairs, position[:, [2, 3, 6, 7]])  # the right legs do the same
    assert distance(motion, pairs[::3]).max() <= FOLLOWED
    np.testing.assert_allclose(pairs[0], plan.poses[0].q, atol=1e-9)
    np.testing.assert_allclose(pairs[-1], plan.poses[-1].q, atol=1e-9)
    # Nor is any of it left out.
    assert distance(pairs, motion[::7]).max() <= FOLLOWED


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANS)
def test_wheels_roll_as_far_as_planned(name) -> None:
    plan, rolled = planned(name), integrated(commands(name)["/wheel_trajectory"])
    first, last = plan.poses[0], plan.poses[-1]
    for pair, columns in ((0, [0, 1]), (1, [2, 3])):
        way = last.wheel_progress[pair] - first.wheel_progress[pair]
        turned = way / plan.robot_description.wheel.radius - (last.pitch - first.pitch)
        turned -= sum(last.q[2 * pair : 2 * pair + 2]) - sum(first.q[2 * pair : 2 * pair + 2])
        np.testing.assert_allclose(rolled[-1, columns], turned, atol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANS)
def test_efforts_hold_the_pose(name) -> None:
    plan, legs = planned(name), commands(name)["/joint_trajectory"]
    effort = field(legs, "effort")
    assert np.abs(effort).max() <= plan.robot_description.actuators.leg.torque
    no_wheels = [j for j in range(12) if j % 3 != 2]
    held = holding_torques(plan)[:, no_wheels]
    for end in (0, -1):
        np.testing.assert_allclose(effort[end], held[end], atol=0.02)
    assert np.abs(effort).max(axis=0).min() > 0.5  # Nm: none is left at nothing


@pytest.mark.slow
def test_the_rate_is_ones_choice() -> None:
    rate = 10.0
    legs = commands("stair", rate)["/joint_trajectory"]
    np.testing.assert_allclose(np.diff(times(legs)), 1 / rate, atol=2e-9)
    assert times(legs)[0] == pytest.approx(1 / rate, abs=1e-9)
    assert np.abs(sampled(legs, 5, 2)).max() <= LEG_ACCELERATION * (1 + 1e-6)
    pairs = sampled(legs, 5, 0)[:, [0, 1, 4, 5]]
    assert distance(reference(planned("stair")).q, pairs[::5]).max() <= FOLLOWED
    content = PLAN_FORMATS["mcap"].write(example_plan(count=5), rate)
    assert float(metadata(content)["rate"]) == rate


@pytest.mark.parametrize("rate", [0.0, -5.0, 9.9, 1001.0, float("nan"), float("inf")])
def test_other_rates_are_refused(rate) -> None:
    with pytest.raises(InputError, match="between 10 and 1000 Hz") as told:
        PLAN_FORMATS["mcap"].write(example_plan(count=5), rate)
    assert told.value.field == ("rate",)
    with pytest.raises(InputError, match="no rate"):
        PLAN_FORMATS["csv"].write(example_plan(count=5), 50.0)


@pytest.mark.slow
def test_slow_motors_are_not_outrun() -> None:
    plan = planned("stair")
    robot = plan.robot_description
    motors = robot.actuators.model_copy(
        update={"leg": robot.actuators.leg.model_copy(update={"speed": 0.5})}
    )
    slow = plan.model_copy(
        update={"robot_description": robot.model_copy(update={"actuators": motors})}
    )
    ((_, legs),) = messages(PLAN_FORMATS["mcap"].write(slow))["/joint_trajectory"]
    assert np.abs(sampled(legs, 5, 1)).max() <= SPEED_SHARE * 0.5 * (1 + 1e-6)
    assert times(legs)[-1] > 1.5 * times(commands("stair")["/joint_trajectory"])[-1]


def test_the_plan_itself_stays_as_it_is() -> None:
    before = planned("stair").model_dump_json()
    PLAN_FORMATS["mcap"].write(planned("stair"))
    assert planned("stair").model_dump_json() == before


@pytest.mark.slow
def test_joints_bear_the_robots_own_names() -> None:
    plan = example_plan(count=20)
    names = {"FL_thigh": "front_left/hip_pitch", "RR_wheel": "rear_right/wheel"}
    document = plan.robot_description.model_dump(mode="json")
    robot = type(plan.robot_description).model_validate({**document, "joint_names": names})
    topics = messages(
        PLAN_FORMATS["mcap"].write(plan.model_copy(update={"robot_description": robot}))
    )
    ((_, legs),), ((_, wheels),) = topics["/joint_trajectory"], topics["/wheel_trajectory"]
    assert list(legs.joint_names)[:2] == ["front_left/hip_pitch", "FL_calf"]
    assert list(wheels.joint_names) == ["FL_wheel", "FR_wheel", "RL_wheel", "rear_right/wheel"]
    state = topics["/joint_states"][0][1]
    assert [state.name[0], state.name[11]] == ["front_left/hip_pitch", "rear_right/wheel"]
    (description,) = [m.data for _, m in topics["/robot_description"]]
    assert 'joint name="front_left/hip_pitch"' in description
    assert 'joint name="FL_thigh"' not in description
