"""The controller in plain numpy, both forms: the readable reference of the compiled one.

Form ``contact`` (default): forces act at the contact points, each in its own wheel's frame; the QP
is pulled to the plan's static forces; the wheel motors get the QP's tangential force fed forward
plus feedback on the absolute wheel rate; the legs' own weight and inertia are carried by
feed-forward; forces keep within what the motors can give.

Form ``paper``: forces act at the wheel centres, the traction comes from the rolling control alone
and enters the QP as a known wrench (eq 10); the body is the trunk's point with the whole mass; a
wheel's frame is that of the terrain under it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from stairwright._core import CREEP, GRAVITY
from stairwright.arrays import Floats
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

from . import balance, qp, rigid_body, rolling, tracking
from .contact import locate, support, wheel_traction
from .inertial_loads import friction_loads, inertial_loads
from .lift_off import lift_off, lifting_pair
from .measurement import Measurement, measure
from .motor_limits import MotorTorques, solve_within_motors
from .setpoint import PITCH, Setpoint
from .settings import ControllerSettings

LEG_PAIR = np.array([0, 0, 1, 1])  # legs FL, FR, RL, RR -> front, rear
_LIMIT = 1.3  # times the robot's weight: largest normal force of a wheel


@dataclass(frozen=True)
class Gains:
    """Joint and wheel gains and the largest normal force, with the robot's own filled in."""

    joint_stiffness: float
    joint_damping: float
    wheel_damping: float
    force_limit: float


def gains(robot: Robot, settings: ControllerSettings) -> Gains:
    """The settings' gains, or the robot's where a setting is empty.

    A wheel bears half of the weight where its pair carries the robot, and more in motion. It is
    damped at most so that it has its wished rate after one control step: with light rotors more
    would make it swing ever wider.
    """
    own = robot.feedback
    spin_inertia = min(leg.wheel.inertia[1] + leg.wheel_motor.armature for leg in robot.legs)

    def pick(value: float | None, default: float) -> float:
        return default if value is None else value

    return Gains(
        pick(settings.joint_stiffness, own.joint_stiffness),
        pick(settings.joint_damping, own.joint_damping),
        min(pick(settings.wheel_damping, own.wheel_damping), spin_inertia / balance.CONTROL_PERIOD),
        pick(settings.force_limit, _LIMIT * robot.mass * GRAVITY),
    )


