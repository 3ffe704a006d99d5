"""Plans as fast as dynamics, motors and the pace that is asked for allow."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np

from stairwright import _core
from stairwright.arrays import Flags, Floats
from stairwright.planning.binding import Margins
from stairwright.planning.certificate.dynamics import WINDOW, Dynamics, dynamics_of
from stairwright.planning.plan import Plan, Quantity, Timing, plan_id
from stairwright.planning.pose_arrays import PoseArrays
from stairwright.planning.poses.interpolation import reference
from stairwright.planning.poses.pose_reference import WHEELS
from stairwright.planning.smoothing.path_document import poses_at
from stairwright.planning.standing import enlargement
from stairwright.terrain.wheel_path import WheelPath, wheel_path

from .limits import LEAST_EASE, LimitName, Limits, Pace, limits_of
from .moving_robot import MovingRobot, moving_robot, reach_of
from .path_position import least_within, path_positions

SLOWEST = 0.01  # m/s along the path, where a plan starts and ends
_ROUNDS = 60  # of slowing down where a plan would not be certified; few need more than 8
_LOCAL = 40  # of them around the places where it would not; then of all of it: at rest it holds
_SLOWER = 0.8  # each time
_CLEAR = 0.01  # m of clearance, for legs of 0.4 m or less, below which it is driven gently
_STRAY = 0.012  # m that a wheel on an edge may be from its place, below which it is driven gently
_STEEP = 0.5  # of a normal's z, below which the ground is a face and no tread
_AT_DROPS = 0.1  # m before an edge down and after it, for legs of 0.4 m or less
_SLOWER_AT_DROPS = 0.5  # where the edge may come sooner; with 0.6 some robots still fell
_BINDS = 0.02  # of a cap or of a row's room
_MOTORS: tuple[Quantity, Quantity] = ("torque", "wheel_torque")
_STRAINED = 0.8  # of a motor's torque for standing, up to which motion may take half of the rest


@dataclass(frozen=True)
class TimingProblem:
    """How fast may this be driven?

    Attributes:
        motion: Along the path.
        limits: Of speed and acceleration.
        poses: (p,) position of the plan's poses [m].
        effort: (p,) largest share of a leg motor's torque that standing takes at them.
    """

    motion: MovingRobot
    limits: Limits
    poses: Floats
    effort: Floats

    @classmethod
    def of(cls, plan: Plan, aggressiveness: float) -> Self:
        """Of a feasible plan of method ``path``; for `aggressiveness` see `limits.Pace`."""
        robot = plan.robot_description
        path = wheel_path(plan.terrain, robot.wheel.radius)
        line = reference(plan, joint_rate=None)
        motion = moving_robot(line, reach_of(robot))
        arrays = PoseArrays.of(plan)
        progress = arrays.progress
        large = enlargement(robot)
        pace = Pace.of(aggressiveness).at_size(large)
        margins = Margins.of(robot, plan.least_friction, plan.poses).measured()

        def along(values: Floats) -> Floats:
            return np.interp(motion.progress, progress, values)

        on_edge = path.on_edge(arrays.s).any(axis=1)
        stray = np.where(on_edge, margins["friction"][0] * robot.wheel.radius, np.inf)
        ease = along(_ease(margins["clearance"][0], stray, large))
        legs, wheels = (1.0 - margins[kind][0] / margins[kind][1] for kind in _MOTORS)
        effort = np.stack([along(legs), along(wheels)], axis=1)
        limits = limits_of(motion, robot, path, plan.least_friction, effort, pace, ease)
        poses = np.interp(progress, line.progress, path_positions(line))
        return cls(motion, limits, poses, legs)

    def times(self, squares: Floats) -> Floats:
        """When each sample is reached (n,) [s]: constant acceleration between two."""
        speeds = np.maximum(np.sqrt(squares), SLOWEST)
        steps = 2.0 * self.motion.step / (speeds[:-1] + speeds[1:])
        return np.concatenate([[0.0], np.cumsum(steps)])

    def least_time(self) -> float:
        """From the first pose to the last at best [s], before the certificate is asked."""
        return float(self.times(fastest(self))[-1])

    def pose_times(self, squares: Floats) -> Floats:
        """When each pose is reached (p,) [s]."""
        return np.interp(self.poses, self.motion.position, self.times(squares))


def _ease(clearance: Floats, stray: Floats, large: float) -> Floats:
    """Share (n,) of accelerations that is allowed at each pose: less near the ground, and where a
    wheel on an edge slides once it is `stray` (n,) [m] from its place.
    """
    room = np.minimum(clearance / (_CLEAR * large), stray / _STRAY)
    return np.clip(room, LEAST_EASE, 1.0)


def hastened(plan: Plan, aggressiveness: float) -> tuple[Plan, Dynamics]:
    """A certified path at the times in which it is driven fastest, and its dynamics then.

    Args:
        plan: A feasible plan of method ``path``; its poses stay.
        aggressiveness: 0..1, see `limits.Pace`.
    """
    robot = plan.robot_description
    problem = TimingProblem.of(plan, aggressiveness)
    off = plan.tolerance.place + plan.tolerance.height if plan.tolerance else 0.0
    if off > 0.0:
        path = wheel_path(plan.terrain, robot.wheel.radius)
        slow_down_at_drops(problem, path, enlargement(robot))
        slow_down_nearby(problem, off)
    squares = fastest(problem)
    most = 0.5 * (1.0 + np.maximum(problem.effort, _STRAINED))
    for k in range(_ROUNDS):
        found = dynamics_of(plan, problem.pose_times(squares))
        failures: dict[LimitName, Flags] = {
            "balance": found.out_of_balance,
            "torque": found.share > most,
        }
        if not any(flags.any() for flags in failures.values()):
            break
        if k >= _LOCAL:
            failures = {name: np.full_like(flags, flags.any()) for name, flags in failures.items()}
        slow_down(problem, failures, squares)
        squares = fastest(problem)
    else:
        found = dynamics_of(plan, problem.pose_times(squares))
    names = binding(problem, squares)
    places = np.searchsorted(problem.motion.position, problem.poses).clip(0, len(names) - 1)
    limits = [names[k] for k in places]
    timing = Timing(total=float(found.time[-1]), rule="fast", limits=limits)
    asked = (
        plan.terrain, robot, plan.friction, plan.method, plan.weights, timing.rule, plan.tolerance,
    )  # fmt: skip
    poses = poses_at(plan, found.time)
    moving = plan.model_copy(update={"id": plan_id(*asked), "poses": poses, "timing": timing})
    return moving, found


def slow_down_at_drops(problem: TimingProblem, path: WheelPath, large: float) -> None:
    """Lower caps where wheels are near to an edge down or on the face below it.

    Where the edge comes sooner than drawn they hang in the air for a moment, and only the momentum
    of the trunk says where it goes. Robots with legs `large` (>= 1) times 0.4 m begin farther off.
    """
    squares = fastest(problem)
    wheels = problem.motion.values[:, WHEELS]
    normals = np.stack([path.normals(pair) for pair in wheels.T])
    elsewhere = ~((normals[..., 0] > 0.0) & (normals[..., 1] < _STEEP)).any(axis=0)
    reached = math.ceil(_AT_DROPS * large / problem.motion.step)
    near = least_within(elsewhere.astype(float), reached) == 0.0
    caps = problem.limits.caps
    slow = np.where(near, _SLOWER_AT_DROPS**2 * squares, np.inf)
    caps["impact"] = np.minimum(caps["impact"], slow)


def slow_down_nearby(problem: TimingProblem, reach: float) -> None:
    """Lower caps to the least speed within `reach` [m] of path: what wheels meet may be there."""
    squares = fastest(problem)
    rises, falls = (np.flatnonzero(s * np.diff(squares) > 0.0) for s in (1.0, -1.0))
    inner = slice(falls[0], rises[-1] + 1)  # what is before and after starts from rest, and ends so
    reached = math.ceil(reach / problem.motion.step)
    if inner.stop <= inner.start:
        return
    lowest = np.full(len(squares), np.inf)
    lowest[inner] = squares[inner]
    caps = problem.limits.caps
    caps["impact"] = np.minimum(caps["impact"], least_within(lowest, reached))


def slow_down(problem: TimingProblem, failures: Mapping[LimitName, Flags], squares: Floats) -> None:
    """Lower caps around poses at which the certificate's own dynamics find too much asked for.

    Rows hold at samples of the path, with differences over a part of it; the certificate judges
    poses, with differences over a time and straight lines from pose to pose: its accelerations
    depend on the way to the poses next to one, too, however long that takes.

    Args:
        problem: Whose caps are lowered.
        failures: By limit, flags (p,) of poses where it is broken.
        squares: (n,) squared speeds at which they are.
    """
    passed, caps = problem.times(squares), problem.limits.caps
    times = problem.pose_times(squares)
    before = np.minimum(np.append(times[0], times[:-1]), times - WINDOW)
    after = np.maximum(np.append(times[1:], times[-1]), times + WINDOW)
    for name, failed in failures.items():
        near = np.zeros(len(passed), np.bool_)
        for begin, end in zip(before[failed], after[failed], strict=True):
            near |= (passed >= begin) & (passed <= end)
        cap = caps.get(name, np.full(len(passed), np.inf))
        caps[name] = np.where(near, np.minimum(cap, _SLOWER**2 * squares), cap)


def fastest(problem: TimingProblem) -> Floats:
    """Squared speeds (n,) along the path [m^2/s^2], from rest to rest."""
    caps = np.minimum.reduce(list(problem.limits.caps.values()))
    return _core.fastest_squares(problem.limits.rows, caps, problem.motion.step)


def binding(problem: TimingProblem, squares: Floats) -> list[LimitName]:
    """What keeps the robot from being faster at each sample."""
    limits = problem.limits
    u = np.append(np.diff(squares), 0.0) / (2.0 * problem.motion.step)
    a, b, c = np.moveaxis(limits.rows, -1, 0)
    room = (a * squares[:, None] + b * u[:, None] + c) / np.maximum(c, 1e-6)
    row = room.argmin(axis=1)
    names = [limits.names[k] for k in row]
    for name, cap in limits.caps.items():
        for i in np.flatnonzero(squares >= (1.0 - _BINDS) * cap):
            names[i] = name
    return names
