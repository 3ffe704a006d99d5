import casadi as ca
import numpy as np
import pytest

import stairwright as sw
from stairwright.robot import kinematics, symbolic


@pytest.mark.parametrize("name", sw.robots())
def test_symbolic_points_equal_numpy(name):
    robot = sw.load_robot(name)
    X = ca.SX.sym("X", 7)
    shape = symbolic.Shape.from_vector(symbolic.dimensions(robot))
    pose = symbolic.forward(shape, X[0], X[1], X[2], ca.vertsplit(X[3:]))
    pairs = [*pose.hips, *pose.knees, *pose.wheels]
    points = ca.Function("points", [X], [ca.vertcat(*(ca.horzcat(*pair) for pair in pairs))])
    for x in np.random.default_rng(0).uniform(-3, 3, (200, 7)):
        frames = kinematics.forward(robot, x[0], x[1], x[2], x[3:])
        expected = np.concatenate([frames.hips, frames.knees, frames.wheels])
        assert np.abs(np.array(points(x)) - expected).max() < 1e-12


def test_dimensions_follow_the_description():
    robot = sw.load_robot("a1_wheeled")
    values = dict(zip(symbolic.DIMENSIONS, symbolic.dimensions(robot), strict=True))
    assert values["front_thigh"] == values["rear_thigh"] == robot.thigh.length
    assert values["half_length"] == robot.trunk.size[0] / 2
