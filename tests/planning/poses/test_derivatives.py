"""Derivatives of the pose problem against finite differences, points against the kinematics."""

import itertools

import numpy as np
import pytest

import stairwright as sw
from stairwright import _core
from stairwright.planning.pose_search import PoseSearch
from stairwright.planning.weights import CriticalWeights
from stairwright.robot import kinematics
from stairwright.terrain.wheel_path import wheel_path
from tests.planning.drawn import random_profile

A1S = ("a1_wheeled", "a1_wheeled_x")

STEP = 1e-6


def task_at(search, y, random, links):
    rules = search.rules
    return _core.PoseTask(
        random.normal(size=7), random.uniform(0.1, 3, 7), rules.lower, rules.upper,
        0.012, 0.006, 0.0, links, (y[0] - 0.02, y[0] + 0.03),
    )  # fmt: skip


def steps():
    return itertools.product(STEP * np.eye(5), (1.0, -1.0))


def case(seed, links=True):
    """A random pose over a drawn profile where the same rows are near a step to all sides."""
    random = np.random.default_rng(seed)
    robot = sw.load_robot(A1S[seed % 2])
    path = wheel_path(random_profile(seed), robot.wheel.radius)
    search = PoseSearch(robot, path, 0.6, CriticalWeights())
    while True:
        front = random.uniform(0.6, path.length - 0.1)
        y = np.array([0.0, 0.0, random.uniform(-0.8, 0.8), front, front - random.uniform(0.1, 0.5)])
        y[:2] = path.centres(y[3:]).mean(axis=0) + random.uniform((-0.1, 0.1), (0.1, 0.35))
        task = task_at(search, y, random, links)
        if np.abs(path.pieces[:, 1][:, None] - y[3:]).min() < 1e-3:
            continue
        try:
            rows = search.problem.constraints(task, y)
            beside = [search.problem.constraints(task, y + side * d) for d, side in steps()]
        except ValueError:  # a leg does not reach
            continue
        if all(np.array_equal(rows[0], other[0]) for other in beside):
            return search, task, y, rows


@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("seed", range(12))
def test_gradients(seed, links):
    search, task, y, (labels, values, gradients, least) = case(seed, links)
    assert len(labels) > 3
    assert least <= values.min() + 1e-12
    for k, step in enumerate(STEP * np.eye(5)):
        ahead, behind = (search.problem.constraints(task, y + side * step)[1] for side in (1, -1))
        assert np.allclose(gradients[:, k], (ahead - behind) / (2 * STEP), atol=1e-5)


@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("seed", range(12))
def test_hessian_of_the_lagrangian(seed, links):
    search, task, y, (labels, *_) = case(seed, links)
    multipliers = np.random.default_rng(seed).uniform(0, 2, len(labels))

    def slope(at):
        g, H = search.problem.lagrangian(task, at, multipliers)
        return g - search.problem.constraints(task, at)[2].T @ multipliers, H

    _, H = slope(y)
    for k, step in enumerate(STEP * np.eye(5)):
        column = (slope(y + step)[0] - slope(y - step)[0]) / (2 * STEP)
        assert np.allclose(H[k], column, atol=1e-4 * (1 + np.abs(H).max()))
    assert np.allclose(H, H.T)


@pytest.mark.parametrize("seed", range(10))
def test_points_are_those_of_the_kinematics(seed):
    search, _, y, _ = case(seed, links=False)
    points, q = search.problem.points(y)
    x, z, pitch = (np.asarray(v) for v in y[:3])
    frames = kinematics.forward(search.robot, x, z, pitch, q)
    centre = kinematics.com(search.robot, x, z, pitch, frames)
    expected = np.concatenate([frames.hips, frames.knees, frames.wheels, centre[None]])
    assert np.allclose(points, expected, atol=1e-12)
    assert np.allclose(frames.wheels, search.path.centres(y[3:]), atol=1e-12)
    record = search.problem.pose_records(0.6, y[None], q[None])
    collision = kinematics.collision_points(search.robot, x, z, pitch, q)
    assert np.allclose(record["collision_points"][0], collision, atol=1e-12)


@pytest.mark.parametrize("name", A1S)
def test_standing_joints(name):
    robot = sw.load_robot(name)
    path = wheel_path(sw.load_terrain("flat"), robot.wheel.radius)
    search = PoseSearch(robot, path, 0.6, CriticalWeights())
    assert search.standing == pytest.approx(kinematics.standing_joints(robot), abs=1e-12)
