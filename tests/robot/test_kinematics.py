"""Closed-form kinematics: inverse against forward, Jacobians against finite differences."""

import numpy as np
import pytest

from stairwright.library import load_robot
from stairwright.robot import kinematics as kin

ROBOTS = ["a1_wheeled", "a1_wheeled_x"]


def other_robot():
    """A robot with unequal links and raised hips: nothing may be tied to the A1's numbers."""
    data = load_robot("a1_wheeled_x").model_dump(mode="json")
    data["name"] = "other"
    data["thigh"]["length"], data["calf"]["length"] = 0.26, 0.22
    data["hips"]["front"], data["hips"]["rear"] = [0.2, -0.03], [-0.2, 0.03]
    return load_robot(data)


def all_robots():
    return [*map(load_robot, ROBOTS), other_robot()]


def random_poses(robot, n, seed):
    rng = np.random.default_rng(seed)
    low, high = kin.limits(robot).T
    trunk = rng.uniform(-1, 1, (n, 3))
    return *trunk.T, rng.uniform(low, high, (n, 4))


@pytest.mark.parametrize("robot", all_robots(), ids=lambda r: r.name)
def test_inverse_undoes_forward(robot):
    x, z, pitch, q = random_poses(robot, 500, 1)
    wheels = kin.forward(robot, x, z, pitch, q).wheels
    again = kin.inverse(robot, x, z, pitch, wheels)
    assert again == pytest.approx(q, abs=1e-6)


def test_signs_of_the_contract():
    robot = load_robot("a1_wheeled")
    level = kin.forward(robot, 0.0, 1.0, 0.0, np.zeros(4))
    assert level.wheels[0] == pytest.approx([0.1235, 0.6])  # zero is straight down
    back = kin.forward(robot, 0.0, 1.0, 0.0, np.array([0.5, 0, 0, 0]))
    assert back.wheels[0, 0] < level.wheels[0, 0]  # positive thigh swings the leg backward
    nose_up = kin.hips(robot, 0.0, 1.0, -0.3)
    assert nose_up[0, 1] > nose_up[1, 1]  # nose-up is negative pitch


def test_standing_pose():
    robot = load_robot("a1_wheeled")
    q = kin.standing_joints(robot)
    assert q == pytest.approx([0.8, -1.6, 0.8, -1.6], abs=0.02)
    frames = kin.forward(robot, 0.0, robot.nominal_height, 0.0, q)
    assert frames.wheels[:, 1] == pytest.approx([0.05, 0.05])


def test_out_of_reach_is_nan():
    robot = load_robot("a1_wheeled")
    q = kin.inverse(robot, 0.0, 1.0, 0.0, np.array([[0.1, 0.0], [-0.1, 0.9]]))
    assert np.isnan(q[1])
    assert np.isfinite(q[3])


def test_com_is_the_mass_weighted_mean():
    robot = load_robot("a1_wheeled")
    q = np.zeros(4)
    frames = kin.forward(robot, 0.0, 0.0, 0.0, q)
    z = -4 * (0.70 * 0.05 + 0.65 * 0.35 + 0.15 * 0.4) / 11.84
    assert kin.com(robot, 0.0, 0.0, 0.0, frames) == pytest.approx([0.0, z])


def test_collision_points_lie_on_trunk_and_links():
    robot = load_robot("a1_wheeled")
    points = kin.collision_points(robot, 0.0, 0.0, 0.0, np.zeros(4))
    assert points.shape == (25, 2)
    assert points[:9, 1].min() == pytest.approx(-0.057)
    assert points[9:17, 0] == pytest.approx(0.1235)
    assert points[16, 1] == pytest.approx(-0.36)
