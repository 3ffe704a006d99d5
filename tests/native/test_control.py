"""The native controller: the numpy form's torques, and arguments of the wrong shape."""

from __future__ import annotations

import numpy as np
import pytest

from stairwright import _core, load_robot, load_terrain
from stairwright.control.controller import Controller
from stairwright.control.native import native_controller
from stairwright.control.setpoint import RATES, Setpoint
from stairwright.control.settings import ControllerSettings
from stairwright.terrain.wheel_path import wheel_path


def state_and_row(robot, random: np.random.Generator):
    """Any state near level, any set point near it, leaning on any face."""
    quaternion = np.array([1.0, 0.0, 0.0, 0.0]) + random.normal(0.0, 0.2, 4)
    place = np.array([random.uniform(-0.8, 0.8), 0.0, random.uniform(0.3, 0.7)])
    joints = random.normal(0.0, 1.0, 12)
    qpos = np.concatenate([place, quaternion / np.linalg.norm(quaternion), joints])
    near = place[[0, 2]] + random.normal(0.0, 0.05, 2)
    values = [random.uniform(0.5, 3.0, 2), random.normal(0.0, 1.0, 5), near, near]
    moving = [random.normal(0.0, 0.2, RATES), random.normal(0.0, 0.5, RATES)]
    forces = [[3.0, 29.0, -2.0, 27.0], [random.uniform(0.5, 1.0)]]
    row = [*values, *moving, *forces, [0.4], random.integers(0, 3, 2)]
    return qpos, random.normal(0.0, 0.5, 18), np.concatenate(row)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["a1_wheeled", "m20", "anymal_wheels"])
def test_native_controller_equals_plain(name: str) -> None:
    robot = load_robot(name)
    path = wheel_path(load_terrain("single-stair-036"), robot.wheel.radius)
    settings = ControllerSettings(solver="clarabel", beta=0.01)
    random, beside = np.random.default_rng(7), np.random.default_rng(1)
    tipped = 0
    for k in range(100):
        qpos, qvel, row = state_and_row(robot, random)
        if k % 4:  # a robot tips where its other wheels are about in their place
            native = native_controller(robot, path, 0.6, settings)
            native.step(qpos, qvel, row)
            row[:2] = native.places.reshape(2, 2).mean(axis=1) + beside.normal(0.0, 0.07, 2)
        plain = Controller(robot, path, 0.6, settings)
        native = native_controller(robot, path, 0.6, settings)
        for _ in range(3):  # memory of forces and places, too
            expected = plain.step(qpos, qvel, Setpoint.from_row(row))
            torques = native.step(qpos, qvel, row)
            np.testing.assert_allclose(native.places, plain.places, atol=1e-9)
            np.testing.assert_allclose(torques, expected, atol=1e-5, rtol=1e-5)
            assert native.pitch_integral == pytest.approx(plain.pitch_integral)
            assert native.tips == plain.tips
        tipped += native.tips
    assert 10 < tipped < 90


def test_wrong_shapes_are_refused() -> None:
    robot = load_robot("a1_wheeled")
    path = wheel_path(load_terrain("flat"), robot.wheel.radius)
    controller = native_controller(robot, path, 0.6, ControllerSettings())
    qpos, qvel, row = state_and_row(robot, np.random.default_rng(1))
    for bad in ((qpos[:-1], qvel, row), (qpos, qvel[:3], row), (qpos, qvel, row[None])):
        with pytest.raises((TypeError, ValueError)):
            controller.step(*bad)
    with pytest.raises((TypeError, ValueError)):
        _core.balance_forces(np.eye(7), np.zeros(8), np.ones(4), 100.0, np.zeros(8))
    assert np.isnan(controller.places).all()
