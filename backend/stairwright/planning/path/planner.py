"""`method: path`: a dense, smooth, certified path over any profile."""

from __future__ import annotations

import time as clock

from stairwright.errors import InputError
from stairwright.planning.certificate import certify
from stairwright.planning.plan import Limit, Plan, Pose, Problem, Timing, plan_id
from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath, wheel_path

from .assemble import make_poses
from .course import NoStand, Stand, find_stands
from .ground import Ground, make_ground
from .lattice import Search, make_lattice
from .record import LEGS_GAP
from .refine import Refined, refine
from .tables import Bounds

RESERVE = 0.1  # friction that a plan does without where the terrain allows it
PITCHES = 1.9  # rad; largest pitch searched: the trunk may lean back past vertical
_LEVELS = (1.0, 0.8, 0.67)  # lattice refinement, coarse to fine
_BOUNDS = Bounds(trunk=0.006, links=0.006, legs=LEGS_GAP, reach=0.003, thigh=0.0, com=0.005)


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
        The plan; on impossible terrain one with a `problem`.
    """
    begun = clock.perf_counter()
    try:
        path = wheel_path(terrain, robot.wheel.radius)
        stands = find_stands(terrain, robot, path)
    except NoStand as error:
        return _no_stand(terrain, robot, friction, weights, path, error, begun)
    except InputError as error:
        at = terrain.points[0]
        problem = Problem(kind="start", at=at, progress=0.0, message=str(error))
        return make_plan(terrain, robot, friction, weights, begun, problem=problem)
    ground = make_ground(path.vertices)
    for fine in _LEVELS:
        found = _try(path, ground, robot, stands, friction, weights, fine)
        if found is None:
            continue
        poses, keys, total = make_poses(path, robot, found, weights)
        plan = make_plan(terrain, robot, friction, weights, begun, poses, keys, total)
        checked = certify(plan)
        plan = plan.model_copy(
            update={"certificate": checked, "solve_time": clock.perf_counter() - begun}
        )
        if checked.passed:
            return plan
    problem = Problem(kind="reach", at=terrain.points[0], progress=0.0, message="no way found")
    return make_plan(terrain, robot, friction, weights, begun, problem=problem)


def _try(
    path: WheelPath,
    ground: Ground,
    robot: Robot,
    stands: tuple[Stand, Stand],
    friction: float,
    weights: PathWeights,
    fine: float,
) -> Refined | None:
    reserve = friction - min(RESERVE, 0.25 * friction)
    search = Search(
        path, ground, robot, *stands, make_lattice(robot, PITCHES, fine), weights, _BOUNDS
    )
    finding = search.find(friction, reserve, _BOUNDS.com)
    if finding.s is None or finding.body is None:
        return None
    return refine(
        path, ground, robot, search.legs, stands, finding.s, finding.body, friction, reserve,
        weights,
    )  # fmt: skip


def make_plan(
    terrain: Terrain,
    robot: Robot,
    friction: float,
    weights: PathWeights,
    begun: float,
    poses: list[Pose] | None = None,
    critical: list[int] | None = None,
    total: float = 0.0,
    problem: Problem | None = None,
) -> Plan:
    """The document around poses or a problem."""
    chosen = weights.model_dump()
    return Plan.model_construct(
        schema_="stairwright/plan/1",
        id=plan_id(terrain, robot, friction, "path", chosen),
        method="path",
        terrain=terrain,
        terrain_hash=terrain.hash,
        robot=robot.name,
        robot_hash=robot.hash,
        robot_description=robot,
        friction=friction,
        weights=chosen,
        status="infeasible" if problem else "feasible",
        problem=problem,
        poses=poses or [],
        critical=critical or [],
        timing=Timing(total=total),
        solve_time=clock.perf_counter() - begun,
        certificate=None,
    )


def _no_stand(
    terrain: Terrain,
    robot: Robot,
    friction: float,
    weights: PathWeights,
    path: WheelPath,
    error: NoStand,
    begun: float,
) -> Plan:
    place = path.contacts([min(max(error.s, 0.0), path.length)])[0]
    problem = Problem(
        kind="start" if error.kind == "start" else "goal",
        at=(float(place[0]), float(place[1])),
        progress=0.0,
        message=str(error),
        limit=Limit(needed=error.needed, available=error.available, quantity="length", unit="m"),
    )
    return make_plan(terrain, robot, friction, weights, begun, problem=problem)
