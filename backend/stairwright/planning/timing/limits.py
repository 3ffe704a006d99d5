"""What bounds speed x = (dw/dt)^2 and acceleration u = d2w/dt2 along the way w, linear in both.

A row (a, b, c) allows what keeps ``a x + b u + c >= 0``; standing (0, 0) is always allowed, for the
path is certified at rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import astuple, dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stairwright import _core
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

from .moving_robot import MovingRobot
from .wrench_cone import facets, touched

Floats = NDArray[np.float64]
LimitName = Literal[
    "balance", "torque", "acceleration", "joint_speed", "pitch_speed", "wheel_speed"
]

WHEEL_SPEED_SHARE = 0.6  # of the no-load speed: the rest leaves torque
LEG_SPEED_SHARE = 0.5  # of what the motor reaches under the load of standing
TORQUE_SHARE = 0.9  # of the motors' torque that standing and accelerating may take together
_LEAST_SPARE = 0.02  # of a motor's torque that counts where there is hardly any
_STILL = 1e-9


@dataclass(frozen=True)
class Pace:
    """How hard a robot is driven: what a controller that knows no more than ours can follow.

    Attributes:
        sway: Share of the CoM margin that inertia may take.
        acceleration: Of the CoM along x and along z [m/s^2].
        pitch_acceleration: [rad/s^2].
        joint_acceleration: Of thighs and calves [rad/s^2].
        joint_speed: Of thighs and calves [rad/s].
        pitch_speed: [rad/s].
    """

    sway: float
    acceleration: float
    pitch_acceleration: float
    joint_acceleration: float
    joint_speed: float
    pitch_speed: float

    @classmethod
    def of(cls, aggressiveness: float) -> Pace:
        """Between `GENTLE` (0) and `HARD` (1), by equal factors."""
        ends = zip(astuple(GENTLE), astuple(HARD), strict=True)
        return cls(*(low * (high / low) ** aggressiveness for low, high in ends))


GENTLE = Pace(0.5, 0.25, 1.5, 8.0, 1.5, 0.8)
HARD = Pace(0.9, 2.0, 10.0, 60.0, 9.0, 3.0)


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
) -> Limits:
    """Limits along `motion`.

    Args:
        motion: Of the robot along the way.
        robot: Who moves.
        path: Its wheel-centre curve.
        friction: Coulomb friction of all faces.
        effort: (n,) largest share of a leg motor's torque that standing takes.
        pace: How hard it may be driven.
    """
    groups: list[tuple[LimitName, Floats]] = [
        ("balance", _balance(motion, robot, path, friction, pace)),
        ("torque", _torque(motion, robot, effort)),
        ("acceleration", np.stack(list(_accelerations(motion, pace)), axis=1)),
    ]
    names = tuple(name for name, rows in groups for _ in range(rows.shape[1]))
    rows = np.ascontiguousarray(np.concatenate([rows for _, rows in groups], axis=1))
    return Limits(rows, names, _caps(motion, robot, effort, pace))


def _balance(
    motion: MovingRobot, robot: Robot, path: WheelPath, friction: float, pace: Pace
) -> Floats:
    """Weight and inertia stay inside the cone of wrenches that the contacts can give.

    A wrench is (force x, force z, moment about the CoM), in weights and weights times metres. The
    CoM may be off by what inertia is not allowed to take of its margin.
    """
    points, normals = touched(path, motion.wheels[0])
    com, first, second = motion.com
    inward = facets(points, normals, com, friction)
    weight = robot.mass * _core.GRAVITY
    margin = _core.firm_com_margins(
        path.native, motion.wheels[0], np.ascontiguousarray(com[:, 0]), friction
    )
    kept = (1.0 - pace.sway) * np.maximum(margin, 0.0)
    momentum = [each / weight for each in motion.momentum]
    by_speed = np.column_stack([second / _core.GRAVITY, momentum[1]])
    by_acceleration = np.column_stack([first / _core.GRAVITY, momentum[0]])
    room = np.maximum(inward[..., 1] - np.abs(inward[..., 2]) * kept[:, None], 0.0)
    products = [np.einsum("nkc,nc->nk", inward, wrench) for wrench in (by_speed, by_acceleration)]
    return np.stack([*products, room], axis=-1)


def _torque(motion: MovingRobot, robot: Robot, effort: Floats) -> Floats:
    """What standing leaves of the leg motors' torque, for inertia.

    Forces grow with the CoM's vertical acceleration; a horizontal one acts at the legs' height, a
    quarter of it on each leg; links and rotors are turned by their own motors.
    """
    spare = np.maximum(TORQUE_SHARE - effort, 0.0)
    least = float(robot.torque_limits[:, :2].min())
    _, first, second = motion.com
    lever = robot.mass * motion.height / (4.0 * least)
    upward = [-effort * each[:, 1] / _core.GRAVITY for each in (second, first)]
    rows = [np.stack([*upward, spare], axis=-1)]
    rows += _both_ways(lever * first[:, 0], lever * second[:, 0], spare)
    for j, (inertia, torque) in enumerate(_turned(robot)):
        slope, bend = (inertia / torque * each[:, j] for each in motion.joints[1:])
        rows += _both_ways(slope, bend, np.maximum(spare, _LEAST_SPARE))
    return np.stack(rows, axis=1)


def _both_ways(slope: Floats, bend: Floats, room: Floats) -> list[Floats]:
    """Rows (n, 3) that keep ``slope u + bend x`` between ``-room`` and ``room``."""
    return [np.stack([-side * bend, -side * slope, room], axis=-1) for side in (1.0, -1.0)]


def _turned(robot: Robot) -> Iterator[tuple[float, float]]:
    """Inertia [kg m^2] that a joint's motor turns with its leg stretched, and its torque [Nm]."""
    for leg, torques in zip(robot.legs, robot.torque_limits, strict=True):
        thigh, calf = leg.thigh.length, leg.calf.length
        lower = leg.calf.mass * (calf / 2) ** 2 + leg.wheel.mass * calf**2
        whole = leg.thigh.mass * (thigh / 2) ** 2 + leg.calf.mass * (thigh + calf / 2) ** 2
        whole += leg.wheel.mass * (thigh + calf) ** 2
        motors = leg.motors
        yield whole + motors[0].armature, float(torques[0])
        yield lower + motors[1].armature, float(torques[1])


