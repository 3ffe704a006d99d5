"""Plans with little to spare: they succeed, or are not called feasible."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright.planning.path.record import FIRM_GRIP, THIN_COM
from stairwright.terrain.stairs import stair

# Height, tread, number, friction: down short treads, knees back, where the CoM has little room.
FLIGHTS = [
    (0.104, 0.187, 3, 0.40),
    (0.176, 0.224, 2, 0.57),
    (0.197, 0.312, 2, 0.44),
    (0.126, 0.201, 4, 0.58),
    (0.178, 0.257, 4, 0.69),
    (0.101, 0.182, 3, 0.33),
    (0.106, 0.185, 2, 0.38),
]


@pytest.mark.parametrize(("height", "tread", "count", "friction"), FLIGHTS)
def test_a_plan_that_is_called_feasible_succeeds(height, tread, count, friction):
    plan = sw.plan(stair(height, tread, count, direction="down"), "a1_wheeled", friction)
    if not plan.feasible:
        assert plan.problem.limit.quantity == "friction"
        assert plan.problem.limit.needed > friction
        return
    room = np.array([pose.margins.com for pose in plan.poses])
    grip = np.array([pose.margins.friction for pose in plan.poses])
    assert ((room >= THIN_COM - 1e-6) | (grip >= FIRM_GRIP - 1e-6)).all()
    assert sw.rollout(plan).outcome == "success"


def test_a_ramp_near_its_friction_angle_is_planned():
    """There the CoM has ample room: grip alone may be scarce."""
    run = 1.3
    points = [(-1.2, 0.0), (0.0, 0.0), (run, 0.57 * run), (run + 1.5, 0.57 * run)]
    plan = sw.plan({"points": points}, "a1_wheeled", 0.585)
    assert plan.feasible
    assert min(pose.margins.friction for pose in plan.poses) < FIRM_GRIP
    assert sw.rollout(plan).outcome == "success"
