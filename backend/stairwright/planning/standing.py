"""Where a plan starts and ends: standing poses on the first and the last level stretch."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from stairwright import _core
from stairwright.arguments import MOST_FRICTION
from stairwright.arrays import Floats, Ints
from stairwright.planning.problem import Limit
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath

End = Literal["start", "goal"]

_EASY = 0.003  # m; more than the legs' least distance, where the robot stands
_LEVEL = 0.01  # m; a stretch whose wheel centre stays within this height is level
_SLOPE = 0.2  # rad; and nowhere steeper than this
_FACE = math.atan(MOST_FRICTION)  # rad; no friction holds a wheel on what is steeper
_NEAR = 0.02  # m; least distance of a standing wheel from an obstacle
_TRY, _TRIES = 0.01, 200  # m; where else the trunk is tried, and how often either way
_CLEAR = 0.02  # m of clearance for legs of 0.4 m, where there is room to stand farther off
_FARTHEST, _STRIDE = 1.0, 0.05  # m; how far off then at most, and in which steps
_SHIFTS = 30  # rounds in which wheels are moved until the trunk is where it was asked to be
_EXACT = 1e-9  # m; then it is there
_AHEAD = 1e-5  # m; least way of each wheel, for plans need two poses that can be told apart
_SLOWEST = 0.5  # rad/s; errors of a measured speed are as large as all that a slower motor does


class NoStandingPose(Exception):
    """There is no place to stand: `kind` is start or goal, `needed` and `available` in `unit`.

    Where no value of the quantity would do, `needed` is None.
    """

    def __init__(
        self, kind: End, s: float, needed: float | None, available: float, message: str,
        quantity: str = "length", unit: str = "m",
    ) -> None:  # fmt: skip
        super().__init__(message)
        self.limit = (
            None if needed is None
            else Limit(needed=needed, available=available, quantity=quantity, unit=unit)
        )  # fmt: skip
        self.kind, self.s = kind, s


@dataclass(frozen=True)
class StandingPose:
    """A resting pose: wheel arc lengths (front, rear) and trunk (x, z, pitch)."""

    wheels: tuple[float, float]
    body: Floats


def scale(robot: Robot) -> float:
    """Size of the robot's legs against those the lengths here were chosen with (0.4 m)."""
    return min(leg.reach for leg in robot.legs) / 0.4


def enlargement(robot: Robot) -> float:
    """The same for what grows with larger robots and stays as it is for smaller ones: 1 or more."""
    return max(1.0, scale(robot))


def stretches(path: WheelPath) -> tuple[tuple[float, float], tuple[float, float]]:
    """Begin and end of the first and of the last level stretch, as arc lengths [m].

    A face at an end of the profile is no ground to stand on: the first stretch begins behind it,
    the last one ends before it.
    """
    low, high = _between_faces(path)
    begins = path.pieces[:, 1]
    s = np.unique([low, *begins[(begins > low) & (begins < high)], high])
    inner = np.concatenate([s[:-1] + 1e-7, s[1:] - 1e-7])
    inner.sort()
    z, steep = path.centres(inner)[:, 1], _steepness(path, inner)

    def run(order: Ints) -> float:
        level = (np.abs(z[order] - z[order[0]]) <= _LEVEL) & (steep[order] <= _SLOPE)
        stop = len(order) if level.all() else int(np.argmin(level))
        if stop < 2:  # a slope from the first point on: its own straight piece
            stop = 2
        return float(inner[order[stop - 1]])

    count = np.arange(len(inner))
    return (low, run(count)), (run(count[::-1]), high)


def _between_faces(path: WheelPath) -> tuple[float, float]:
    """Arc lengths between which the curve lies without faces, and edges round them, at its ends."""
    begins, lengths = path.pieces[:, 1], path.pieces[:, 2]
    first = np.flatnonzero(_steepness(path, begins + 1e-7) < _FACE)
    last = np.flatnonzero(_steepness(path, begins + lengths - 1e-7) < _FACE)
    if len(first) == 0 or len(last) == 0 or last[-1] < first[0]:
        return 0.0, path.length  # faces alone
    return float(begins[first[0]]), float(begins[last[-1]] + lengths[last[-1]])


def _steepness(path: WheelPath, s: Floats) -> Floats:
    """Slope (n,) of the ground below the wheel at arc lengths `s` (n,), either way [rad]."""
    n = path.normals(s)
    steep: Floats = np.abs(np.arctan2(n[:, 0], n[:, 1]))
    return steep


def standing_height(robot: Robot) -> float:
    """Height of the trunk's centre above the wheel centres in the nominal pose [m].

    Where the legs cannot give the robot's nominal height it is the nearest that they can.
    """
    hips = (robot.hips.front[1], robot.hips.rear[1])
    ranges = list(zip(_core.RobotModel(robot.native).reach, hips, strict=True))
    low = max(least + 0.1 * (most - least) - hip for (least, most), hip in ranges)
    high = min(most - 0.02 * (most - least) - hip for (least, most), hip in ranges)
    return min(max(robot.nominal_height - robot.wheel.radius, low), max(high, low))


