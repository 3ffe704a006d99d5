"""Forces of the balance QP within what the motors give."""

from __future__ import annotations

import numpy as np
import pytest

from stairwright import _core, load_robot
from stairwright.control import balance, qp, rigid_body
from stairwright.control.measurement import measure
from stairwright.control.motor_limits import MotorTorques, solve_within_motors
from stairwright.control.settings import ControllerSettings

# Wheels of the front pair on a riser, those of the rear pair on the floor.
NORMALS = np.array([[-1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, 1.0]])
STILL = np.zeros(12)


def forces(strength: float, push: float):
    """Forces for a horizontal `push` [N], of an A1 whose leg motors have `strength` of theirs."""
    data = load_robot("a1_wheeled").model_dump()
    data["actuators"]["leg"]["torque"] *= strength
    robot = load_robot("a1_wheeled").model_validate(data)
    joints = np.tile([0.9, -1.6, 0.0], 4)
    state = measure(robot, np.array([0.0, 0.0, 0.4, 1.0, 0.0, 0.0, 0.0, *joints]), np.zeros(18))
    frames = rigid_body.contact_frames(NORMALS)
    reach = np.full(4, robot.wheel.radius)
    points = state.wheels - reach[:, None] * NORMALS
    A = rigid_body.force_map(frames, points - state.com)
    wanted = np.array([push, robot.mass * _core.GRAVITY, 0.0])
    settings = ControllerSettings()
    H, g = balance.force_cost(settings, A, wanted, np.zeros(8), np.zeros(8))
    C, d = balance.force_limits(1e4, np.full(4, 0.6))
    weight = np.column_stack([balance.leg_weight_torques(robot, state), np.zeros(4)])
    motors = MotorTorques.of(state, frames, points, reach, weight)

    def solve(H, g):
        return qp.solve("native", H, g, C, d, np.tile([0.0, 50.0], 4))

    found = solve_within_motors(solve, H, g, motors, robot, STILL, settings.force_weight)

    def excess(forces):
        asked = motors.at(forces).ravel()
        return np.abs(asked - _core.limit_torques(robot.native, STILL, asked)).max()

    free = solve(H, g)
    return A @ found - wanted, free - found, excess(free), excess(found)


def test_strong_motors_change_nothing() -> None:
    missed, change, _, excess = forces(1.0, 20.0)
    assert excess == 0.0
    assert not change.any()
    assert np.abs(missed).max() < 3.0


@pytest.mark.parametrize("strength", [0.25, 0.3])
def test_weak_motors_give_what_they_can(strength: float) -> None:
    _, change, before, after = forces(strength, 60.0)
    assert np.abs(change).max() > 5.0
    assert after < 0.3 * before
