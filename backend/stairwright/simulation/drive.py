"""Driving on flat ground with commanded speed and yaw rate (eqs 14-16).

The controller works in the plane of the robot's heading: yaw is taken out of the measurement, and
the set point travels with the trunk, so that only speed and yaw rate are commanded.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np

from stairwright import _core
from stairwright._core import GRAVITY
from stairwright.arrays import Floats
from stairwright.control.controller import LEG_PAIR, Controller
from stairwright.control.measurement import measure
from stairwright.control.setpoint import RATES, Setpoint
from stairwright.control.settings import ControllerSettings
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.robot.mujoco_model import TIMESTEP, build_spec
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

from .physics import CONTROL_STEPS

Command = Callable[[float], tuple[float, float]]

HALF_SIZE = 20.0  # m, of the flat ground
ACCELERATION = 1.0  # m/s^2 of the commanded speed
TURN_ACCELERATION = 2.0  # rad/s^2 of the commanded yaw rate
# Wheels that do not steer must slip to turn, which eqs 14-16 alone leave as steady errors.
TURN_INTEGRAL = 10.0  # 1/s
TURN_LIMIT = 6.0  # rad/s that the integral may add
SPEED_INTEGRAL = 3.0  # 1/s
SPEED_LIMIT = 0.3  # m/s that the integral may add


@dataclass(frozen=True)
class Drive:
    """Samples of a drive: all (n,) but `position` (n, 3). SI units."""

    time: Floats
    position: Floats
    heading: Floats
    speed: Floats
    speed_desired: Floats
    yaw_rate: Floats
    yaw_rate_desired: Floats
    pitch: Floats


def drive(
    robot: Robot,
    command: Command,
    duration: float,
    friction: float = 0.8,
    settings: ControllerSettings | None = None,
) -> Drive:
    """Drive on flat ground.

    Args:
        robot: Starts standing at the origin, heading along x.
        command: Speed [m/s] and yaw rate [rad/s] wanted at a time [s]; followed with bounded
            acceleration.
        duration: [s]
        friction: Coulomb friction of the ground.
        settings: Of the controller; form `contact` or `paper`.
    """
    settings = settings or ControllerSettings(sensing="ideal")
    ground = Terrain(points=[(-HALF_SIZE, 0.0), (HALF_SIZE, 0.0)], friction=friction)
    model = build_spec(robot, ground, friction, half_width=HALF_SIZE, visual=False).compile()
    data = mujoco.MjData(model)
    standing = kinematics.standing_joints(robot)
    data.qpos[2] = robot.nominal_height
    data.qpos[7:] = np.insert(standing.reshape(2, 2)[LEG_PAIR], 2, 0.0, axis=1).ravel()
    controller = Controller(robot, wheel_path(ground, robot.wheel.radius), friction, settings)
    base = _standing(robot, controller, standing)
    dt = CONTROL_STEPS * TIMESTEP
    speed = turn = added = pushed = 0.0
    rows = []
    for _ in range(round(duration / dt)):
        wanted_speed, wanted_turn = command(data.time)
        speed += float(np.clip(wanted_speed - speed, -ACCELERATION * dt, ACCELERATION * dt))
        turn += float(np.clip(wanted_turn - turn, -TURN_ACCELERATION * dt, TURN_ACCELERATION * dt))
        state = measure(robot, data.qpos, data.qvel)
        added += TURN_INTEGRAL * (turn - state.yaw_rate) * dt
        added = min(max(added, -TURN_LIMIT), TURN_LIMIT)
        qpos, qvel = _ahead(data.qpos, data.qvel, state.heading)
        pushed += SPEED_INTEGRAL * (speed - float(qvel[0])) * dt
        pushed = min(max(pushed, -SPEED_LIMIT), SPEED_LIMIT)
        # The damping of eq 16 acts on the true error: what the integral adds must not feed it.
        share = added / (1.0 + settings.yaw_damping)
        torques = controller.step(qpos, qvel, _moving(base, speed, pushed, turn + share))
        data.ctrl[:] = _core.limit_torques(robot.native, data.qvel[6:], torques)
        rows.append(
            [
                data.time,
                *data.qpos[:3],
                state.heading,
                qvel[0],
                speed,
                state.yaw_rate,
                turn,
                state.pitch,
            ]
        )
        mujoco.mj_step(model, data, CONTROL_STEPS)
    table = np.array(rows)
    return Drive(
        time=table[:, 0],
        position=table[:, 1:4],
        heading=np.unwrap(table[:, 4]),
        speed=table[:, 5],
        speed_desired=table[:, 6],
        yaw_rate=table[:, 7],
        yaw_rate_desired=table[:, 8],
        pitch=table[:, 9],
    )


def _ahead(qpos: Floats, qvel: Floats, heading: float) -> tuple[Floats, Floats]:
    """The state seen from a frame that stands under the trunk and looks where it heads."""
    c, s = math.cos(heading), math.sin(heading)
    qpos, qvel = qpos.copy(), qvel.copy()
    qpos[:2] = 0.0
    a, b = math.cos(heading / 2), -math.sin(heading / 2)
    w, x, y, z = qpos[3:7]
    qpos[3:7] = a * w - b * z, a * x - b * y, a * y + b * x, a * z + b * w
    qvel[:2] = c * qvel[0] + s * qvel[1], -s * qvel[0] + c * qvel[1]
    return qpos, qvel


def _standing(robot: Robot, controller: Controller, q: Floats) -> Setpoint:
    """The set point of the standing robot with its trunk above the origin."""
    zero, height = np.zeros(()), np.asarray(robot.nominal_height)
    frames = kinematics.forward(robot, zero, height, zero, q)
    com = kinematics.com(robot, zero, height, zero, frames)
    path = controller.path
    places = np.array([path.project(wheel) for wheel in frames.wheels])
    front, rear = frames.wheels[:, 0]
    share = (com[0] - rear) / (front - rear)
    weight = robot.mass * GRAVITY
    forces = np.array([[0.0, share * weight], [0.0, (1.0 - share) * weight]])
    still = np.zeros(2)
    return Setpoint(
        wheel_progress=places,
        q=q,
        pitch=0.0,
        com=com,
        trunk=np.array([0.0, robot.nominal_height]),
        wheel_speed=still,
        q_rate=np.zeros(4),
        pitch_rate=0.0,
        com_velocity=still,
        trunk_velocity=still,
        forces=forces,
        accelerations=np.zeros(RATES),
    )


def _moving(base: Setpoint, speed: float, pushed: float, yaw_rate: float) -> Setpoint:
    along = np.array([speed, 0.0])
    return Setpoint(
        **{
            **vars(base),
            "wheel_speed": np.full(2, speed + pushed),
            "com_velocity": along,
            "trunk_velocity": along,
            "yaw_rate": yaw_rate,
        }
    )
