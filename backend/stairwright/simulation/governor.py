"""How fast the plan advances: its own timing, limits along it, and a maximum lead over the robot.

What advances is the path position: the plan's progress, and where the trunk swings above wheels
that hardly roll, a share of the trunk's motion, so that a swing takes its time.

The plan runs on its own clock, because a purely measured progress stalls (the robot waits for the
plan and the plan for the robot). A maximum lead holds it back: it slows down when it is ahead of
the wheels, stops when it is too far ahead and retreats with a robot that slides back. It hurries
after a robot that runs ahead only a little faster than planned, because it must not jump.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stairwright import _core
from stairwright._core import GRAVITY
from stairwright.arrays import Floats
from stairwright.control.setpoint import (
    ACCELERATIONS,
    COM,
    FORCES,
    JOINTS,
    LEANS,
    PROGRESS,
    RATES,
    SHARE,
    WHEELS,
    WIDTH,
)
from stairwright.control.settings import ControllerSettings
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.planning.poses.interpolation import reference
from stairwright.planning.poses.pose_reference import Reference
from stairwright.planning.timing.limits import WHEEL_SPEED_SHARE
from stairwright.planning.timing.moving_robot import reach_of
from stairwright.planning.timing.path_position import (
    even_grid,
    evened,
    least_within,
    path_positions,
    slopes,
)
from stairwright.planning.timing.steady import retimed
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

LONGEST_WAY = 500.0  # m; the longest level terrain is 200 m
RATE_REACH = 0.005  # m; rates are differences over this far, both ways
LIMIT_REACH = 0.03  # m; a speed limit holds this far before and after its place
ACCELERATION = 0.4  # m/s^2, along the plan
MIN_SPEED = 0.01  # m/s
FAST_LEAD = 4.0  # of the usual lead, for plans that are driven fast


@dataclass(frozen=True)
class Track:
    """A reference on an even grid of path positions, ready for the native core.

    Attributes:
        start: Way of the first row, which is its progress [m].
        step: Way between rows [m].
        rows: (n, 41) set points; rates are per metre of path, accelerations per its square.
        speeds: (n,) allowed speed along the path [m/s].
    """

    start: float
    step: float
    rows: Floats
    speeds: Floats

    @property
    def end(self) -> float:
        """Way of the last row [m]."""
        return self.start + self.step * (len(self.rows) - 1)

    @property
    def duration(self) -> float:
        """Time to the end without waiting for the robot [s]."""
        return float(np.sum(self.step / np.maximum(self.speeds[:-1], MIN_SPEED)))


def track(
    course: Reference,
    robot: Robot,
    path: WheelPath,
    friction: float,
    settings: ControllerSettings,
    *,
    fast: bool = False,
) -> Track:
    """Resample `course` and find the static forces and the allowed speed along it.

    Args:
        course: The plan's trajectory.
        robot: Who carries it out.
        path: Its wheel-centre curve.
        friction: The plan's Coulomb friction.
        settings: Speed and joint speed are limited by them.
        fast: The plan's times respect all limits; only the speed that `settings` may name counts.

    Raises:
        InputError: If the poses are too far apart for any rollout to end.
    """
    position = path_positions(course)
    first, last = float(position[0]), float(position[-1])
    if not last - first <= LONGEST_WAY:
        text = f"the poses are {last - first:.3g} m apart in all; at most {LONGEST_WAY:g} m can be"
        raise InputError(f"{text} carried out", ("plan", "poses"))
    grid = even_grid(position)
    columns = course.planned
    rows = np.zeros((len(grid), WIDTH))
    rows[:, :RATES] = np.stack([np.interp(grid, position, column) for column in columns.T], axis=1)
    reach = reach_of(robot) if fast else RATE_REACH  # a fast plan keeps its limits over that
    rates = slopes(grid, position, columns, reach)
    rows[:, RATES:ACCELERATIONS] = rates
    rows[:, ACCELERATIONS : ACCELERATIONS + RATES] = slopes(grid, grid, rates, reach)
    places, com = np.ascontiguousarray(rows[:, WHEELS]), np.ascontiguousarray(rows[:, COM])
    weight = robot.mass * GRAVITY
    resting = _core.static_forces(path.native, weight, friction, places, com)
    rows[:, FORCES], rows[:, SHARE], rows[:, LEANS] = resting[:, :4], resting[:, 4], resting[:, 5:]
    rows[:, PROGRESS] = np.interp(grid, position, course.progress)
    time = np.interp(grid, position, course.time)
    if fast:
        speeds = 1.0 / evened(grid, slopes(grid, grid, time, reach), reach)
        if settings.speed is not None:
            speeds = np.minimum(speeds, settings.speed)
    else:
        speeds = _limited(_planned(time, grid), grid, rows, robot, settings)
    return Track(first, grid[1] - grid[0], rows, speeds)


def plan_track(plan: Plan, path: WheelPath, settings: ControllerSettings) -> Track:
    """The track of a plan over the wheel-centre curve `path`, at the speed that is wanted."""
    fast = plan.timing.rule == "fast"
    steady = plan.method == "path" and settings.form == "contact" and not fast
    if steady and settings.speed is not None:
        # Another speed keeps what slows a plan down where margins are thin.
        plan = retimed(plan, settings.speed)
        settings = settings.model_copy(update={"speed": None})
    course = reference(plan, joint_rate=None)
    return track(course, plan.robot_description, path, plan.least_friction, settings, fast=fast)


def lead_of(plan: Plan, settings: ControllerSettings) -> float:
    """How far the plan may be ahead of the wheels [m]: they lag the more the faster it is."""
    return settings.lead * (FAST_LEAD if plan.timing.rule == "fast" else 1.0)


def _planned(time: Floats, grid: Floats) -> Floats:
    """Speed along the path (n,) by the plan's own times, the smaller one of either side."""
    step = np.diff(grid) / np.maximum(np.diff(time), 1e-9)
    speeds: Floats = np.minimum(np.append(step, step[-1]), np.append(step[0], step))
    return speeds


