"""One door to all planning methods."""

from __future__ import annotations

import math
import os
import time as clock
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, get_args

from stairwright.arguments import as_friction
from stairwright.documents import Model
from stairwright.errors import InputError
from stairwright.library import load_robot, load_terrain
from stairwright.planning.energy import with_energy
from stairwright.planning.knees import configurations, knees_of
from stairwright.planning.leading_end import better_led, sound, told_of_other_end
from stairwright.planning.plan import (
    FacingChoice,
    Method,
    Plan,
    PlanTiming,
    plan_id,
    reach,
    usual_facing,
)
from stairwright.planning.tolerance import Tolerance, parse_tolerance
from stairwright.planning.weights import parse_weights
from stairwright.robot.description import Robot
from stairwright.robot.turning import Facing, symmetric, turned
from stairwright.terrain.profile import Terrain

if TYPE_CHECKING:
    from stairwright.planning.poses.critical_poses import PoseSearcher
    from stairwright.planning.poses.extra_terms import ExtraConstraints, ExtraCost

Source = str | os.PathLike[str] | Mapping[str, Any]
PoseSolver = Literal["native", "ipopt"]


def plan(
    terrain: Source | Terrain,
    robot: Source | Robot = "a1_wheeled",
    friction: float | None = None,
    method: Method = "path",
    weights: Mapping[str, float] | Model | None = None,
    *,
    timing: PlanTiming = "steady",
    facing: FacingChoice | None = None,
    tolerance: Mapping[str, float] | Tolerance | None = None,
    certified: bool = True,
    diagnose: bool = True,
    solver: PoseSolver | None = None,
    extra_cost: ExtraCost | None = None,
    extra_constraints: ExtraConstraints | None = None,
) -> Plan:
    """Plan the poses of `robot` over `terrain`.

    Args:
        terrain: A preset's name, a file, a mapping or a `Terrain`.
        robot: A robot's name, a file, a mapping or a `Robot`.
        friction: Coulomb friction between wheel and terrain; the terrain's own by default.
        method: ``path`` (dense certified path), ``critical`` (the paper's poses) or ``nominal``
            (standing pose kept).
        weights: Cost weights by name, see `stairwright.planning.weights`.
        timing: ``steady``, or of a ``path`` ``fast``: time-optimal under friction, torque and speed
            limits with the dynamics in them, as hard as the weight ``aggressiveness`` says.
        facing: Which end of the robot leads. ``backward`` is its rear, as of many robots down
            stairs: the plan is that of the robot turned about, see `Plan.facing`. ``either`` has
            the planner choose, see `leading_end.better_led`. By default ``either`` where `timing`
            is ``fast``, else ``forward``.
        tolerance: Of a ``path``: how far the world may be from what is drawn, by name (`height`,
            `place` [m], `friction`), see `Tolerance`. The certificate holds for all of it.
        certified: Check single poses and the motion between them; without, ``critical`` is sooner.
            A path is always certified.
        diagnose: Of a ``path``: find out what would open the way where there is none, which takes
            most of the time of such an answer, and where there is none or its CoM margin is thin,
            whether the other end of the robot in front does better; without, the problem tells only
            where it ends.
        solver: What solves the poses of ``critical``: ``native``, or ``ipopt``, which solves the
            same problem written in CasADi. By default ``native``; with terms of yours ``ipopt``.
        extra_cost: Of ``critical``: gives, for a `SymbolicPose`, a CasADi scalar to add to eq 17.
        extra_constraints: Of ``critical``: gives CasADi scalars that shall not be negative.

    Returns:
        The plan; infeasible terrain gives a plan with a `problem`, never an exception.

    Raises:
        InputError: If an argument is bad.
    """
    if method not in get_args(Method):
        raise InputError(
            f"unknown method {method!r}; there are: {', '.join(get_args(Method))}", ("method",)
        )
    ground = _within("terrain", load_terrain, terrain)
    machine = _within("robot", load_robot, robot)
    tyre = machine.wheel.friction or math.inf
    mu = min(ground.friction, tyre) if friction is None else as_friction(friction)
    chosen = parse_weights(method, weights)
    end = facing or usual_facing(timing)
    for field, word, known in (("timing", timing, PlanTiming), ("facing", end, FacingChoice)):
        if word not in get_args(known):
            raise InputError(f"must be one of: {', '.join(get_args(known))}", (field,))
    if timing == "fast" and method != "path":
        raise InputError("fast belongs to the method path", ("timing",))
    stood = parse_tolerance(tolerance, method, mu)
    search = _pose_search(method, solver, extra_cost, extra_constraints)
    asked = _Asked(ground, machine, mu, method, chosen, timing, stood, certified, search)
    return asked.plan(end, diagnose)


