"""Plans with fast timing: the same path, sooner, within limits that are computed here anew."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import stairwright as sw
from stairwright.errors import InputError
from stairwright.planning.plan import Plan

Floats = NDArray[np.float64]
G = 9.81


@pytest.fixture(scope="module")
def steady() -> Plan:
    return sw.plan("three-stairs-up", "a1_wheeled_x")


@pytest.fixture(scope="module")
def fast() -> Plan:
    return sw.plan("three-stairs-up", "a1_wheeled_x", timing="fast")


def test_the_path_is_the_same_and_sooner(steady: Plan, fast: Plan) -> None:
    still = {"time": 0.0}
    same = [pose.model_copy(update=still) for pose in steady.poses]
    assert [pose.model_copy(update=still) for pose in fast.poses] == same
    assert fast.poses[0].time == 0.0
    assert (np.diff([pose.time for pose in fast.poses]) > 0.0).all()
    assert fast.timing.total == fast.poses[-1].time < steady.timing.total / 2.0
    assert fast.id != steady.id
    assert fast.timing.limits is not None
    assert len(fast.timing.limits) == len(fast.poses)
    assert steady.timing.limits is None


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
    assert np.abs(wheels).max() < 0.65 * robot.wheel_speed * robot.wheel.radius


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


def test_momentum_is_that_of_the_simulator(fast: Plan) -> None:
    import mujoco

    from stairwright.planning.poses.interpolation import reference
    from stairwright.planning.timing.moving_robot import moving_robot
    from stairwright.robot.mujoco_model import build_spec

    robot = fast.robot_description
    motion = moving_robot(reference(fast, joint_rate=None), robot)
    spec = build_spec(robot, fast.terrain, 0.6, half_width=1.0, visual=False)
    model = spec.compile()
    data = mujoco.MjData(model)
    speed = 0.3
    for i in range(40, len(motion.way) - 40, 97):
        (q, dq, _), (body, dbody, _) = motion.joints, motion.trunk
        (_, wheel, _) = motion.wheels
        data.qpos[:3] = body[i, 0], 0.0, body[i, 1]
        data.qpos[3:7] = np.cos(body[i, 2] / 2), 0.0, np.sin(body[i, 2] / 2), 0.0
        turn = np.zeros(12)
        rate = np.zeros(12)
        for leg in range(4):
            k = leg // 2
            turn[3 * leg : 3 * leg + 2] = q[i, 2 * k : 2 * k + 2]
            rate[3 * leg : 3 * leg + 2] = dq[i, 2 * k : 2 * k + 2]
            # The wheel's own joint turns against the calf.
            carried = dbody[i, 2] + dq[i, 2 * k] + dq[i, 2 * k + 1]
            rate[3 * leg + 2] = wheel[i, k] / robot.wheel.radius - carried
        data.qpos[7:], data.qvel[6:] = turn, speed * rate
        data.qvel[:3] = speed * dbody[i, 0], 0.0, speed * dbody[i, 1]
        data.qvel[3:6] = 0.0, speed * dbody[i, 2], 0.0
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        mujoco.mj_subtreeVel(model, data)
        scale = robot.mass * 0.3 * speed
        assert data.subtree_angmom[1][1] == pytest.approx(
            speed * motion.momentum[0][i], abs=0.02 * scale
        )


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


@pytest.mark.parametrize("robot", ["a1_wheeled", "a1_wheeled_x", "go2w"])
def test_it_rolls_out_sooner(robot: str) -> None:
    steady = sw.rollout(sw.plan("curb-015", robot))
    fast = sw.rollout(sw.plan("curb-015", robot, timing="fast"))
    assert fast.outcome == steady.outcome == "success"
    assert fast.metrics.speed_stairs is not None
    assert steady.metrics.speed_stairs is not None
    assert fast.metrics.speed_stairs > 2.0 * steady.metrics.speed_stairs
