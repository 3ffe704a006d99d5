"""When each node is passed: speed within the limits of wheels, joints and margins."""

from __future__ import annotations

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.planning.plan import Plan
from stairwright.planning.wheel_samples import rolled
from stairwright.robot import kinematics
from stairwright.robot.description import Robot

JOINT_RATE = 1.5  # rad/s; faster legs swing more than a controller can follow
_PITCH_RATE = 0.8  # rad/s
_ALONE = 1.5  # one wheel may roll this much faster than the speed along the course
_ACCELERATION = 0.4  # m/s^2 along the path
_THIN = 0.03  # m; below this CoM margin the robot slows down
_SLOWEST = 0.4  # of the wished speed
_SWAY = 0.5  # of the CoM margin that accelerations may take
_LEAST_SWAY = 0.01  # m; what they may take where there is hardly any margin
_TICK = 0.02  # s between samples of the accelerations
_WINDOW = 0.08  # s; standard deviation of the window that they are averaged over
_ROUNDS = 6
_LEAST_SPARE = 0.02  # of a motor's torque, for moving, that counts where there is hardly any


def path_parameter(s: Floats, body: Floats) -> Floats:
    """Progress (n,) [m]: mean arc length that the wheels have rolled, forward or back.

    Where the trunk moves above standing wheels it grows by a thousandth of the trunk's motion, so
    that it rises strictly.
    """
    moved = np.abs(np.diff(body, axis=0)).sum(axis=1)
    return np.concatenate([[0.0], np.cumsum(rolled(s) + 1e-3 * moved + 1e-7)])


def pose_times(
    robot: Robot, s: Floats, body: Floats, q: Floats, margin: Floats, effort: Floats, speed: float
) -> Floats:
    """Times (n,) [s] of the nodes.

    Args:
        robot: Its actuators' speeds bound wheels and joints.
        s: (n, 2) arc lengths.
        body: (n, 3) trunk poses.
        q: (n, 4) joints.
        margin: (n,) CoM margin [m]; thin margins slow the robot down.
        effort: (n,) largest share of a leg motor's torque that standing takes; the faster a motor
            turns the less torque it has.
        speed: Wished mean wheel speed [m/s].
    """
    wheel_cap = 0.5 * robot.wheel_speed * robot.wheel.radius
    spare = np.maximum(1.0 - np.maximum(effort[:-1], effort[1:]), _LEAST_SPARE)
    joint_cap = np.minimum(JOINT_RATE, robot.leg_speed * np.minimum(0.3, 0.5 * spare))
    ds = np.abs(np.diff(s, axis=0))
    length = np.diff(path_parameter(s, body))
    thin = np.clip(np.minimum(margin[:-1], margin[1:]) / _THIN, _SLOWEST, 1.0)
    least = np.maximum.reduce(
        [
            0.5 * ds.sum(axis=1) / (speed * thin),
            ds.max(axis=1) / np.minimum(_ALONE * speed * thin, wheel_cap),
            np.abs(np.diff(q, axis=0)).max(axis=1) / joint_cap,
            np.abs(np.diff(body[:, 2])) / _PITCH_RATE,
        ]
    )
    # Accelerate and brake gently between the speeds that the segments allow.
    fastest = length / np.maximum(least, 1e-9)
    node = np.minimum(np.append(fastest, fastest[-1]), np.insert(fastest, 0, fastest[0]))
    node[0] = node[-1] = min(0.02, 0.2 * speed)
    gained = 2 * _ACCELERATION * np.concatenate([[0.0], np.cumsum(length)])  # of squared speed
    square = np.minimum.accumulate(node**2 - gained) + gained
    square = np.minimum.accumulate((square + gained)[::-1])[::-1] - gained
    node = np.sqrt(np.maximum(square, 0.0))
    mean = np.maximum(0.5 * (node[:-1] + node[1:]), 1e-6)
    steps = np.maximum(least, length / mean)
    times = np.concatenate([[0.0], np.cumsum(steps)])
    return _calmed(robot, times, body, q, margin)


def standing_effort(plan: Plan) -> Floats:
    """Largest share (n,) of a leg motor's torque that standing takes at each pose."""
    most = float(plan.robot_description.torque_limits[:, :2].min())
    effort: Floats = 1.0 - np.array([pose.margins.torque for pose in plan.poses]) / most
    return effort


def _calmed(robot: Robot, times: Floats, body: Floats, q: Floats, margin: Floats) -> Floats:
    """Times (n,) [s] stretched where accelerations of the CoM would eat up its margin.

    Statically the weight acts at the CoM. While the CoM, `h` above the lower wheel's contact,
    accelerates by `a`, weight and inertia together act `h a / g` beside it, and balance needs that
    to stay within the margin as well. Slower by a factor, accelerations fall by its square.
    """
    frames = kinematics.forward(robot, body[:, 0], body[:, 1], body[:, 2], q)
    x, z, pitch = body.T
    com = kinematics.com(robot, x, z, pitch, frames)
    height = com[:, 1] - frames.wheels[..., 1].min(axis=1) + robot.wheel.radius
    allowed = np.maximum(_SWAY * margin, _LEAST_SWAY)
    reach, window = _window()
    for _ in range(_ROUNDS):
        even = even_times(times)
        if len(even) < 2 * reach + 3:
            break
        x = np.interp(even, times, com[:, 0])
        padded = np.pad(x, reach, mode="edge")
        smooth = np.convolve(padded, window, "valid")
        sway = np.abs(np.gradient(np.gradient(smooth, _TICK), _TICK))
        sway *= np.interp(even, times, height) / _core.GRAVITY
        excess = sway / np.interp(even, times, allowed)
        if excess.max() < 1.05:
            break
        times = stretched(times, even, np.sqrt(np.maximum(excess, 1.0)))
    return times


def even_times(times: Floats) -> Floats:
    """Times (m,) [s] at which accelerations are looked at."""
    even: Floats = np.arange(0.0, times[-1] + _TICK, _TICK)
    return even


def stretched(times: Floats, even: Floats, factor: Floats) -> Floats:
    """Times (n,) [s] slower by `factor` (m,) at `even` times (m,), and smoothly so around them."""
    reach, window = _window()
    most = np.pad(factor, reach, mode="edge")
    most = np.lib.stride_tricks.sliding_window_view(most, 2 * reach + 1).max(axis=1)
    smooth = np.convolve(np.pad(most, reach, mode="edge"), window, "valid")
    middle = 0.5 * (times[:-1] + times[1:])
    steps = np.diff(times) * np.interp(middle, even, smooth)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _window() -> tuple[int, Floats]:
    """Half the width of the window of averages in ticks, and its weights."""
    reach = int(4 * _WINDOW / _TICK)
    window = np.exp(-0.5 * (np.arange(-reach, reach + 1) * _TICK / _WINDOW) ** 2)
    return reach, window / window.sum()
