"""Legs that fit ground which is not as drawn."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

import stairwright as sw
from stairwright import _core
from stairwright.arrays import Floats
from stairwright.control.setpoint import COM, FORCES, JOINTS, PITCH, TRUNK, WHEELS, WIDTH
from stairwright.control.settings import ControllerSettings
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.simulation.governor import plan_track
from stairwright.terrain.wheel_path import WheelPath, wheel_path

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
    return kinematics.forward(robot, *row[TRUNK], row[PITCH], row[JOINTS]).wheels


def standing_on(robot: Robot, row: Floats) -> WheelPath:
    """Level ground under the wheels of `row`, which get their places on it."""
    centres = wheels(robot, row)
    low = centres[:, 1].min() - robot.wheel.radius
    path = wheel_path(sw.Terrain(points=[(-3.0, low), (3.0, low)]), robot.wheel.radius)
    row[WHEELS] = [path.project(centre) for centre in centres]
    return path


def fitted(robot: Robot, row: Floats, ground: Floats, path: WheelPath | None = None) -> Floats:
    """The row long after the ground has become another one."""
    path = path or standing_on(robot, row)
    fit = _core.LegFit(robot.native)
    for _ in range(1000):
        out = fit.fit(row, ground, path.native, 0.6, 0.01)
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


@pytest.mark.parametrize("up", [-0.01, 0.01])
def test_a_thigh_that_points_up_turns_on(up: float) -> None:
    """ANYmal's may turn all the way round; it must not turn back all the way."""
    robot = sw.load_robot("anymal_wheels").with_knees(-1, 1)
    row = planned_row(robot, 0.5)
    for thigh in (-np.pi - 0.01, -np.pi + 0.01):
        row[JOINTS] = 0.5, -1.5, thigh, 2.5
        out = fitted(robot, row, np.array([[0.0, 0.0], [up, up]]))
        assert np.abs(out[JOINTS] - row[JOINTS]).max() < 0.3


def climbing(plan: sw.Plan) -> tuple[WheelPath, Floats]:
    """The path of a plan, and its rows in which front wheels go up an upright face."""
    path = wheel_path(plan.terrain, plan.robot_description.wheel.radius)
    rows = plan_track(plan, path, ControllerSettings()).rows
    up = np.abs(path.normals(np.ascontiguousarray(rows[:, WHEELS][:, 0]))[:, 0]) > 0.99
    return path, rows[up]


def room(plan: sw.Plan, row: Floats, off: Floats) -> float:
    """Least distance of front thigh and calf from the stair, which is `off` its place [m]."""
    robot = plan.robot_description
    frames = kinematics.forward(robot, *row[TRUNK], row[PITCH], row[JOINTS])
    points = np.array([frames.hips[0], frames.knees[0], frames.wheels[0]])
    ground = shapely.LineString(np.array(plan.terrain.points) + off)
    thigh, calf = shapely.LineString(points[:2]), shapely.LineString(points[1:])
    radii = robot.thigh.radius, robot.calf.radius
    return min(ground.distance(thigh) - radii[0], ground.distance(calf) - radii[1])


def test_a_leg_that_climbs_a_face_that_came_early_keeps_off_its_edge() -> None:
    """A knee that leads its wheel comes nearer to it if the trunk goes with the load alone."""
    plan = sw.plan("stairs-us-7-11", "a1_wheeled_x", 0.6)
    robot = plan.robot_description
    path, rows = climbing(plan)
    off = np.array([[-0.045, 0.0], [0.03, 0.0]])
    with_load, fit = [], []
    for row in rows[::8]:
        share = row[FORCES][1] / (row[FORCES][1] + row[FORCES][3])
        moved = row.copy()
        moved[TRUNK] += share * off[0] + (1.0 - share) * off[1]
        x, z = moved[TRUNK]
        moved[JOINTS] = kinematics.inverse(robot, x, z, row[PITCH], wheels(robot, row) + off)
        with_load.append(room(plan, moved, off[0]))
        fit.append(room(plan, fitted(robot, row, off, path), off[0]))
    assert min(fit) > max(0.004, min(with_load) + 0.002)
    assert np.all(np.array(fit) > np.array(with_load) - 1e-6)
