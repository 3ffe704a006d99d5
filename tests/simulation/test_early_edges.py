"""Edges that lead down and are not where the robot's map has them."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright.control.settings import parse_settings
from stairwright.robot.kinematics import forward
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.record import PLACES
from stairwright.simulation.run import Run
from stairwright.terrain.wheel_path import WheelPath, wheel_path

EARLY = Disturbance(face_place_error=[0.03, -0.03])
ROUND = 0.024  # m round its edge; by its height alone a wheel knows that at 25 to 34 mm


def edge_down(path: WheelPath) -> float:
    """Where on the curve the edge of the box begins [m]."""
    x, z = path.vertices[3]
    return path.project(np.array([x, z + path.radius]))


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "go2w"])
def test_it_is_noticed_by_the_way_that_the_wheel_takes(robot: str) -> None:
    points = [(-1.3, 0.0), (0.0, 0.0), (0.0, 0.1), (0.6, 0.1), (0.6, -0.06), (2.0, -0.06)]
    plan = sw.plan({"points": points}, robot, 0.6)
    run = Run(plan, 0.6, parse_settings({}), EARLY, 0, 50.0)
    assert run.result(run.simulate(None), keep_plan=False).success
    assert run.native is not None
    series, drawn = run.recorder.series(), run.path
    real = wheel_path(run.physics.terrain, drawn.radius)
    (x, _, z), q = series.base_position.T, series.q[:, [0, 1, 6, 7]]
    centres = forward(run.robot, x, z, series.pitch, q).wheels[:, 0]
    truly = np.array([real.project(centre) for centre in centres]) - edge_down(real)
    believed = run.native.samples(0, 1)[:, PLACES][:, :2].min(axis=1) - edge_down(drawn)
    assert truly[np.argmax(believed > 0.0)] < ROUND


@pytest.mark.slow
def test_wheels_round_one_are_called_back() -> None:
    """Two low steps down, the second one 6 cm nearer than drawn: those that are not all collide."""
    points = [(-1.3, 0.0), (0.35, 0.0), (0.35, -0.17), (0.7, -0.17), (0.7, -0.34), (2.2, -0.34)]
    plan = sw.plan({"points": points}, "a1_wheeled", 0.6)
    runs = [Run(plan, 0.6, parse_settings({}), EARLY, seed, 50.0) for seed in (0, 3, 4)]
    assert any(run.result(run.simulate(None), keep_plan=False).success for run in runs)
