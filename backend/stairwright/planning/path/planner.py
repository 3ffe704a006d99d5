"""`method: path`: a dense, smooth, certified path over any profile."""

from __future__ import annotations

import time as clock

from stairwright.errors import InputError
from stairwright.planning.diagnosis import no_stand
from stairwright.planning.plan import Plan, Problem
from stairwright.planning.threads import search_threads
from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

from .assemble import make_plan
from .course import NoStand
from .solve import Solved, pose_course


def plan_path(terrain: Terrain, robot: Robot, friction: float, weights: PathWeights) -> Plan:
    """Plan a dense path of poses from the first flat stretch to the last.

    Wheels keep rolling contact; trunk, links and legs stay clear; joints, torques and speeds keep
    their limits; and the robot is in static balance inside the friction cones at every instant. The
    plan is called feasible only if the independent certificate passes.

    Args:
        terrain: The profile.
        robot: The robot.
        friction: Coulomb friction between wheels and terrain.
        weights: What to trade off.

    Returns:
        The plan; on impossible terrain one with a `problem`, and the poses up to there.
    """
    begun = clock.perf_counter()
    try:
        course = pose_course(terrain, robot, friction, weights)
    except NoStand as error:
        problem = no_stand(terrain, robot, error)
        return make_plan(terrain, robot, friction, weights, begun, problem=problem)
    except InputError as error:
        at = terrain.points[0]
        problem = Problem(kind="start", at=at, progress=0.0, message=str(error))
        return make_plan(terrain, robot, friction, weights, begun, problem=problem)
    found = course.solve(search_threads())
    if isinstance(found, Solved):
        plan = make_plan(terrain, robot, friction, weights, begun, *course.way(found.nodes))
        return plan.model_copy(update={"certificate": found.certificate})
    from stairwright.planning.obstruction import explain  # it plans again, so it imports us

    problem, way = explain(course, found)
    return make_plan(terrain, robot, friction, weights, begun, *way, problem)
