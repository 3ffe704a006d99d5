"""What the planned motion takes beside carrying weight: of trunk, links, wheels and rotors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats
from stairwright.robot import kinematics
from stairwright.robot.description import Robot

from .setpoint import JOINTS, PITCH, TRUNK, WHEELS, Setpoint


@dataclass(frozen=True)
class _Body:
    """A rigid body: mass [kg], inertia [kg m^2], place and acceleration (2,), angle's [rad/s^2]."""

    mass: float
    inertia: float
    place: Floats
    acceleration: Floats
    turning: float

    def moment(self, about: Floats) -> float:
        """About +y at `about` (2,), that its motion takes [Nm]."""
        r, a = self.place - about, self.acceleration
        return self.mass * float(r[1] * a[0] - r[0] * a[1]) + self.inertia * self.turning


def inertial_loads(robot: Robot, target: Setpoint) -> tuple[float, Floats]:
    """Rate of the angular momentum about the CoM [Nm], and motor torques (2, 3) [Nm].

    Torques are those of one front and one rear leg: thigh, calf, wheel.
    """
    acceleration = target.accelerations
    pitch, pitch_rate, pitch_turning = target.pitch, target.pitch_rate, float(acceleration[PITCH])
    x_c, z_c = map(np.asarray, target.trunk)
    frames = kinematics.forward(robot, x_c, z_c, np.asarray(pitch), target.q)

    def beyond(start: Floats, lever: Floats, rate: float, turning: float) -> Floats:
        """Acceleration of a point fixed to a link, `lever` from one that accelerates as `start`."""
        return start + turning * np.array([lever[1], -lever[0]]) - rate**2 * lever

    body = robot.body
    offset = kinematics.rotate(np.asarray(pitch), np.array([body.com[0], body.com[2]]))
    at_trunk = acceleration[TRUNK]
    centre = beyond(at_trunk, offset, pitch_rate, pitch_turning)
    trunk = _Body(body.mass, body.inertia[1], target.trunk + offset, centre, pitch_turning)
    moment = trunk.moment(target.com)
    torques = np.zeros((2, 3))
    q_rate, q_turning = target.q_rate, acceleration[JOINTS]
    for k, leg in enumerate(robot.legs):
        hip, knee, wheel = frames.hips[k], frames.knees[k], frames.wheels[k]
        upper = pitch_rate + q_rate[2 * k], pitch_turning + q_turning[2 * k]
        lower = upper[0] + q_rate[2 * k + 1], upper[1] + q_turning[2 * k + 1]
        spin = acceleration[WHEELS][k] / robot.wheel.radius
        at_hip = beyond(at_trunk, hip - target.trunk, pitch_rate, pitch_turning)
        at_knee = beyond(at_hip, knee - hip, *upper)
        thigh_com = kinematics.link_com(leg.thigh, hip, knee)
        calf_com = kinematics.link_com(leg.calf, knee, wheel)
        thigh_at = beyond(at_hip, thigh_com - hip, *upper)
        calf_at = beyond(at_knee, calf_com - knee, *lower)
        wheel_at = beyond(at_knee, wheel - knee, *lower)
        thigh, calf, rim = leg.thigh, leg.calf, leg.wheel
        bodies = [
            _Body(thigh.mass, thigh.inertia[1], thigh_com, thigh_at, upper[1]),
            _Body(calf.mass, calf.inertia[1], calf_com, calf_at, lower[1]),
            _Body(rim.mass, rim.inertia[1], wheel, wheel_at, spin),
        ]
        moment += 2 * sum(each.moment(target.com) for each in bodies)
        motors = np.array([motor.armature for motor in leg.motors])
        torques[k] = (
            sum(each.moment(hip) for each in bodies) + motors[0] * q_turning[2 * k],
            sum(each.moment(knee) for each in bodies[1:]) + motors[1] * q_turning[2 * k + 1],
            leg.wheel.inertia[1] * spin + leg.wheel_motor.armature * (spin - lower[1]),
        )
    return moment, torques


def friction_loads(robot: Robot, target: Setpoint) -> Floats:
    """Motor torques (2, 3) that viscous friction takes at the planned rates [Nm].

    Those of one front and one rear leg: thigh, calf, wheel.
    """
    legs = target.q_rate.reshape(2, 2)
    # A wheel turns against its calf.
    wheels = target.wheel_speed / robot.wheel.radius - target.pitch_rate - legs.sum(axis=1)
    damping = np.array([[motor.damping for motor in leg.motors] for leg in robot.legs])
    loads: Floats = damping * np.column_stack([legs, wheels])
    return loads
