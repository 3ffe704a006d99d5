"""Clearances of a leg at all wheel samples at once against those of one link after another."""

import numpy as np
import pytest

import stairwright as sw
from stairwright import _core

A1S = ("a1_wheeled", "a1_wheeled_x")

QUERY = 0.05


def profile(rng):
    """Stairs, slopes and slits."""
    steps = rng.choice([0.0, 0.003, 0.05, 0.3], 12), rng.uniform(-0.3, 0.3, 12)
    points = np.cumsum(np.stack(steps, axis=1), axis=0)
    ends = [[points[0, 0] - 1.5, points[0, 1]]], [[points[-1, 0] + 1.5, points[-1, 1]]]
    return np.concatenate([ends[0], points, ends[1]])


@pytest.mark.parametrize("seed", range(20))
def test_clearances_are_those_of_one_link_after_another(seed):
    rng = np.random.default_rng(seed)
    vertices = profile(rng)
    ground = _core.Terrain(vertices)
    robot = sw.load_robot(A1S[seed % 2])
    wheels = np.stack(
        [np.sort(rng.uniform(*vertices[[0, -1], 0], 40)), rng.uniform(-0.5, 0.8, 40)], axis=1
    )
    buried = 0
    for _ in range(50):
        hip, thigh = rng.uniform(-0.35, 0.35, (2, 2))
        knee = hip + thigh * robot.thigh.length / np.hypot(*thigh)
        found = _core.leg_clearances(ground, robot.native, 0, hip, knee, wheels, QUERY, -1.0)
        one = []
        for wheel in wheels:
            a, b = wheel + hip, wheel + knee
            upper = ground.link_clearance(*a, *b, robot.thigh.radius, QUERY)
            one.append(min(upper, ground.link_clearance(*b, *wheel, robot.calf.radius, QUERY)))
        one = np.array(one)
        thin = min(robot.thigh.radius, robot.calf.radius)
        buried += int((one < -thin).sum())
        # Where a link all but touches, rounding decides whether it crosses.
        sure = np.abs(one + thin) > 1e-3
        assert found[sure] == pytest.approx(one[sure], abs=1e-5)
    assert 0 < buried < 2000
