"""`method: path`: a dense, smooth, certified path over any profile."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence

import numpy as np

from stairwright.errors import InputError
from stairwright.planning.diagnosis import no_stand
from stairwright.planning.plan import Plan, Problem
from stairwright.planning.threads import search_threads
from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

from .assemble import make_plan
from .course import NoStand
from .solve import THIN, Blocked, Course, Solved, pose_course


def plan_path(
    terrain: Terrain, robots: Sequence[Robot], friction: float, weights: PathWeights
) -> Plan:
    """Plan a dense path of poses from the first flat stretch to the last.

    Wheels keep rolling contact; trunk, links and legs stay clear; joints, torques and speeds keep
    their limits; and the robot is in static balance inside the friction cones at every instant. The
    plan is called feasible only if the independent certificate passes.

    Args:
        terrain: The profile.
        robots: The robot, in every configuration of its knees. The first is taken that has a path
            with some CoM margin, else the one with the most, else the one that comes farthest.
        friction: Coulomb friction between wheels and terrain.
        weights: What to trade off.

    Returns:
        The plan; on impossible terrain one with a `problem`, and the poses up to there.
    """
    begun = clock.perf_counter()
    robot = robots[0]
    try:
        courses = [pose_course(terrain, one, friction, weights) for one in robots]
    except NoStand as error:
        problem = no_stand(terrain, robot, error)
        return make_plan(terrain, robot, friction, weights, begun, problem=problem)
    except InputError as error:
        at = terrain.points[0]
        problem = Problem(kind="start", at=at, progress=0.0, message=str(error))
        return make_plan(terrain, robot, friction, weights, begun, problem=problem)
    course, found = _best(courses)
    robot = course.robot
    if isinstance(found, Solved):
        plan = make_plan(terrain, robot, friction, weights, begun, *course.way(found.nodes))
        return plan.model_copy(update={"certificate": found.certificate})
    from stairwright.planning.obstruction import explain  # it plans again, so it imports us

    problem, way = explain(course, found)
    return make_plan(terrain, robot, friction, weights, begun, *way, problem)


def _best(courses: Sequence[Course]) -> tuple[Course, Solved | Blocked]:
    """The first course that has a path with some margin; else the path with most, else the way."""
    tried: list[tuple[Course, Solved | Blocked]] = []
    for course in courses:
        found = course.solve(search_threads())
        tried.append((course, found))
        if isinstance(found, Solved) and found.margin > THIN:
            break

    def worth(one: tuple[Course, Solved | Blocked]) -> tuple[float, float]:
        found = one[1]
        if isinstance(found, Solved):
            return np.inf, found.margin
        return sum(found.reached or (0.0, 0.0)), 0.0

    return max(tried[::-1], key=worth) if len(tried) > 1 else tried[0]