def _accelerations(motion: MovingRobot, pace: Pace) -> Iterator[Floats]:
    """Bounds, both ways, on what the controller has to follow."""
    columns = [(motion.com, k, pace.acceleration) for k in range(2)]
    columns.append((motion.trunk, 2, pace.pitch_acceleration))
    columns += [(motion.joints, k, pace.joint_acceleration) for k in range(4)]
    for (_, first, second), k, most in columns:
        yield from _both_ways(first[:, k] / most, second[:, k] / most, np.ones(len(first)))


def _caps(motion: MovingRobot, robot: Robot, effort: Floats, pace: Pace) -> dict[LimitName, Floats]:
    """Largest x (n,) by speed limits."""
    spare = np.maximum(1.0 - effort, _LEAST_SPARE)
    joint = np.minimum(pace.joint_speed, LEG_SPEED_SHARE * robot.leg_speed * spare)
    wheel = WHEEL_SPEED_SHARE * robot.wheel_speed * robot.wheel.radius

    def cap(most: Floats | float, slopes: Floats) -> Floats:
        square: Floats = (most / np.maximum(slopes, _STILL)) ** 2
        return np.minimum(square, 1e6)

    return {
        "joint_speed": cap(joint, np.abs(motion.joints[1]).max(axis=1)),
        "pitch_speed": cap(pace.pitch_speed, np.abs(motion.trunk[1][:, 2])),
        "wheel_speed": cap(wheel, np.abs(motion.wheels[1]).max(axis=1)),
    }