def stance(robot: Robot) -> float:
    """Distance of the wheels that stand on the level [m]: that of the hips, or more where front and
    rear legs, knees towards each other, would touch so.
    """
    hips = robot.hips.front[0] - robot.hips.rear[0]
    height = standing_height(robot)
    level = np.zeros(())
    for more in np.linspace(0.0, 1.2 * min(leg.reach for leg in robot.legs), 49):
        x = 0.5 * (hips + float(more))
        q = kinematics.inverse(robot, level, level, level, np.array([[x, -height], [-x, -height]]))
        if np.isnan(q).any():
            break
        if _core.legs_distance(robot.native, np.zeros(3), q) >= _core.LEGS_GAP + _EASY:
            return hips + float(more)
    return hips


def standing_pose(path: WheelPath, robot: Robot, front: float, rear: float) -> StandingPose:
    """The nominal pose over wheels at arc lengths `front`, `rear`: trunk along their line."""
    a, b = path.centres(np.array([front, rear]))
    slope = math.atan2(a[1] - b[1], a[0] - b[0])
    # Wheels may stand on unequal heights; the trunk follows half of a slope, all of a small one.
    pitch = -slope if abs(slope) < 0.35 else -0.8 * slope
    up = np.array([math.sin(-pitch) * -1.0, math.cos(pitch)])
    middle = (a + b) / 2 + standing_height(robot) * up
    return StandingPose((front, rear), np.array([middle[0], middle[1], pitch]))


def find_standing_poses(
    terrain: Terrain, robot: Robot, path: WheelPath
) -> tuple[StandingPose, StandingPose]:
    """Start and goal of `terrain`.

    Raises:
        NoStandingPose: If a stretch is too short for the robot, the goal not ahead of the start, a
            calf below its tyre however it stands, or a motor too slow to be controlled.
    """
    (low, first), (last, high) = stretches(path)
    _check_calves(robot, low)
    _check_motors(robot, low)
    gap = stance(robot)
    behind, ahead = _edge(path, robot, low), _edge(path, robot, high)
    flat = first >= high - 1e-6

    if flat and terrain.start is None and terrain.goal is None:
        missing = behind + gap + ahead + 2 * _AHEAD - (high - low)
        if missing > 0.0:
            message = "the flat ground is too short for a start and a goal"
            raise _too_short("goal", path, (low, high), missing, message)
    if terrain.start is not None:
        begin = _at(path, robot, gap, terrain.start, "start")
    elif flat:
        begin = standing_pose(path, robot, low + behind + gap, low + behind)
    else:
        begin = _settle(path, robot, gap, "start", (low, first), behind)
    if terrain.goal is not None:
        end = _at(path, robot, gap, terrain.goal, "goal")
    elif flat:
        end = standing_pose(path, robot, high - ahead, high - ahead - gap)
    else:
        end = _settle(path, robot, gap, "goal", (last, high), ahead)
    way = min(b - a for a, b in zip(begin.wheels, end.wheels, strict=True))
    if way < _AHEAD:
        message = "the goal is not ahead of the start"
        raise NoStandingPose("goal", end.wheels[0], _AHEAD, way, message, "way from start to goal")
    return begin, end


def _check_calves(robot: Robot, s: float) -> None:
    """Refuse a robot whose calf holds all of its wheel: it touches the ground wherever it goes."""
    for where, leg in zip(("front", "rear"), robot.legs, strict=True):
        least = leg.calf.disc_round((0.0, -leg.calf.length))
        if least >= leg.wheel.radius:
            message = f"the {where} calves are thicker than their wheels and touch the ground"
            raise NoStandingPose("start", s, least, leg.wheel.radius, message, "wheel radius")


def _check_motors(robot: Robot, s: float) -> None:
    """Refuse a robot whose motors are too slow to keep it upright, however slow its plan is."""
    for leg in robot.legs:
        for part, motor in zip(("thigh", "calf", "wheel"), leg.motors, strict=True):
            if motor.speed < _SLOWEST:
                message = f"the {part} motors are too slow to keep the robot upright"
                quantity = f"{part} motor speed"
                raise NoStandingPose("start", s, _SLOWEST, motor.speed, message, quantity, "rad/s")


def _edge(path: WheelPath, robot: Robot, s: float) -> float:
    """Distance of a wheel from where the ground ends at arc length `s`, with room for it [m]."""
    wall = bool((np.abs(path.corners - s) < 1e-6).any())  # knees need room in front of it
    return 0.15 * scale(robot) if wall else min(robot.wheel.radius, 0.05)


