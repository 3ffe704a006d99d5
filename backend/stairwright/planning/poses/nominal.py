"""The baseline: the standing pose is kept, the robot rolls over the terrain as one rigid body."""

from __future__ import annotations

import math
from functools import partial
from time import perf_counter

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.assembly import assemble
from stairwright.planning.infeasibility.diagnosis import no_standing_pose, statics_limit
from stairwright.planning.plan import Plan, Pose
from stairwright.planning.poses.paper_timing import pose_times
from stairwright.planning.poses.pose_documents import complete_poses
from stairwright.planning.problem import Limit, Problem
from stairwright.planning.standing import NoStandingPose, find_standing_poses
from stairwright.planning.weights import NominalWeights
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath, wheel_path

STEP = 0.02  # m of the front wheel's way between poses
MOST = 2000  # poses; longer courses get longer steps
_BACK, _AHEAD, _FINE = 0.03, 0.25, 0.002  # m, where the rear wheel's next place is looked for


def plan_nominal(terrain: Terrain, robot: Robot, friction: float, weights: NominalWeights) -> Plan:
    """Poses with standing joints along the course, as far as the wheels can both touch.

    Args:
        terrain: The profile.
        robot: The robot.
        friction: Between wheels and terrain.
        weights: Its speed.

    Returns:
        The plan. Where the standing pose would touch the terrain or tip, the status is infeasible
        and the problem names the first such place; the poses are listed nevertheless.
    """
    made = partial(assemble, "nominal", terrain, robot, friction, weights, begun=perf_counter())
    try:
        path = wheel_path(terrain, robot.wheel.radius)
        begin, end = find_standing_poses(terrain, robot, path)
        _check_standing(robot, begin.wheels[0])
    except NoStandingPose as error:
        stop = no_standing_pose(terrain, robot, error)
        return made([], stop)
    wheels = _roll(path, _wheelbase(robot), begin.wheels, end.wheels[0])
    poses = _poses(robot, path, friction, wheels, weights.speed)
    problem = _first_problem(friction, poses)
    if problem is None and wheels[-1, 0] < end.wheels[0] - STEP:
        problem = _out_of_reach(poses[-1])
    return made(poses, problem)


def _check_standing(robot: Robot, s: float) -> None:
    """Refuse a robot whose legs cannot fold as far as its nominal height asks."""
    if np.isnan(kinematics.standing_joints(robot)).any():
        least = robot.wheel.radius + abs(robot.thigh.length - robot.calf.length)
        text = f"folded, the legs hold the trunk {least:g} m above the ground"
        why = f"{text}, which is more than its nominal height"
        raise NoStandingPose("start", s, least, robot.nominal_height, why, "nominal height")


def _wheelbase(robot: Robot) -> float:
    return robot.hips.front[0] - robot.hips.rear[0]


def _roll(path: WheelPath, gap: float, begin: tuple[float, float], end: float) -> Floats:
    """Arc lengths (n, 2) of the wheels of a rigid body whose wheel centres are `gap` apart."""
    count = min(MOST, max(2, math.ceil((end - begin[0]) / STEP) + 1))
    rear = begin[1]
    out = [(begin[0], rear)]
    for front in np.linspace(begin[0], end, count)[1:]:
        place = _rear_place(path, gap, float(front), rear)
        if place is None:
            break
        rear = place
        if front + rear > sum(out[-1]) + 1e-9:
            out.append((float(front), rear))
    return np.array(out)


def _rear_place(path: WheelPath, gap: float, front: float, near: float) -> float | None:
    """The place next to `near` where the rear wheel is `gap` behind the front one, if any."""
    ahead = path.centres(np.array([front]))[0]

    def excess(s: Floats) -> Floats:
        way: Floats = np.hypot(*(path.centres(s) - ahead).T) - gap
        return way

    s = np.arange(near - _BACK, min(near + _AHEAD, front), _FINE)
    values = excess(s)
    ups = np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0))
    if len(ups) == 0:
        return None
    k = int(ups[np.argmin(np.abs(s[ups] - near))])
    low, high = float(s[k]), float(s[k + 1])
    for _ in range(40):
        middle = (low + high) / 2
        if excess(np.array([middle]))[0] > 0:
            low = middle
        else:
            high = middle
    return high


def _poses(
    robot: Robot, path: WheelPath, friction: float, wheels: Floats, speed: float
) -> list[Pose]:
    standing = kinematics.standing_joints(robot)
    drop = robot.nominal_height - robot.wheel.radius
    times = pose_times(wheels, speed)
    front, rear = path.centres(wheels[:, 0]), path.centres(wheels[:, 1])
    line = front - rear
    pitch = -np.arctan2(line[:, 1], line[:, 0])
    # Hips stand `drop` above the wheels in the trunk frame, so the trunk does above their middle.
    hips = np.array([robot.hips.front, robot.hips.rear]).mean(axis=0)
    up = kinematics.rotate(pitch, np.tile([-hips[0], drop - hips[1]], (len(pitch), 1)))
    trunk = (front + rear) / 2 + up
    joints = np.tile(standing, (len(wheels), 1))
    trunks = np.column_stack([trunk, pitch])
    return complete_poses(robot, path, friction, trunks, wheels, joints, times)


def _first_problem(friction: float, poses: list[Pose]) -> Problem | None:
    for pose in poses:
        place = (pose.contacts[0], pose.progress)
        if pose.margins.clearance < 0.0:
            depth = -pose.margins.clearance
            limit = Limit(needed=depth, available=0.0, quantity="clearance", unit="m")
            what = "the standing pose reaches into the terrain"
            return Problem.told("clearance", *place, what, limit)
        if pose.margins.com < 0.0:
            what = "the standing pose slips or tips"
            return Problem.told("statics", *place, what, statics_limit(friction, pose))
    return None


def _out_of_reach(last: Pose) -> Problem:
    what = "the standing pose cannot keep both wheels on the ground, and stops"
    return Problem.told("reach", last.contacts[0], last.progress, what)
