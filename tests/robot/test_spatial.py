"""The robot's parts in three dimensions, against MuJoCo and against the planar kinematics."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stairwright.library import load_robot
from stairwright.robot import kinematics, spatial
from stairwright.robot.description import LEGS
from stairwright.robot.mujoco_model import build_model

angles = st.floats(-3.0, 3.0)


@pytest.fixture(scope="module")
def robot():
    return load_robot("a1_wheeled")


def random_states(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(3)
    quaternion = rng.normal(size=(count, 4))
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    return rng.normal(size=(count, 3)), quaternion, rng.uniform(-2, 2, (count, 12))


def test_places_equal_mujocos(robot):
    model = build_model(robot)
    data = mujoco.MjData(model)
    position, quaternion, q = random_states(30)
    bodies = spatial.place(robot, position, quaternion, q)
    for i in range(30):
        data.qpos[:] = np.concatenate([position[i], quaternion[i], q[i]])
        mujoco.mj_forward(model, data)
        for k, leg in enumerate(LEGS):
            for part, places, turns in (
                ("thigh", bodies.hips, bodies.thigh_turn),
                ("calf", bodies.knees, bodies.calf_turn),
                ("wheel", bodies.wheels, bodies.wheel_turn),
            ):
                body = data.body(f"{leg}_{part}")
                np.testing.assert_allclose(places[i, k], body.xpos, atol=1e-12)
                assert abs(turns[i, k] @ body.xquat) == pytest.approx(1.0, abs=1e-12)
        np.testing.assert_allclose(bodies.com[i], data.subtree_com[0], atol=1e-12)


@given(angles, st.lists(st.floats(-2.5, 2.5), min_size=4, max_size=4))
def test_planar_states_agree_with_the_planar_kinematics(pitch, q):
    robot = load_robot("a1_wheeled_x")
    trunk, joints = np.array([[0.3, 0.5, pitch]]), np.array([q])
    bodies = spatial.place_planar(robot, trunk, joints, np.zeros((1, 2)))
    frames = kinematics.forward(robot, *trunk[0], joints[0])
    for leg in range(4):
        np.testing.assert_allclose(bodies.wheels[0, leg, [0, 2]], frames.wheels[leg // 2])
        np.testing.assert_allclose(bodies.knees[0, leg, [0, 2]], frames.knees[leg // 2])
    points = kinematics.collision_points(robot, *trunk[0], joints[0])
    for side in (slice(0, 25), slice(25, 50)):
        np.testing.assert_allclose(bodies.points[0, side][:, [0, 2]], points, atol=1e-12)
    com = kinematics.com(robot, *trunk[0], frames)
    np.testing.assert_allclose(bodies.com[0, [0, 2]], com, atol=1e-12)
    assert bodies.com[0, 1] == pytest.approx(0.0, abs=1e-12)


def test_wheels_turn_forward_as_they_roll(robot):
    """After half a turn's distance a point at the top of the wheel is at the bottom."""
    rolled = np.array([[0.0, 0.0], [np.pi * robot.wheel.radius] * 2])
    trunk, q = np.zeros((2, 3)), np.tile(kinematics.standing_joints(robot), (2, 1))
    bodies = spatial.place_planar(robot, trunk, q, rolled)
    top = spatial.turn(bodies.wheel_turn, np.array([0.0, 0.0, 1.0]))
    np.testing.assert_allclose(top[0], [[0, 0, 1]] * 4, atol=1e-12)
    np.testing.assert_allclose(top[1], [[0, 0, -1]] * 4, atol=1e-12)
    quarter = spatial.place_planar(robot, trunk[:1], q[:1], rolled[1:] / 2)
    ahead = spatial.turn(quarter.wheel_turn, np.array([0.0, 0.0, 1.0]))
    np.testing.assert_allclose(ahead[0], [[1, 0, 0]] * 4, atol=1e-12)