@dataclass(frozen=True)
class _Asked:
    """What a plan depends on, complete and checked; but for the end of the robot that leads."""

    terrain: Terrain
    robot: Robot
    friction: float
    method: Method
    weights: Any
    timing: PlanTiming
    tolerance: Tolerance | None
    certified: bool
    search: PoseSearcher | None

    def plan(self, facing: FacingChoice, diagnose: bool) -> Plan:
        """The plan; of ``either`` the better one. Only what is answered is diagnosed."""
        begun = clock.perf_counter()
        led_by = partial(self._led_by, diagnose=False)
        diagnose = diagnose and self.method == "path"
        if facing != "either":
            found = self._led_by(facing, diagnose)
            if not diagnose or sound(found) or symmetric(self.robot):
                return found
            found = told_of_other_end(found, led_by)
        elif symmetric(self.robot):
            found = self._led_by("forward", diagnose)
        else:
            found = better_led(led_by, self.timing)
            if diagnose and not found.feasible:
                found = self._led_by(found.facing, diagnose)
        took = clock.perf_counter() - begun
        return found.model_copy(update={"solve_time": took})

    def _led_by(self, facing: Facing, diagnose: bool) -> Plan:
        leading = turned(self.robot) if facing == "backward" else self.robot
        configured = list(configurations(leading))
        found = with_energy(self._found(configured, diagnose))
        if configured == [self.robot]:
            return found
        asked = (self.terrain, self.robot, self.friction, self.method, found.weights)
        name = plan_id(*asked, found.timing.rule, self.tolerance, facing)
        known: dict[str, Any] = {"id": name, "facing": facing}
        if configured != [leading]:
            known["knees"] = knees_of(found.robot_description)
        return found.model_copy(update=known)

    def _found(self, robots: Sequence[Robot], diagnose: bool) -> Plan:
        """The plan of one of `robots`, which is the robot with its knees bent every way."""
        ground, mu, weights = self.terrain, self.friction, self.weights
        if self.method == "path":
            from stairwright.planning.path import plan_path

            timing, tolerance = self.timing, self.tolerance
            return plan_path(
                ground, robots, mu, weights, timing=timing, tolerance=tolerance, diagnose=diagnose
            )
        if self.search is not None:
            from stairwright.planning.poses.critical_poses import plan_critical

            how = self.search, self.certified
            return _first_feasible(plan_critical(ground, one, mu, weights, *how) for one in robots)
        from stairwright.planning.poses.nominal import plan_nominal

        return _first_feasible(plan_nominal(ground, one, mu, weights) for one in robots)


def _first_feasible(plans: Iterable[Plan]) -> Plan:
    """The first feasible plan, else the one that comes farthest."""
    best: Plan | None = None
    for found in plans:
        if found.feasible:
            return found
        if best is None or reach(found) > reach(best):
            best = found
    assert best is not None
    return best


def _pose_search(
    method: Method,
    solver: PoseSolver | None,
    cost: ExtraCost | None,
    constraints: ExtraConstraints | None,
) -> PoseSearcher | None:
    """What solves the poses of ``critical``; None of other methods."""
    if solver not in (None, *get_args(PoseSolver)):
        there = ", ".join(get_args(PoseSolver))
        raise InputError(f"unknown solver {solver!r}; there are: {there}", ("solver",))
    terms = {"solver": solver, "extra_cost": cost, "extra_constraints": constraints}
    for field, value in terms.items():
        if value is not None and method != "critical":
            raise InputError("belongs to the method critical", (field,))
    if method != "critical":
        return None
    extra = cost is not None or constraints is not None
    if solver == "native" and extra:
        raise InputError("terms of yours are in CasADi, which ipopt solves", ("solver",))
    if solver == "ipopt" or extra:
        from stairwright.planning.poses.casadi_search import CasadiSearch
        from stairwright.planning.poses.extra_terms import ExtraTerms

        return partial(CasadiSearch, extra=ExtraTerms(cost, constraints), first="ipopt")
    from stairwright.planning.poses.pose_search import PoseSearch

    return PoseSearch


def _within(field: str, load: Any, source: Any) -> Any:
    try:
        return load(source)
    except InputError as error:
        raise error.within(field) from None