def _settle(
    path: WheelPath, robot: Robot, gap: float, kind: End, stretch: tuple[float, float], edge: float
) -> StandingPose:
    """The standing pose near where a level stretch meets what follows.

    Args:
        path: The curve of wheel centres.
        robot: Whose wheels they are.
        gap: Distance of the wheels that stand on the level [m].
        kind: Which end of the course it is.
        stretch: Arc lengths where it begins and ends [m].
        edge: Distance of the farther wheel from its outer end where there is room for it [m].

    Raises:
        NoStandingPose: If the stretch is too short, or the wheels are too large.
    """
    s, which = (stretch[1], "first") if kind == "start" else (stretch[0], "last")
    room = stretch[1] - stretch[0]
    lead = (0.25 if kind == "start" else 0.15) * scale(robot)
    least = max(2 * robot.wheel.radius + 0.01, 0.6 * gap)
    if gap < least:
        message = "the wheels would touch each other below hips that are so close"
        raise NoStandingPose(kind, s, least, gap, message, "distance of the hips")
    near = min(lead, max(_NEAR, room - edge - gap))
    far = min(near + gap, max(room - edge, room - 0.5 * (room - least)))
    if far - near < least:
        close = min(lead, _NEAR)
        missing = least + close + min(edge, close) - room
        message = f"the {which} flat stretch is too short"
        raise _too_short(kind, path, stretch, missing, message)
    front, rear, away = (far, near, 1.0) if kind == "goal" else (-near, -far, -1.0)
    ground = _core.Terrain(path.vertices)

    def farther(way: float) -> StandingPose:
        return standing_pose(path, robot, s + front + away * way, s + rear + away * way)

    def clearance(pose: StandingPose) -> float:
        x, z, pitch = pose.body
        q = kinematics.inverse(robot, x, z, pitch, path.centres(np.array(pose.wheels)))
        return _core.least_clearance(ground, robot.native, pose.body, q)

    pose, enough = farther(0.0), _CLEAR * scale(robot)
    if clearance(pose) >= enough:
        return pose
    ways = np.arange(0.0, min(room - edge - far, _FARTHEST * scale(robot)), _STRIDE * scale(robot))
    return max(
        map(farther, ways), key=lambda one: round(min(clearance(one), enough), 4), default=pose
    )


def _too_short(
    kind: End, path: WheelPath, stretch: tuple[float, float], missing: float, message: str
) -> NoStandingPose:
    """What is said where `missing` m more of a stretch would do: the ground's length, not the way
    of the wheels, which do not reach into its corners.
    """
    x = path.contacts(np.array([stretch[0] + 1e-6, stretch[1] - 1e-6]))[:, 0]
    corners = path.vertices
    begin = max(0, int(np.searchsorted(corners[:, 0], x[0], side="right")) - 1)
    end = min(len(corners) - 1, int(np.searchsorted(corners[:, 0], x[1], side="left")))
    length = math.dist(corners[begin], corners[end])
    s = stretch[1] if kind == "start" else stretch[0]
    return NoStandingPose(kind, s, length + missing + _AHEAD, length, message)


def _at(path: WheelPath, robot: Robot, gap: float, x: float, kind: End) -> StandingPose:
    """The standing pose whose trunk is at `x`, wheels `gap` apart [m]."""
    apart = 0.5 * gap
    ahead, behind = x + apart, x - apart
    x0, x1 = path.centres(np.array([0.0, path.length]))[:, 0]
    if behind < x0 - 1e-9 or ahead > x1 + 1e-9:
        side = x0 - behind if behind < x0 else ahead - x1
        gap = ahead - behind
        raise NoStandingPose(
            kind, path.at_x(min(max(x, x0), x1)), gap, gap - side, "a wheel leaves the profile"
        )
    found = _resting(path, robot, x)
    if found is None:
        tries = (x + side * k * _TRY for k in range(1, _TRIES) for side in (-1.0, 1.0))
        on = (one for one in tries if x0 + apart < one < x1 - apart)
        near = next((one for one in on if _resting(path, robot, one) is not None), None)
        message = "the robot cannot stand with its trunk there: the ground is too steep or uneven"
        raise NoStandingPose(kind, path.at_x(x), near, x, message, "x of the trunk")
    return found


def _resting(path: WheelPath, robot: Robot, x: float) -> StandingPose | None:
    """The standing pose whose trunk is at `x`, wheels on the profile, if it is found."""
    x0, x1 = path.centres(np.array([0.0, path.length]))[:, 0]
    # On a slope the trunk leans off the wheels' middle: move the wheels until it is where asked.
    shift, apart = 0.0, 0.5 * stance(robot)
    for _ in range(_SHIFTS):
        ahead, behind = x + apart + shift, x - apart + shift
        s = np.clip([ahead, behind], x0, x1)
        found = standing_pose(path, robot, path.at_x(s[0]), path.at_x(s[1]))
        missing = x - float(found.body[0])
        if abs(missing) < _EXACT:
            return found
        shift += missing
    return None
