"""`method: path`: a dense, smooth, certified path over any profile."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from functools import partial

import numpy as np

from stairwright.errors import InputError
from stairwright.planning.attempt import Blocked, Solved
from stairwright.planning.certificate.certify import with_dynamics
from stairwright.planning.courses import courses
from stairwright.planning.infeasibility.diagnosis import no_standing_pose
from stairwright.planning.path_planner import PathPlanner
from stairwright.planning.plan import Plan, PlanTiming
from stairwright.planning.problem import Problem
from stairwright.planning.smoothing.path_document import make_plan
from stairwright.planning.standing import NoStandingPose, StandingPose
from stairwright.planning.strategy import solve
from stairwright.planning.threads import search_threads
from stairwright.planning.timing.fast import hastened
from stairwright.planning.timing.steady import slowed_where_strained
from stairwright.planning.tolerance import Tolerance
from stairwright.planning.tolerant import Fallen, tolerance_problem, within_tolerance
from stairwright.planning.underway import underway
from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

# Of a margin that is not thin: where the usual configuration of the knees has as much, no other is
# looked for. In some the CoM has more, but joints and motors less, and rollouts failed.
_ENOUGH = 1 / 3


def plan_path(
    terrain: Terrain,
    robots: Sequence[Robot],
    friction: float,
    weights: PathWeights,
    *,
    timing: PlanTiming = "steady",
    tolerance: Tolerance | None = None,
    diagnose: bool = True,
    here: StandingPose | None = None,
) -> Plan:
    """Plan a dense path of poses from the first flat stretch to the last.

    Wheels keep rolling contact; trunk, links and legs stay clear; joints, torques and speeds keep
    their limits; and the robot is in static balance inside the friction cones at every instant. The
    plan is called feasible only if the independent certificate passes.

    Args:
        terrain: The profile.
        robots: The robot, in every configuration of its knees, the usual one first. The first is
            taken that has a path with some CoM margin, else the one with the most, else the one
            that comes farthest.
        friction: Coulomb friction between wheels and terrain.
        weights: What to trade off.
        timing: ``fast`` looks for a path that can be driven fast, and times it so.
        tolerance: How far the world may be from what was drawn; the certificate holds for all of
            it.
        diagnose: Find out what would open the way where there is none.
        here: Where the path begins, as near as a pose is sound; by default at the terrain's start.

    Returns:
        The plan; on impossible terrain one with a `problem`, and the poses up to there.
    """
    begun = clock.perf_counter()
    robot = robots[0]
    searched = weights.for_speed() if timing == "fast" else weights
    least = friction - tolerance.friction if tolerance else friction
    document = partial(
        make_plan, terrain, friction=friction, weights=weights, begun=begun, tolerance=tolerance
    )
    try:
        planner_of, fast = courses().planner, timing == "fast"
        planners = [planner_of(terrain, one, least, searched, fast=fast) for one in robots]
    except NoStandingPose as error:
        return document(robot, problem=no_standing_pose(terrain, robot, error))
    except InputError as error:
        return document(robot, problem=Problem.told("start", terrain.points[0], 0.0, str(error)))
    if here is not None:
        planners = [begins for one in planners if (begins := underway(one, here))]
        if not planners:
            what = "no pose near to the one where the path is to begin is sound"
            return document(robot, problem=Problem.told("start", terrain.points[0], 0.0, what))
    ways = _solved(planners)
    planner, found = ways[0]
    robot = planner.robot
    if isinstance(found, Solved) and tolerance:
        outcome = within_tolerance(planner, found, tolerance, search_threads())
        if isinstance(outcome, Fallen):
            return document(robot, problem=tolerance_problem(outcome, tolerance))
        found = outcome
    if isinstance(found, Solved):
        plan = document(robot, poses=planner.poses(found.nodes))
        plan = plan.model_copy(update={"certificate": found.certificate})
        if timing == "steady":
            return slowed_where_strained(plan, found.nodes.margins.torque_shares("leg"))
        moving, dynamics = hastened(plan, weights.aggressiveness)
        certificate = with_dynamics(found.certificate, moving, dynamics)
        return moving.model_copy(update={"certificate": certificate})
    # They plan again, so they import us.
    from stairwright.planning.infeasibility.obstruction import explain, undiagnosed

    if not diagnose:
        return document(robot, problem=undiagnosed(planner, found))
    planner, problem, way = explain([(one, end) for one, end in ways if isinstance(end, Blocked)])
    return document(planner.robot, poses=way, problem=problem)


def _solved(planners: Sequence[PathPlanner]) -> list[tuple[PathPlanner, Solved | Blocked]]:
    """What comes of courses up to the first that has a path with some margin.

    In the order of that margin, those without a path in that of how far they come.
    """
    tried: list[tuple[PathPlanner, Solved | Blocked]] = []
    for planner in planners:
        found = solve(planner, search_threads())
        tried.append((planner, found))
        if isinstance(found, Solved) and found.margin > _ENOUGH * planner.thin:
            return tried[::-1]

    def worth(one: tuple[PathPlanner, Solved | Blocked]) -> tuple[float, float]:
        found = one[1]
        if isinstance(found, Solved):
            return np.inf, found.margin
        return sum(found.reached or (0.0, 0.0)), 0.0

    return sorted(tried, key=worth, reverse=True)
