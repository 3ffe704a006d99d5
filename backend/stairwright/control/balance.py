"""The balance controller: PD on CoM and pitch, forces by a QP, torques by J' F (eqs 8-13)."""

from __future__ import annotations

import numpy as np

from stairwright._core import GRAVITY
from stairwright.arrays import Floats
from stairwright.robot.description import Robot

from .measurement import Measurement
from .rigid_body import wrench
from .setpoint import COM, Setpoint
from .settings import ControllerSettings

# Larger accelerations are not asked for: a far-away set point must not throw the robot.
MAX_ACCELERATION = 3.5  # m/s^2, along x
CONTROL_PERIOD = 0.002  # s
MAX_PITCH_INTEGRAL = 15.0  # rad/s^2 that the pitch integral may add
# Weights of the differences between left and right forces, along x and z: where grip runs out the
# QP would rather carry all with one wheel of a pair, and nothing else keeps the robot from rolling
# over. Yaw has the wheels' rates and tyres, too: on upright faces, where a wheel lifts by its grip
# alone, the side that is to lift more may push more.
EVEN = np.array([0.002, 0.02])
MOST_UNEVEN = 0.8  # of what a pair carries: left less right
TIPPING_PLACE = 0.05  # of the weight of forces along x, of a robot that tips


def desired_wrench(
    robot: Robot,
    settings: ControllerSettings,
    offset: Floats,
    drift: Floats,
    state: Measurement,
    target: Setpoint,
    moment: float,
    pitch_integral: float = 0.0,
) -> Floats:
    """(3,) ``b_des`` of eqs 8-9.

    `offset` and `drift` (2,) are desired minus measured position [m] and velocity [m/s] of the
    body's centre; `moment` [Nm] is what the planned motion takes; `pitch_integral` [rad/s^2] is
    what the pitch integral adds.
    """
    acceleration = target.accelerations[COM] + settings.com_stiffness * offset
    acceleration += settings.com_damping * drift
    acceleration[0] = np.clip(acceleration[0], -MAX_ACCELERATION, MAX_ACCELERATION)
    spin = pitch_integral + settings.pitch_stiffness * (target.pitch - state.pitch)
    spin += settings.pitch_damping * (target.pitch_rate - state.pitch_rate)
    return wrench(robot.mass, acceleration, moment + state.inertia * spin)


def integrate_pitch(
    settings: ControllerSettings, pitch_integral: float, state: Measurement, goal: float
) -> float:
    """The pitch integral [rad/s^2] one control step on, bounded."""
    pitch_integral += CONTROL_PERIOD * settings.pitch_integral * (goal - state.pitch)
    return min(max(pitch_integral, -MAX_PITCH_INTEGRAL), MAX_PITCH_INTEGRAL)


def side_differences(
    robot: Robot,
    settings: ControllerSettings,
    state: Measurement,
    target: Setpoint,
    frames: Floats,
) -> tuple[Floats, Floats]:
    """Rows (4, 8) of left less right forces of the pairs, and what they shall be (4,) [N].

    Forces along x shall be equal. Those along z keep the robot from rolling over: against gravity
    their stiffness must be above g / h. Pairs share it as they share the weight, up to
    `MOST_UNEVEN` of what each carries. `frames` (4, 2, 2) turn forces along and out of faces into
    the world's.
    """
    height = state.com[1] - state.wheels[:, 1].mean() + robot.wheel.radius
    wanted = settings.roll_stiffness * state.roll + settings.roll_damping * state.roll_rate
    moment = -robot.mass * height * height * wanted
    carried = np.maximum(target.forces[:, 1], 0.0)
    share = moment / robot.hips.half_track / max(float(carried.sum()), 1e-9)
    rows, asked = np.zeros((2, 2, 8)), np.zeros((2, 2))
    for pair, (left, right) in enumerate(frames.reshape(2, 2, 2, 2)):
        rows[pair, :, 4 * pair : 4 * pair + 4] = np.hstack([left, -right])
        asked[pair, 1] = carried[pair] * np.clip(share, -MOST_UNEVEN, MOST_UNEVEN)
    return rows.reshape(4, 8), asked.ravel()


def force_cost(
    settings: ControllerSettings,
    force_map: Floats,
    desired: Floats,
    resting: Floats,
    previous: Floats,
    differences: tuple[Floats, Floats] | None = None,
    place_counts: float = 1.0,
) -> tuple[Floats, Floats]:
    """Hessian H (8, 8) and gradient g (8,) of ``F' H F / 2 + g' F``, half the cost of eq 11.

    ``D' S D + alpha |F - F_rest|^2 + beta |F - F_prev|^2`` with ``D = A F - b_des``; the paper's
    cost has ``F_rest = 0``, and not the squares of what `differences` are from what they shall be.
    Of forces along x `place_counts` of the weight counts.
    """
    force, moment = settings.force_weight, settings.moment_weight
    weights = np.array([place_counts * force, force, moment])
    weighted = force_map.T * weights
    hessian = weighted @ force_map + (settings.alpha + settings.beta) * np.eye(8)
    gradient = -weighted @ desired - settings.alpha * resting - settings.beta * previous
    if differences is not None:
        rows, asked = differences
        uneven = rows.T * np.tile(EVEN, 2)
        hessian += uneven @ rows
        gradient -= uneven @ asked
    return hessian, gradient


def force_limits(limit: float, friction: Floats) -> tuple[Floats, Floats]:
    """``C F <= d`` (eq 12): friction cones and saturation, C (16, 8) and d (16,).

    Four rows a wheel: forward and backward friction, normal force at least 0, at most `limit` [N].
    `friction` (4,) is what each wheel may use.
    """
    C = np.zeros((16, 8))
    for w, mu in enumerate(friction):
        block = np.array([[1.0, -mu], [-1.0, -mu], [0.0, -1.0], [0.0, 1.0]])
        C[4 * w : 4 * w + 4, 2 * w : 2 * w + 2] = block
    return C, np.tile([0.0, 0.0, 0.0, limit], 4)


def force_torques(state: Measurement, points: Floats, forces: Floats) -> Floats:
    """(4, 2) thigh and calf torques that put `forces` on the robot at `points`: J' F of eq 13.

    `points` (4, 2) are where the forces act: wheel centres (the paper) or contact points [m];
    `forces` (4, 2) are of the ground on the robot, world x and z [N].
    """
    return np.stack(
        [-_moment(points - joint, forces) for joint in (state.hips, state.knees)], axis=-1
    )


def leg_weight_torques(robot: Robot, state: Measurement) -> Floats:
    """(4, 2) thigh and calf torques that carry the legs' own weight."""
    torques = np.zeros((4, 2))
    for k in range(4):
        leg, hip, knee = robot.legs[k // 2], state.hips[k], state.knees[k]
        parts = (
            (state.thighs[k], leg.thigh.mass),
            (state.calves[k], leg.calf.mass),
            (state.wheels[k], leg.wheel.mass),
        )
        torques[k, 0] = -sum(mass * GRAVITY * (place - hip)[0] for place, mass in parts)
        torques[k, 1] = -sum(mass * GRAVITY * (place - knee)[0] for place, mass in parts[1:])
    return torques


def _moment(lever: Floats, force: Floats) -> Floats:
    moment: Floats = lever[:, 1] * force[:, 0] - lever[:, 0] * force[:, 1]
    return moment
