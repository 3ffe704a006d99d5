"""Times of a path's poses: limits, calm accelerations, other speeds."""

from __future__ import annotations

import numpy as np
import pytest

from stairwright import load_robot
from stairwright.planning.path.timing import pose_times
from stairwright.robot import kinematics

ROBOT = load_robot("a1_wheeled")
STANDING = kinematics.standing_joints(ROBOT)


def stop_and_go(margin: float, speed: float = 0.3):
    """Times of a robot on the flat whose trunk runs ahead of its wheels and waits for them."""
    s = np.repeat(np.linspace(0.0, 1.0, 300)[:, None], 2, axis=1)
    x = s[:, 0] + 0.03 * np.sin(4 * np.pi * s[:, 0])
    body = np.column_stack([x, np.full(300, ROBOT.nominal_height), np.zeros(300)])
    centres = s + np.array([0.1235, -0.1235])
    wheels = np.stack([centres, np.full_like(s, ROBOT.wheel.radius)], axis=-1)
    q = kinematics.inverse(ROBOT, body[:, 0], body[:, 1], body[:, 2], wheels)
    return pose_times(ROBOT, s, body, q, np.full(300, margin), np.full(300, 0.3), speed), x


def test_accelerations_stay_within_the_margin() -> None:
    margin = 0.02
    times, x = stop_and_go(margin)
    wide, _ = stop_and_go(0.5)
    assert times[-1] > 1.02 * wide[-1]
    even = np.arange(0.3, times[-1] - 0.3, 0.05)
    acceleration = np.diff(np.interp(even, times, x), 2) / 0.05**2
    sway = ROBOT.nominal_height * np.abs(acceleration) / 9.81
    assert np.percentile(sway, 95) < 0.7 * margin


def test_a_straight_drive_keeps_its_speed() -> None:
    n = 200
    s = np.repeat(np.linspace(0.0, 1.0, n)[:, None], 2, axis=1)
    body = np.column_stack([s[:, 0], np.full(n, ROBOT.nominal_height), np.zeros(n)])
    times = pose_times(
        ROBOT, s, body, np.tile(STANDING, (n, 1)), np.full(n, 0.1), np.full(n, 0.3), 0.2
    )
    assert (np.diff(times) > 0).all()
    middle = slice(n // 3, 2 * n // 3)
    assert np.diff(s[:, 0])[middle] / np.diff(times)[middle] == pytest.approx(0.2, rel=0.02)
