"""Flights with steps up and down close together: wheels wait in corners while others climb."""

from __future__ import annotations

import pytest

import stairwright as sw

# Friction, then rise of each step and the tread after it [m]. Rollouts of these failed while a
# wheel in a corner was taken to push through its centre, or one side of the robot took all load.
FLIGHTS = [
    (0.9, [0.17, 0.12, 0.21, 0.08, 0.19], [0.3, 0.22, 0.33, 0.28, 0.26]),
    (0.9, [-0.1962, 0.1744], [0.2029]),
    (0.9, [-0.1232, 0.17, 0.076, -0.188, 0.1652], [0.2467, 0.3399, 0.2607, 0.3364]),
]


@pytest.mark.slow
@pytest.mark.parametrize(("friction", "rises", "treads"), FLIGHTS)
def test_ups_and_downs_are_driven_at_high_friction(friction, rises, treads):
    points, x, z = [(-1.5, 0.0)], 0.0, 0.0
    for rise, tread in zip(rises, [*treads, 2.0], strict=False):
        points += [(x, z), (x, z + rise)]
        x, z = x + tread, z + rise
    plan = sw.plan({"points": [*points, (x, z)]}, "a1_wheeled", friction)
    assert plan.feasible
    run = sw.rollout(plan)
    assert run.outcome == "success", run.reason


@pytest.mark.slow
@pytest.mark.parametrize("armature", [0.0, 3e-4])
def test_wheels_with_light_rotors_do_not_swing(armature):
    robot = sw.load_robot("a1_wheeled").model_dump()
    robot["actuators"]["wheel"]["armature"] = armature
    run = sw.rollout(sw.plan("single-stair-030", robot))
    assert run.outcome == "success", run.reason
