"""What bounds speed x = (dw/dt)^2 and acceleration u = d2w/dt2 of path position w, linear in both.

A row (a, b, c) allows what keeps ``a x + b u + c >= 0``; standing (0, 0) is always allowed, for the
path is certified at rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import astuple, dataclass, replace
from typing import Literal

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.planning.poses.pose_reference import COM, JOINTS, PITCH, WHEELS
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

from .moving_robot import MovingRobot

LimitName = Literal[
    "balance", "torque", "acceleration", "joint_speed", "pitch_speed", "wheel_speed", "impact"
]

WHEEL_SPEED_SHARE = 0.85  # of the no-load speed: the rest leaves torque
LEG_SPEED_SHARE = 0.5  # of what the motor reaches under the load of standing
# Of the motors' torque and of the friction (of which the controller keeps to 0.95), for standing
# and moving together: the rest is what the controller corrects with.
TORQUE_SHARE = 0.8
FRICTION_SHARE = 0.85
LEAST_EASE = 0.3  # of the accelerations that the pace allows
_EASED = 0.3  # of a motor's torque: where standing leaves less, nothing is met or turned as hard
_LEAST_SPARE = 0.02  # of a motor's torque that counts where there is hardly any
_DAMPED = 0.5  # of what standing leaves, for the joints' damping; the rest accelerates
_LEAST_DAMPED = 0.1  # of the torque that standing leaves at least: no slower than steady plans are
_STILL = 1e-9
_NEAR = 1e-4  # m to either side of a corner
_MEETS = 0.01  # m before and behind a corner where a wheel counts as meeting it


@dataclass(frozen=True)
class Pace:
    """How hard a robot is driven: what a controller that knows no more than ours can follow.

    Attributes:
        sway: Share of the CoM margin that inertia may take.
        com: CoM margin of which it takes less, for places of wheels are known to millimetres [m].
        acceleration: Of the CoM along x and along z [m/s^2].
        pitch_acceleration: [rad/s^2].
        joint_acceleration: Of thighs and calves [rad/s^2].
        joint_speed: Of thighs and calves [rad/s].
        pitch_speed: [rad/s].
        impact_speed: Of a wheel towards a face that it meets [m/s].
    """

    sway: float
    com: float
    acceleration: float
    pitch_acceleration: float
    joint_acceleration: float
    joint_speed: float
    pitch_speed: float
    impact_speed: float

    @classmethod
    def of(cls, aggressiveness: float) -> Pace:
        """Between `GENTLE` (0) and `HARD` (1), by equal factors."""
        ends = zip(astuple(GENTLE), astuple(HARD), strict=True)
        return cls(*(low * (high / low) ** aggressiveness for low, high in ends))

    def at_size(self, large: float) -> Pace:
        """Of a robot whose legs are `large` (>= 1) times those these were chosen with.

        At equal accelerations of the CoM (equal Froude numbers) angles accelerate in inverse
        proportion to lengths, and turn in inverse proportion to their root.
        """
        root = math.sqrt(large)
        return replace(
            self,
            com=self.com * large,
            pitch_acceleration=self.pitch_acceleration / large,
            joint_acceleration=self.joint_acceleration / large,
            joint_speed=self.joint_speed / root,
            pitch_speed=self.pitch_speed / root,
            impact_speed=self.impact_speed * root,
        )


GENTLE = Pace(0.5, 0.015, 0.25, 1.5, 8.0, 1.5, 0.8, 0.1)
HARD = Pace(0.65, 0.015, 2.0, 10.0, 60.0, 9.0, 3.0, 0.5)


@dataclass(frozen=True)
class Limits:
    """Rows (n, k, 3) and the name of each of the k; caps (n,) of x by name."""

    rows: Floats
    names: tuple[LimitName, ...]
    caps: dict[LimitName, Floats]


def limits_of(
    motion: MovingRobot,
    robot: Robot,
    path: WheelPath,
    friction: float,
    effort: Floats,
    pace: Pace,
    ease: Floats,
) -> Limits:
    """Limits along `motion`.

    Args:
        motion: Of the robot along the path.
        robot: Who moves.
        path: Its wheel-centre curve.
        friction: Coulomb friction of all faces.
        effort: (n, 2) largest share of a leg's and of a wheel's motor torque that standing takes.
        pace: How hard it may be driven.
        ease: (n,) share of its accelerations that is allowed.
    """
    gentle = np.clip((1.0 - effort.max(axis=1)) / _EASED, LEAST_EASE, 1.0)
    balance, torque = _core.dynamic_limits(
        robot.native, path.native, friction, motion.values, motion.first, motion.second,
        FRICTION_SHARE, TORQUE_SHARE, pace.sway, pace.com,
    )  # fmt: skip
    groups: list[tuple[LimitName, Floats]] = [
        ("balance", balance),
        ("torque", torque),
        ("acceleration", np.stack([*_accelerations(motion, pace, np.minimum(ease, gentle))], 1)),
    ]
    names = tuple(name for name, rows in groups for _ in range(rows.shape[1]))
    rows = np.ascontiguousarray(np.concatenate([rows for _, rows in groups], axis=1))
    caps = _caps(motion, robot, effort, pace)
    caps["impact"] = gentle**2 * _impact_cap(motion, path, pace)
    return Limits(rows, names, caps)


def _both_ways(slope: Floats, bend: Floats, room: Floats) -> list[Floats]:
    """Rows (n, 3) that keep ``slope u + bend x`` between ``-room`` and ``room``."""
    return [np.stack([-side * bend, -side * slope, room], axis=-1) for side in (1.0, -1.0)]


def _accelerations(motion: MovingRobot, pace: Pace, ease: Floats) -> Iterator[Floats]:
    """Bounds, both ways, on what the controller has to follow."""
    most = np.full(motion.first.shape[1], np.inf)
    most[COM] = pace.acceleration
    most[PITCH] = pace.pitch_acceleration
    most[JOINTS] = pace.joint_acceleration
    for k in np.flatnonzero(np.isfinite(most)):
        yield from _both_ways(motion.first[:, k] / most[k], motion.second[:, k] / most[k], ease)


def _caps(motion: MovingRobot, robot: Robot, effort: Floats, pace: Pace) -> dict[LimitName, Floats]:
    """Largest x (n,) by speed limits."""
    spare = np.maximum(1.0 - effort[:, 0], _LEAST_SPARE)
    leg, turning = _damped_speeds(robot, effort)
    joint = np.minimum(pace.joint_speed, LEG_SPEED_SHARE * robot.leg_speed * spare)
    joint = np.minimum(joint, leg)
    wheel = np.minimum(WHEEL_SPEED_SHARE * robot.wheel_speed, turning) * robot.wheel.radius

    def cap(most: Floats | float, slopes: Floats) -> Floats:
        square: Floats = (most / np.maximum(slopes, _STILL)) ** 2
        return np.minimum(square, 1e6)

    return {
        "joint_speed": cap(joint, np.abs(motion.first[:, JOINTS]).max(axis=1)),
        "pitch_speed": cap(pace.pitch_speed, np.abs(motion.first[:, PITCH])),
        "wheel_speed": cap(wheel, np.abs(motion.first[:, WHEELS]).max(axis=1)),
    }


def _damped_speeds(robot: Robot, effort: Floats) -> tuple[Floats, Floats]:
    """(n,) of legs' joints and of wheels [rad/s]: where their damping takes `_DAMPED` of the torque
    that standing leaves and the motor has at that speed.
    """
    torque, damping, speed = np.array(
        [(motor.torque, motor.damping, motor.speed) for motor in robot.motors]
    ).T.reshape(3, 4, 3)

    def least(part: slice, effort: Floats) -> Floats:
        spare = _DAMPED * np.maximum(1.0 - effort, _LEAST_DAMPED)[:, None, None] * torque[:, part]
        most = spare / (damping[:, part] + spare / speed[:, part])
        found: Floats = most.min(axis=(1, 2))
        return found

    return least(slice(2), effort[:, 0]), least(slice(2, 3), effort[:, 1])


def _impact_cap(motion: MovingRobot, path: WheelPath, pace: Pace) -> Floats:
    """Largest x (n,) with which wheels meet the next face at a concave corner."""
    cap = np.full(len(motion.position), 1e6)
    before, after = (path.centres(path.corners + side) for side in (-_NEAR, _NEAR))
    at = path.centres(path.corners)
    into, out = at - before, after - at
    sines = np.abs(into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0]) / _NEAR**2
    for pair in (0, 1):
        places = motion.values[:, WHEELS][:, pair]
        rates = np.abs(motion.first[:, WHEELS][:, pair])
        for corner, sine in zip(path.corners, sines, strict=True):
            near = np.abs(places - corner) <= _MEETS
            most = (pace.impact_speed / np.maximum(sine * rates[near], _STILL)) ** 2
            cap[near] = np.minimum(cap[near], most)
    return cap