class Controller:
    """Torques from measurements and set points. Keeps the last forces and the wheels' places.

    Attributes:
        forces: (8,) last solution of the QP, per wheel tangential and normal [N].
        places: (4,) arc length of each wheel on the wheel-centre curve [m].
        pitch_integral: Pitch acceleration that the model does not know of [rad/s^2].
        tips: Whether the robot tips: then its plan must not go on.
    """

    def __init__(
        self, robot: Robot, path: WheelPath, friction: float, settings: ControllerSettings
    ) -> None:
        self.robot, self.path, self.friction, self.settings = robot, path, friction, settings
        self.gains = gains(robot, settings)
        self.forces = np.tile([0.0, robot.mass * GRAVITY / 4], 4)
        self.places = np.full(4, np.nan)
        self.pitch_integral = 0.0
        self.tips = False

    def locate(self, state: Measurement) -> Floats:
        """Update and return the wheels' places (4,)."""
        for i, (x, z) in enumerate(state.wheels):
            self.places[i] = locate(self.path, x, z, self.places[i])
        return self.places

    def step(self, qpos: Floats, qvel: Floats, target: Setpoint) -> Floats:
        """Joint torques (12,) [Nm] before the motors' limits."""
        state = measure(self.robot, qpos, qvel)
        self.locate(state)
        if self.settings.form == "paper":
            return self._paper(state, target)
        return self._contact(state, target, qvel[6:])

    def _contact(self, state: Measurement, target: Setpoint, joint_rates: Floats) -> Floats:
        robot, settings, radius = self.robot, self.settings, self.path.radius
        planned = target.wheel_progress[LEG_PAIR]
        usable = max(settings.friction_share, target.friction_share) * self.friction
        held = np.empty((4, 8))
        leans = np.repeat(target.leans, 2)
        for row, here, there, lean in zip(held, self.places, planned, leans, strict=True):
            support(self.path, here, there, usable, lean, row)
        normals, friction, reach = held[:, :2], held[:, 2], held[:, 3:4]
        frames = rigid_body.contact_frames(normals)
        points = state.wheels - reach * normals
        A = rigid_body.force_map(frames, points - state.com)
        self.pitch_integral = balance.integrate_pitch(
            settings, self.pitch_integral, state, target.pitch
        )
        moment, moving = inertial_loads(robot, target)
        desired = balance.desired_wrench(
            robot,
            settings,
            target.com - state.com,
            target.com_velocity - state.com_velocity,
            state,
            target,
            moment,
            self.pitch_integral,
        )
        resting = np.einsum("nji,nj->ni", frames, (target.forces / 2)[LEG_PAIR]).ravel()
        sides = balance.side_differences(robot, settings, state, target, frames)
        moving = (moving + friction_loads(robot, target))[LEG_PAIR]
        rest = np.column_stack(
            [balance.leg_weight_torques(robot, state) + moving[:, :2], moving[:, 2]]
        )
        motors = MotorTorques.of(state, frames, points, held[:, 3], rest)
        lifted = lift_off(state, self.path, self.places, target)
        self.tips = lifted > 0.5
        share = 1.0 + lifted * (balance.TIPPING_PLACE - 1.0)
        H, g = balance.force_cost(settings, A, desired, resting, self.forces, sides, share)
        self.forces = solve_within_motors(
            partial(self._solved, friction=friction), H, g, motors, robot, joint_rates,
            settings.force_weight,
        )  # fmt: skip
        forces = np.einsum("nij,nj->ni", frames, self.forces.reshape(4, 2))
        driven = np.array([wheel_traction(row, *f) for row, f in zip(held, forces, strict=True)])
        speeds = target.wheel_speed[LEG_PAIR] + settings.wheel_sync * (planned - self.places)
        speeds += CREEP * driven / (robot.mass * GRAVITY / 4)
        rates = rolling.wheel_rates(speeds, radius) + self._yaw(state)
        # Held in its place, the pair that a tipping robot stands on could not roll under it.
        free = np.where(lifting_pair(state, target.pitch) == LEG_PAIR, 0.0, lifted)
        damping = (1.0 - free) * self.gains.wheel_damping
        wheel = radius * driven + rolling.wheel_torques(damping, rates, state.rolling_rates)
        return self._joined(state, target, motors.at(self.forces)[:, :2], wheel + moving[:, 2])

    def _paper(self, state: Measurement, target: Setpoint) -> Floats:
        robot, radius = self.robot, self.path.radius
        normals = self.path.normals(self.places)
        frames = rigid_body.contact_frames(normals)
        rates = rolling.wheel_rates(target.wheel_speed[LEG_PAIR], radius)
        rates = rates + self._yaw(state)
        wheel = rolling.wheel_torques(self.gains.wheel_damping, rates, state.wheel_rates)
        driven = np.zeros(8)
        driven[0::2] = rigid_body.traction(wheel, radius)
        to_centres = rigid_body.force_map(frames, state.wheels - state.trunk)
        to_contacts = rigid_body.force_map(frames, state.wheels - radius * normals - state.trunk)
        desired = balance.desired_wrench(
            robot,
            self.settings,
            target.trunk - state.trunk,
            target.trunk_velocity - state.trunk_velocity,
            state,
            target,
            state.inertia * float(target.accelerations[PITCH]),
        )
        usable = np.full(4, self.settings.friction_share * self.friction)
        desired -= to_contacts @ driven
        H, g = balance.force_cost(self.settings, to_centres, desired, np.zeros(8), self.forces)
        self.forces = self._solved(H, g, usable)
        forces = np.einsum("nij,nj->ni", frames, self.forces.reshape(4, 2))
        torques = balance.force_torques(state, state.wheels, forces)
        return self._joined(state, target, torques, wheel)

    def _solved(self, H: Floats, g: Floats, friction: Floats) -> Floats:
        C, d = balance.force_limits(self.gains.force_limit, friction)
        return qp.solve(self.settings.solver, H, g, C, d, self.forces)

    def _yaw(self, state: Measurement) -> Floats:
        settings = self.settings
        desired = -settings.heading_stiffness * state.heading
        scale = self.robot.hips.half_track / self.robot.wheel.radius
        return rolling.yaw_difference(settings.yaw_damping, desired, state.yaw_rate, scale)

    def _joined(
        self, state: Measurement, target: Setpoint, balance_torques: Floats, wheel: Floats
    ) -> Floats:
        legs = tracking.joint_torques(
            balance_torques,
            self.gains.joint_stiffness,
            self.gains.joint_damping,
            target.q.reshape(2, 2)[LEG_PAIR],
            state.joints,
            target.q_rate.reshape(2, 2)[LEG_PAIR],
            state.joint_rates,
        )
        return np.column_stack([legs, wheel]).ravel()
