"""The paper's planner: optimal poses at critical places only (eqs 17-22), known ends.

Two poses for each obstacle: the front wheel arriving at its face, and just past it, where the rear
wheel is still below. The rear wheel's place is found by solving the problem at several places and
keeping the pose with most room for the centre of mass. Poses of a uniform flight are solved once
and moved along.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import perf_counter

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.assembly import assemble
from stairwright.planning.certificate.joining import motion_problem
from stairwright.planning.infeasibility.diagnosis import diagnose, no_standing_pose, statics_problem
from stairwright.planning.plan import Certificate, Plan, Pose
from stairwright.planning.poses.paper_timing import pose_times
from stairwright.planning.poses.pose_documents import complete_poses
from stairwright.planning.poses.pose_locations import Obstacle, find_obstacles, front_places
from stairwright.planning.poses.pose_search import ContactPair, Found, PoseSearch
from stairwright.planning.problem import Problem, between_poses
from stairwright.planning.standing import (
    NoStandingPose,
    StandingPose,
    find_standing_poses,
    standing_pose,
)
from stairwright.planning.weights import CriticalWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath, wheel_path

PoseSearcher = Callable[[Robot, WheelPath, float, CriticalWeights], PoseSearch]

TAIL = 0.15  # m between an obstacle and a standing wheel, for legs of 0.4 m
CONGRUENT = 1e-6  # m; moved poses of a uniform flight must fit the terrain this well


def plan_critical(
    terrain: Terrain,
    robot: Robot,
    friction: float,
    weights: CriticalWeights,
    solver: PoseSearcher = PoseSearch,
    certified: bool = True,
) -> Plan:
    """Initial pose, two optimal poses per obstacle, final pose.

    Args:
        terrain: The profile.
        robot: The robot.
        friction: Between wheels and terrain.
        weights: Q of eq 17, speed, and whether whole links are kept clear.
        solver: `PoseSearch`, or the reference `casadi_search.CasadiSearch`.
        certified: Check the poses and the motion between them.

    Returns:
        The plan; infeasible with a problem where a pose has no solution or no equilibrium. The
        poses found before it are kept.
    """
    made = partial(assemble, "critical", terrain, robot, friction, weights, begun=perf_counter())
    try:
        path = wheel_path(terrain, robot.wheel.radius)
        begin, end = find_standing_poses(terrain, robot, path)
    except NoStandingPose as error:
        stop = no_standing_pose(terrain, robot, error)
        return made([], stop)
    search = solver(robot, path, friction, weights)
    obstacles = find_obstacles(path, begin.wheels[1], end.wheels[0])
    found, problem = _solve(search, obstacles, begin, end)
    if problem is not None and len(found) > 1:  # there was a choice before
        # Balance on the way to one pose can lead to where the next one is out of reach.
        other, left = _solve(search, obstacles, begin, end, balance=False)
        found, problem = (other, None) if left is None else (found, problem)
    knots = [_standing(search, begin), *found]
    if problem is None:
        knots.append(_standing(search, end))
    knots = _obstructions_ahead(knots)
    poses = _poses(search, knots, weights.speed)
    if problem is None:
        problem = _unbalanced(search, poses)
    optimal = [i for i, knot in enumerate(knots) if knot.optimal]
    plan = made(poses, problem, critical=optimal, certified=certified)
    if problem is not None or plan.certificate is None:
        return plan
    certificate = Certificate.of_poses(
        plan.certificate.checks, lambda: _tipping(search, knots, poses) or motion_problem(plan)
    )
    return plan.model_copy(update={"certificate": certificate})


@dataclass(frozen=True)
class _Knot:
    trunk: tuple[float, float, float]
    joints: Floats
    wheels: tuple[float, float]
    optimal: bool = False


def _standing(search: PoseSearch, standing_pose: StandingPose) -> _Knot:
    x, z, pitch = (float(value) for value in standing_pose.body)
    return _Knot((x, z, pitch), search.standing, standing_pose.wheels)


def _solve(
    search: PoseSearch,
    obstacles: list[Obstacle],
    begin: StandingPose,
    end: StandingPose,
    balance: bool = True,
) -> tuple[list[_Knot], Problem | None]:
    """Poses between the ends; with `balance` such as the robot can go through without tipping."""
    knots: list[_Knot] = []
    rear = begin.wheels[1]
    before = _variables(_standing(search, begin))
    pairs: list[tuple[_Knot, _Knot]] = []
    fronts = front_places(obstacles, search.path.radius, begin.wheels[0], end.wheels[0])
    for k, (obstacle, (first, second)) in enumerate(zip(obstacles, fronts, strict=True)):
        rest = _rest(search, obstacles, k)
        following = end if k + 1 == len(obstacles) else rest
        after = None if following is None else _variables(_standing(search, following))
        moved = _moved_pair(search, obstacles, pairs, k)
        if moved is not None and moved[0].wheels[1] >= rear:
            pair = moved
        else:
            span, up = (rear, end.wheels[1]), obstacle.height > 0
            places = (
                ContactPair(first, span, True, obstacle.steepest, up, before),
                ContactPair(second, span, False, obstacle.steepest, up, before),
            )
            both = search.best_pair(*places, after, balance)
            for place, one in zip(places, both, strict=True):
                if one is None or not one.solution.solved:
                    way = (place.front + place.rear[0] - sum(begin.wheels)) / 2
                    problem = diagnose(search, place)
                    return knots, problem.model_copy(update={"progress": max(0.0, way)})
                knots.append(_knot(one))
            pair = (knots[-2], knots[-1])
            del knots[-2:]
        pairs.append(pair)
        knots.extend(pair)
        if rest is not None:
            knots.append(_standing(search, rest))
        rear = knots[-1].wheels[1]
        before = _variables(knots[-1])
    return knots, None


def _rest(search: PoseSearch, obstacles: list[Obstacle], k: int) -> StandingPose | None:
    """The standing pose after obstacle `k`, if there is room for it before the next one.

    A platform on which the robot can stand ends one task of the paper and begins the next.
    """
    if k + 1 == len(obstacles):
        return None
    hips = search.robot.hips
    rear = obstacles[k].end + TAIL * search.scale
    front = rear + hips.front[0] - hips.rear[0]
    room = obstacles[k + 1].begin - TAIL * search.scale
    return standing_pose(search.path, search.robot, front, rear) if front <= room else None


def _variables(knot: _Knot) -> Floats:
    """The nine variables of a pose."""
    return np.array([*knot.trunk, *knot.joints, *knot.wheels])


def _knot(found: Found) -> _Knot:
    x = found.solution.x
    return _Knot((float(x[0]), float(x[1]), float(x[2])), x[3:7], (float(x[7]), float(x[8])), True)


def _moved_pair(
    search: PoseSearch, obstacles: list[Obstacle], pairs: list[tuple[_Knot, _Knot]], k: int
) -> tuple[_Knot, _Knot] | None:
    """The last pair moved to obstacle `k`, if the flight is uniform there; else None."""
    if not search.repeats or len(pairs) < 2 or not obstacles[k].same_as(obstacles[k - 1]):
        return None
    way = obstacles[k].begin - obstacles[k - 1].begin
    path = search.path
    step = np.diff(path.centres(np.array([obstacles[k - 1].begin, obstacles[k].begin])), axis=0)[0]
    out = []
    for knot in pairs[-1]:
        wheels = (knot.wheels[0] + way, knot.wheels[1] + way)
        before, after = path.centres(np.array(knot.wheels)), path.centres(np.array(wheels))
        trunk = (knot.trunk[0] + step[0], knot.trunk[1] + step[1], knot.trunk[2])
        if np.abs(after - before - step).max() > CONGRUENT or not search.clear(trunk, wheels):
            return None
        if search.settled(wheels[1]) != search.settled(knot.wheels[1]):
            return None
        out.append(_Knot((float(trunk[0]), float(trunk[1]), trunk[2]), knot.joints, wheels, True))
    return out[0], out[1]


def _obstructions_ahead(knots: list[_Knot]) -> list[_Knot]:
    """Without those that are no farther on: past one face may be where the next one is met."""
    out = knots[:1]
    for knot in knots[1:]:
        if sum(knot.wheels) > sum(out[-1].wheels) + CONGRUENT:
            out.append(knot)
    return out


def _poses(search: PoseSearch, knots: list[_Knot], speed: float) -> list[Pose]:
    wheels = np.array([knot.wheels for knot in knots])
    trunks = np.array([knot.trunk for knot in knots])
    joints = np.array([knot.joints for knot in knots])
    times = pose_times(wheels, speed)
    return complete_poses(search.robot, search.path, search.friction, trunks, wheels, joints, times)


def _unbalanced(search: PoseSearch, poses: list[Pose]) -> Problem | None:
    worst = min(poses, key=lambda pose: pose.margins.com)
    return None if worst.margins.com >= 0.0 else statics_problem(search, worst)


def _tipping(search: PoseSearch, knots: list[_Knot], poses: list[Pose]) -> Problem | None:
    """The worst loss of balance between two poses, where no clear pose on the way prevents it."""
    variables = [_variables(knot) for knot in knots]
    lost = [search.imbalance(a, b) for a, b in itertools.pairwise(variables)]
    if not any(lost):
        return None
    k = int(np.argmax(lost))
    what = (
        f"balance needs the centre of mass {lost[k] * 1e3:.0f} mm from where it can be"
        if math.isfinite(lost[k])
        else f"friction {search.friction:g} holds the robot nowhere"
    )
    return between_poses("statics", poses[k].contacts[0], poses[k].progress, k + 1, what)
