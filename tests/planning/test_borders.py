"""The highest that robots are planned up, and that they climb it.

A planner that becomes more cautious loses these first: no preset terrain is near what is possible.
"""

import pytest

import stairwright as sw
from stairwright.terrain.stairs import stair

STEPS = [
    ("a1_wheeled", 0.4, 0.66), ("a1_wheeled_x", 0.2, 0.7), ("a1_wheeled_x", 0.2, 0.88),
    ("d1", 0.4, 0.78), ("d1", 0.4, 0.86), ("go2w", 0.6, 1.0), ("m20", 0.6, 0.85),
]  # fmt: skip
FLIGHTS = [
    ("a1_wheeled", 0.6, 0.6, 0.22), ("a1_wheeled_x", 0.6, 0.9, 0.22),
    ("a1_wheeled_x", 0.3, 0.88, 0.38), ("b2w", 0.45, 0.88, 0.26), ("d1", 0.6, 0.85, 0.34),
    ("go2w", 0.8, 0.9, 0.38),
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "friction", "height"), STEPS)
def test_a_high_step_is_climbed(robot: str, friction: float, height: float) -> None:
    plan = sw.plan(stair(height), robot, friction, diagnose=False)
    assert plan.feasible
    assert sw.rollout(plan).success


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "friction", "rise", "tread"), FLIGHTS)
def test_three_high_steps_are_planned(
    robot: str, friction: float, rise: float, tread: float
) -> None:
    assert sw.plan(stair(rise, tread, 3), robot, friction, diagnose=False).feasible
