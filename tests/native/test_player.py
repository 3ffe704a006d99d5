"""The player's limits, without its process: what comes in, what goes out."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stairwright as sw
from stairwright import _core
from stairwright.export.player_plan import player_plan
from stairwright.planning.plan import Plan
from stairwright.simulation.low_level import ABDUCTION_OF, MOTOR_OF, LowLevelRobot

CURB = {"points": [[-1.3, 0], [0, 0], [0, 0.05], [1.3, 0.05]]}
DT = 0.002
# Such robots' own signs and zero angles, unlike ours.
FRAMES = {
    "FR_thigh": {"sign": -1},
    "RL_calf": {"sign": 1, "offset": -0.4},
    "FL_wheel": {"sign": -1},
}


@pytest.fixture(scope="module")
def plan() -> Plan:
    robot = sw.load_robot("go2w").model_dump(mode="json", by_alias=True) | {"joint_frames": FRAMES}
    return sw.plan(CURB, robot, friction=0.6)


def standing(plan: Plan):
    """A player and a simulated robot that stands under its control, some steps on."""
    player, robot = _core.Player(player_plan(plan)), LowLevelRobot(plan)
    for _ in range(50):
        robot.act(player.step(robot.run.time, *robot.sense()))
    assert player.phase == "settling"
    return player, robot


def only_damps(command) -> bool:
    return not command[:, [0, 1, 2, 3]].any() and bool((command[:, 4] > 0.0).all())


@pytest.mark.slow
def test_it_drives_to_the_end_and_stands_there(plan):
    player, robot = _core.Player(player_plan(plan)), LowLevelRobot(plan)
    phases = []
    while robot.run.time < 40.0 and player.phase != "arrived":
        command = player.step(robot.run.time, *robot.sense())
        assert not command[12:, 3].any()  # wheels have no position gain
        robot.act(command)
        if [player.phase] != phases[-1:]:
            phases.append(player.phase)
    assert phases == ["settling", "driving", "arrived"]
    wheels = robot.run.physics.wheels()[:, 0]
    end = np.array(plan.poses[-1].wheels)[[0, 0, 1, 1], 0]
    assert np.abs(wheels - end).max() < 0.02
    assert player.done == pytest.approx(1.0)


@pytest.mark.slow
def test_it_drives_backward(plan):
    """Motors keep their numbers and signs, the IMU its axes: the robot is built as it was."""
    own = plan.robot_description.model_dump(mode="json", by_alias=True)
    plan = sw.plan(CURB, own, friction=0.6, facing="backward")
    player, robot = _core.Player(player_plan(plan)), LowLevelRobot(plan)
    imu, motors = robot.sense()
    along, _ = LowLevelRobot(plan.model_copy(update={"facing": "forward"})).sense()
    np.testing.assert_allclose(imu, np.array([-1.0, -1.0, 1.0] * 2) * along)
    # Its own front right leg, whose thigh turns the other way by its file, comes last.
    rear_thigh = plan.poses[0].q[2]
    assert motors[1, 0] == pytest.approx(rear_thigh, abs=0.05)
    assert motors[4, 0] == pytest.approx(-rear_thigh, abs=0.05)
    while robot.run.time < 40.0 and player.phase != "arrived":
        robot.act(player.step(robot.run.time, *robot.sense()))
    assert player.phase == "arrived"


def test_torques_stay_within_the_motors_and_angles_within_the_joints(plan):
    player, robot = standing(plan)
    imu, motors = robot.sense()
    own = plan.robot_description
    limit = np.array([motor.torque for motor in own.motors])
    motors[MOTOR_OF[0], 0] -= 0.3  # a thigh that is far from where it shall be
    command = player.step(robot.run.time, imu, motors)
    q, dq, tau, kp, kd = command[MOTOR_OF].T
    total = tau + kp * (q - motors[MOTOR_OF, 0]) + kd * (dq - motors[MOTOR_OF, 1])
    assert (np.abs(total) <= limit + 1e-9).all()
    assert np.abs(total[0]) > 0.5 * limit[0]
    np.testing.assert_allclose(command[ABDUCTION_OF, 0], 0.0)
    assert (command[ABDUCTION_OF, 3] > 0.0).all()


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda imu, motors: motors.__setitem__((4, 0), np.nan), "not finite"),
        (lambda imu, motors: motors.__setitem__((5, 0), -0.2), "FL_calf stands at -0.20"),
        (lambda imu, motors: motors.__setitem__((12, 1), 60.0), "FR_wheel turns by 60.0"),
    ],
)
def test_beyond_a_limit_motors_only_damp(plan, spoil, words):
    player, robot = standing(plan)
    imu, motors = robot.sense()
    spoil(imu, motors)
    assert only_damps(player.step(robot.run.time, imu, motors))
    assert player.phase == "damped"
    assert words in player.reason
    # And it stays so.
    assert only_damps(player.step(robot.run.time + DT, *robot.sense()))


def test_a_gap_between_states_damps(plan):
    player, robot = standing(plan)
    assert only_damps(player.step(robot.run.time + 0.05, *robot.sense()))
    assert "came 0.05" in player.reason


def test_states_that_come_more_often_change_nothing(plan):
    player, robot = standing(plan)
    first = player.step(robot.run.time, *robot.sense())
    again = player.step(robot.run.time + DT / 2, *robot.sense())
    np.testing.assert_array_equal(first, again)
    assert player.step(robot.run.time + DT, *robot.sense()) is not None
    assert player.phase == "settling"


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda imu, motors: motors.__setitem__((4, 0), motors[4, 0] + 0.5), "FL_thigh stands at"),
        (lambda imu, motors: motors.__setitem__((13, 1), 3.0), "FL_wheel turns by -3.00"),
        (lambda imu, motors: imu.__setitem__(5, 20.0), "accelerometer"),
        (lambda imu, motors: imu.__setitem__(slice(3, 6), [0.0, 7.0, 7.0]), "leans sideways"),
        (lambda imu, motors: imu.__setitem__(1, 2.0), "trunk turns"),
    ],
)
def test_a_robot_that_does_not_stand_as_the_plan_begins_is_refused(plan, spoil, words):
    player, robot = _core.Player(player_plan(plan)), LowLevelRobot(plan)
    imu, motors = robot.sense()
    spoil(imu, motors)
    assert only_damps(player.step(0.0, imu, motors))
    assert player.phase == "refused"
    assert words in player.reason


def test_a_robot_that_crouches_gets_into_the_plans_first_pose(plan):
    player, robot = _core.Player(player_plan(plan)), LowLevelRobot(plan)
    run = robot.run
    leg = plan.robot_description.legs[0]
    height = run.data.qpos[2]
    for k in range(4):
        run.data.qpos[7 + 3 * k] += 0.15
        run.data.qpos[8 + 3 * k] -= 0.3
    thigh, calf = run.data.qpos[7], run.data.qpos[7] + run.data.qpos[8]
    drop = leg.thigh.length * math.cos(thigh) + leg.calf.length * math.cos(calf)
    run.data.qpos[2] = drop + leg.wheel.radius - leg.hip[1]
    assert run.data.qpos[2] < height - 0.01
    while run.time < 5.0 and player.phase != "driving":
        robot.act(player.step(run.time, *robot.sense()))
    assert player.phase == "driving"
    np.testing.assert_allclose(run.data.qpos[7:9], plan.poses[0].q[:2], atol=0.03)


@pytest.mark.slow
def test_a_pause_holds_the_plan_and_the_robot_stands(plan):
    player, robot = _core.Player(player_plan(plan)), LowLevelRobot(plan)
    while player.done < 0.3:
        robot.act(player.step(robot.run.time, *robot.sense()))
    player.pause()
    for _ in range(500):
        robot.act(player.step(robot.run.time, *robot.sense()))
    held = player.done
    for _ in range(2500):  # longer than it would wait for wheels that do not follow
        robot.act(player.step(robot.run.time, *robot.sense()))
    assert player.phase == "driving"
    assert player.done == pytest.approx(held, abs=1e-3)
    assert np.abs(robot.run.data.qvel[:3]).max() < 0.02


def test_wheels_that_slip_before_the_start_keep_the_robot_there(plan):
    player, robot = _core.Player(player_plan(plan)), LowLevelRobot(plan, friction=0.12)
    while robot.run.time < 4.0:
        robot.act(player.step(robot.run.time, *robot.sense()))
    assert player.phase == "gave up"
    assert "slipped" in player.reason
    assert player.done == 0.0
    assert np.abs(robot.run.data.qvel[:3]).max() < 0.05


def test_what_stopped_it_stays_said(plan):
    player, _ = standing(plan)
    player.damp("told to stop")
    player.damp("again")
    assert (player.phase, player.reason) == ("damped", "told to stop")