def _limited(
    speeds: Floats, grid: Floats, rows: Floats, robot: Robot, settings: ControllerSettings
) -> Floats:
    """Allowed speed along the path (n,): timing, joint and wheel speed limits, acceleration."""
    if settings.speed is not None:
        speeds = np.full(len(grid), settings.speed)
    joint_rates = np.abs(rows[:, RATES + JOINTS.start : RATES + JOINTS.stop]).max(axis=1)
    wheel_rates = np.abs(rows[:, RATES + WHEELS.start : RATES + WHEELS.stop]).max(axis=1)
    wheel_limit = WHEEL_SPEED_SHARE * robot.wheel_speed * robot.wheel.radius
    speeds = np.minimum(speeds, settings.joint_speed / np.maximum(joint_rates, 1e-9))
    speeds = np.minimum(speeds, wheel_limit / np.maximum(wheel_rates, 1e-9))
    reach = max(1, round(LIMIT_REACH / (grid[1] - grid[0])))
    speeds = least_within(speeds, reach)
    # A limit on acceleration: v^2 grows by at most 2 a per metre, from rest and to rest.
    squares = np.minimum(speeds, 10.0) ** 2
    squares[0] = squares[-1] = 0.0
    gain = 2 * ACCELERATION * (grid[1] - grid[0])
    for i in range(1, len(squares)):
        squares[i] = min(squares[i], squares[i - 1] + gain)
    for i in range(len(squares) - 2, -1, -1):
        squares[i] = min(squares[i], squares[i + 1] + gain)
    bounded: Floats = np.maximum(np.sqrt(squares), MIN_SPEED)
    return bounded


def follower(line: Track, lead: float, row: int = 0) -> _core.PlanFollower:
    """What advances along `line` from `row` on, at most `lead` [m] ahead of the wheels."""
    row = min(row, len(line.rows) - 2)
    start = line.start + row * line.step
    return _core.PlanFollower(
        start, line.step, line.rows[row:], line.speeds[row:], maximum_lead=lead
    )


def cruise(line: Track, position: float) -> Floats:
    """(2,) speeds of the wheel pairs at `position` when nothing holds the plan back [m/s]."""
    k = min(max(int((position - line.start) / line.step), 0), len(line.rows) - 1)
    speeds: Floats = line.speeds[k] * line.rows[k, RATES : RATES + 2]
    return speeds
