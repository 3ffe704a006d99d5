"""Tables of the search: what may be shared, and what the kernels promise."""

from __future__ import annotations

import numpy as np
import pytest

from stairwright import _core
from stairwright.library import load_robot
from stairwright.planning.lattice.cells import alike
from stairwright.robot import kinematics


def stairs(n):
    corners = [(-2.0, 0.0), (0.0, 0.0)]
    for k in range(n):
        corners += [(0.4 * k, 0.2 * (k + 1)), (0.4 * (k + 1), 0.2 * (k + 1))]
    corners[-1] = (corners[-1][0] + 2.0, corners[-1][1])
    return np.array(corners)


def test_samples_on_equal_steps_are_alike():
    vertices = stairs(6)
    centres = np.array([[0.1 + 0.4 * k, 0.25 + 0.2 * k] for k in range(6)])
    kept, like = alike(vertices, centres, 0.45)
    assert like[2] == like[3]  # far from both ends of the flight
    assert like[5] != like[2]  # no step follows
    assert len(kept) == like.max() + 1


def test_level_samples_far_from_everything_are_alike():
    centres = np.stack([np.linspace(-1.4, -0.8, 7), np.full(7, 0.05)], axis=1)
    kept, like = alike(stairs(1), centres, 0.5)
    assert len(kept) == 1
    assert not like.any()


@pytest.mark.parametrize("name", ["a1_wheeled", "a1_wheeled_x"])
def test_legs_of_many_poses_are_told_apart_as_those_of_one(name):
    robot, gap = load_robot(name), 0.06
    model = _core.RobotModel(robot.native)
    rng = np.random.default_rng(11)
    bodies = rng.uniform((-0.35, 0.1, -1.2), (0.1, 0.4, 1.2), (6000, 3))
    origin, apart = np.array([40.0, 1.0]), (-0.27, 0.11)
    wheels = np.stack([origin, origin + apart])
    x, z, pitch = (bodies + np.array([*origin, 0.0])).T
    q = kinematics.inverse(robot, x, z, pitch, np.tile(wheels, (len(x), 1, 1)))
    within = np.isfinite(q).all(axis=1)  # the search asks about no others
    world = np.stack([x, z, pitch], axis=1)[within]
    least = np.array(
        [_core.legs_distance(robot.native, *one) for one in zip(world, q[within], strict=True)]
    )
    x, z, pitch = bodies[within].T
    poses = np.array([x, z, np.cos(pitch), np.sin(pitch)], np.float32)
    clear = _core.legs_clear(model, gap, *apart, poses).astype(bool)
    close = np.abs(least - gap) < 1e-5
    assert np.array_equal(clear[~close], (least >= gap)[~close])
    assert min(clear.sum(), (~clear).sum()) > 100
    assert close.sum() < 5


@pytest.mark.parametrize("height", [0.4, 2.0])
def test_a_spike_through_trunk_or_link_is_deep(height):
    ground = _core.Terrain(
        np.array([[-1.0, 0.0], [0.0, 0.0], [0.0, height], [0.0, 0.0], [1.0, 0.0]])
    )
    box = _core.Polygon(0.01 * np.array([[-12.0, -6.0], [12.0, -6.0], [12.0, 6.0], [-12.0, 6.0]]))
    assert ground.link_clearance(-0.1, 0.3, 0.1, 0.31, 0.01, 0.05) < -0.012
    assert ground.polygon_clearance(box, 0.0, 0.3, 0.0, 0.05) < -0.009
