"""Putting a plan document together: hashes, times, certificate."""

from __future__ import annotations

from time import perf_counter

from stairwright.documents import Model
from stairwright.planning.binding import binding_of
from stairwright.planning.certificate.certify import certify
from stairwright.planning.plan import Method, Plan, Pose, Timing, plan_id
from stairwright.planning.problem import Problem
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain


def assemble(
    method: Method,
    terrain: Terrain,
    robot: Robot,
    friction: float,
    weights: Model,
    poses: list[Pose],
    problem: Problem | None,
    *,
    begun: float,
    critical: list[int] | None = None,
    certified: bool = True,
) -> Plan:
    """The document of a plan whose poses are timed by eqs 25-26, with a certificate of its poses.

    Args:
        method: That made it.
        terrain: The profile.
        robot: The robot.
        friction: Between wheels and terrain.
        weights: The method's weights.
        poses: In order of progress.
        problem: What stops the robot, if anything.
        begun: When planning began, by `time.perf_counter` [s].
        critical: Indices of key poses.
        certified: Check the poses.
    """
    numbers = weights.model_dump()
    plan = Plan(
        id=plan_id(terrain, robot, friction, method, numbers),
        method=method,
        terrain=terrain,
        terrain_hash=terrain.hash,
        robot=robot.name,
        robot_hash=robot.hash,
        robot_description=robot,
        friction=friction,
        weights=numbers,
        status="feasible" if problem is None else "infeasible",
        problem=problem,
        poses=poses,
        critical=critical or [],
        timing=Timing(total=poses[-1].time if poses else 0.0, rule="paper"),
        solve_time=perf_counter() - begun,
        binding=binding_of(robot, friction, poses),
    )
    if not (poses and certified):
        return plan
    return plan.model_copy(update={"certificate": certify(plan, "poses")})
