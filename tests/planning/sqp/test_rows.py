"""Derivatives of the pose problem against finite differences, values against the CasADi form."""

import numpy as np
import pytest

import stairwright as sw
from stairwright.planning.pose_search import PoseSearch
from stairwright.planning.sqp import model
from stairwright.planning.sqp import rows as r
from stairwright.planning.sqp.gaps import collect
from stairwright.planning.sqp.state import com, make_body, new_state, place
from stairwright.planning.weights import CriticalWeights
from stairwright.robot import kinematics
from stairwright.terrain.wheel_path import wheel_path
from tests.planning.drawn import random_profile

STEP = 1e-6


def problem(seed, links=True):
    """A random pose over a drawn profile, away from the curve's kinks."""
    random = np.random.default_rng(seed)
    robot = sw.load_robot(sw.robots()[seed % 2])
    path = wheel_path(random_profile(seed), robot.wheel.radius)
    search = PoseSearch(robot, path, 0.6, CriticalWeights())
    state = new_state(search.body, links)
    while True:
        front = random.uniform(0.6, path.length - 0.1)
        y = np.array([0.0, 0.0, random.uniform(-0.8, 0.8), front, front - random.uniform(0.1, 0.5)])
        wheels = path.centres(y[3:])
        y[:2] = wheels.mean(axis=0) + random.uniform((-0.1, 0.1), (0.1, 0.35))
        kinks = np.abs(path.pieces[:, 1][:, None] - y[3:]).min()
        if kinks > 1e-3 and place(search.body, search.course, y, state):
            break
    rules = search.rules
    task = r.Task(
        random.normal(size=7), random.uniform(0.1, 3, 7), rules.lower, rules.upper,
        0.012, 0.006, 0.0, links, y[0] - 0.02, y[0] + 0.03,
    )  # fmt: skip
    return search, task, y, state


def moved(search, task, y, rows, k):
    """Value of row `k` of `rows` at `y`, measured from its gradient's definition."""
    state = new_state(search.body, task.links)
    assert place(search.body, search.course, y, state)
    return row_value(search, task, state, rows, k)


def row_value(search, task, state, rows, k):
    kind, i, j, turn = rows.what[k]
    nx, nz, sign, offset = rows.numbers[k]
    points, centre = state.points, state.y[:2]
    if kind == r.JOINT:
        joint = {(1, 0): 0, (2, 1): 1, (3, 0): 2, (4, 3): 3}[(i, j)]
        return sign * state.q[joint] - offset
    if kind == r.PLACE:
        return sign * state.y[3 + i] - offset
    if kind == r.BEHIND:
        return points[i, 0] - state.contact[0] - offset
    if kind == r.COM:
        return sign * com(state, 0) - offset
    if kind == r.PLANE:
        return nx * points[i, 0] + nz * points[i, 1] - offset
    tip = np.array([nx, nz]) if kind == r.ACROSS and i < 0 else points[i]
    foot = centre if j < 0 else points[j]
    if kind == r.ACROSS:
        return sign * state.normals[turn] @ (tip - foot) - offset
    return np.hypot(*(tip - foot)) - offset


@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("seed", range(12))
def test_gradients(seed, links):
    search, task, y, state = problem(seed, links)
    rows = r.new_rows()
    count, least = collect(search.body, search.course, task, state, rows)
    assert count > 0
    assert least <= rows.value[:count].min() + 1e-12
    free = np.arange(5)
    A = np.empty((count, 5))
    model.gradients(state, rows, count, free, A, model.make_scratch(5))
    for k in range(count):
        assert row_value(search, task, state, rows, k) == pytest.approx(rows.value[k], abs=1e-12)
        for a in range(5):
            step = STEP * np.eye(5)[a]
            slope = moved(search, task, y + step, rows, k) - moved(search, task, y - step, rows, k)
            assert A[k, a] == pytest.approx(slope / (2 * STEP), abs=1e-5)


@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("seed", range(12))
def test_hessian_of_the_lagrangian(seed, links):
    search, task, y, state = problem(seed, links)
    rows = r.new_rows()
    count, _ = collect(search.body, search.course, task, state, rows)
    force = np.random.default_rng(seed).uniform(0, 2, count)

    def slope(at):
        moving = new_state(search.body, links)
        assert place(search.body, search.course, at, moving)
        g, H, A = np.empty(5), np.empty((5, 5)), np.empty((count, 5))
        scratch = model.make_scratch(5)
        model.lagrangian(task, moving, rows, force, count, g, H, scratch)
        model.gradients(moving, rows, count, np.arange(5), A, scratch)
        return g - A.T @ force, H

    _, H = slope(y)
    for a in range(5):
        step = STEP * np.eye(5)[a]
        column = (slope(y + step)[0] - slope(y - step)[0]) / (2 * STEP)
        assert np.allclose(H[a], column, atol=1e-4 * (1 + np.abs(H).max()))
    assert np.allclose(H, H.T)


@pytest.mark.parametrize("seed", range(10))
def test_points_are_those_of_the_kinematics(seed):
    search, _, y, state = problem(seed, links=False)
    x, z, pitch = (np.asarray(v) for v in y[:3])
    frames = kinematics.forward(search.robot, x, z, pitch, state.q)
    expected = np.concatenate([frames.hips, frames.knees, frames.wheels])
    assert np.allclose(state.points[4:10], expected, atol=1e-12)
    assert np.allclose(frames.wheels, search.path.centres(y[3:]), atol=1e-12)
    points = kinematics.collision_points(search.robot, x, z, pitch, state.q)
    assert np.allclose(state.points[10:], points, atol=1e-12)
    centre = kinematics.com(search.robot, x, z, frames)
    assert [com(state, 0), com(state, 1)] == pytest.approx(centre, abs=1e-12)


@pytest.mark.parametrize("name", sw.robots())
def test_standing_joints(name):
    robot = sw.load_robot(name)
    assert make_body(robot).standing == pytest.approx(kinematics.standing_joints(robot), abs=1e-12)
