"""Legs that fit ground which is not as drawn."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright import _core
from stairwright.arrays import Floats
from stairwright.control.setpoint import COM, FORCES, JOINTS, PITCH, TRUNK, WIDTH
from stairwright.robot import kinematics
from stairwright.robot.description import Robot

PLACE = np.array([0.1, 0.3])  # of the trunk [m]
PITCH_UP = -0.3  # rad


def planned_row(robot: Robot, reach: float) -> Floats:
    """A set point with knees at `reach` of their range: 0 straight, 1 folded."""
    row = np.zeros(WIDTH)
    for pair, leg in enumerate(robot.legs):
        low, high = sorted(leg.limits.calf, key=abs)
        calf = low + reach * (high - low)
        row[JOINTS.start + 2 * pair : JOINTS.start + 2 * pair + 2] = -0.5 * calf - PITCH_UP, calf
    row[PITCH], row[TRUNK], row[COM] = PITCH_UP, PLACE, PLACE
    row[FORCES] = 0.0, 50.0, 0.0, 50.0
    return row


def wheels(robot: Robot, row: Floats) -> Floats:
    """(2, 2) where the row puts the wheels [m]."""
    x, z = row[TRUNK]
    pitch = np.asarray(row[PITCH])
    return kinematics.forward(robot, np.asarray(x), np.asarray(z), pitch, row[JOINTS]).wheels


def fitted(robot: Robot, row: Floats, ground: Floats) -> Floats:
    """The row long after the ground has become another one."""
    fit = _core.LegFit(robot.native)
    for _ in range(1000):
        out = fit.fit(row, ground, 0.01)
    return np.asarray(out)


@pytest.mark.parametrize("name", ["a1_wheeled", "a1_wheeled_x", "b2w"])
@pytest.mark.parametrize("reach", [0.02, 0.5, 0.98])
@pytest.mark.parametrize("apart", [(0.03, 0.0), (-0.03, 0.0), (0.0, 0.02), (0.02, -0.02)])
def test_wheels_are_on_their_ground(name: str, reach: float, apart: tuple[float, float]) -> None:
    """Also where a leg is too short or too folded for a trunk that stays: the trunk gives way."""
    robot = sw.load_robot(name)
    row = planned_row(robot, reach)
    ground = np.array([apart, np.negative(apart)])
    out = fitted(robot, row, ground)
    assert wheels(robot, out) == pytest.approx(wheels(robot, row) + ground, abs=1e-3)
    assert out[PITCH] == PITCH_UP
    assert out[COM] - row[COM] == pytest.approx(out[TRUNK] - row[TRUNK])


def test_the_trunk_stays_where_the_legs_reach() -> None:
    """Both pairs carry the same: the mass centre stays in the middle between them."""
    robot = sw.load_robot("a1_wheeled_x")
    row = planned_row(robot, 0.5)
    out = fitted(robot, row, np.array([[0.02, 0.01], [-0.02, -0.01]]))
    assert out[TRUNK] == pytest.approx(PLACE, abs=1e-6)
