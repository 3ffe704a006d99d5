"""What stops the robot: the constraint that must give way for a pose to exist, and by how much."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from stairwright import _core
from stairwright.arrays import Flags, Floats
from stairwright.planning.plan import Pose
from stairwright.planning.poses.pose_search import (
    CLEARANCE,
    LEGS_DISTANCE,
    ContactPair,
    PoseSearch,
    Rules,
)
from stairwright.planning.problem import Limit, Problem, ProblemKind
from stairwright.planning.standing import NoStandingPose
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

_ENDLESS = 100.0  # margins beyond it, friction or m, stand for what no value mends


def no_standing_pose(terrain: Terrain, robot: Robot, error: NoStandingPose) -> Problem:
    """The problem of a course without room to stand at an end."""
    path = wheel_path(terrain, robot.wheel.radius)
    x, z = path.contacts(np.array([min(max(error.s, 0.0), path.length)]))[0].tolist()
    what = f"no place to stand at the {error.kind}, {error},"
    return Problem.told(error.kind, (x, z), 0.0, what, error.limit)


def statics_problem(search: PoseSearch, pose: Pose) -> Problem:
    """The problem of a pose whose centre of mass has no equilibrium inside the friction cones."""
    limit = statics_limit(search.friction, pose)
    hold = f"the ground cannot hold the robot with friction {search.friction:g}"
    return Problem.told("statics", pose.contacts[0], pose.progress, hold, limit)


def statics_limit(friction: float, pose: Pose) -> Limit | None:
    """The friction that would do; where none does, the CoM's place; where no place does, none."""
    needed = friction - pose.margins.friction
    if needed < _ENDLESS:
        return Limit(needed=needed, available=friction, quantity="friction", unit="1")
    if pose.margins.com > -_ENDLESS:
        return Limit(needed=0.0, available=pose.margins.com, quantity="CoM margin", unit="m")
    return None


def diagnose(search: PoseSearch, place: ContactPair) -> Problem:
    """Why no pose exists with the front wheel at a place.

    One kind of constraint at a time is relaxed, at every place of the rear wheel, until a pose
    exists; the relaxation that is smallest for its kind is the reason.
    """
    front = search.path.contacts(np.array([place.front]))[0]
    at = (float(front[0]), float(front[1]))
    rears = search.rear_places(place)
    if len(rears) == 0:
        return _no_rear_place(search, place, at)
    trials: list[tuple[str, float, Callable[[Rules, float], Rules]]] = [
        ("clearance", 0.2, _approach),
        ("joint_limit", 1.5, _widen),
        ("reach", 0.5, lambda r, d: r._replace(behind=-d)),
    ]
    found: list[tuple[float, str, float]] = []
    for kind, most, relax in trials:
        amount = _least(search, place, rears, relax, most)
        if amount is not None:
            found.append((amount / most, kind, amount))
    if not found:
        return _stop(at, "reach", "whatever limit gives way, the legs do not reach")
    _, kind, amount = min(found)
    if kind == "clearance":
        available = CLEARANCE - amount
        limit = Limit(needed=CLEARANCE, available=available, quantity="clearance", unit="m")
        return _stop(at, "clearance", "trunk or links come too close to the ground", limit)
    if kind == "joint_limit":
        limit = Limit(needed=amount, available=0.0, quantity="joint range beyond limit", unit="rad")
        return _stop(at, "joint_limit", "a joint would pass its limit", limit)
    limit = Limit(needed=amount, available=0.0, quantity="rear hip behind contact", unit="m")
    return _stop(at, "reach", "the rear wheel cannot stay behind its hip (eq 20)", limit)


def _stop(
    at: tuple[float, float], kind: ProblemKind, what: str, limit: Limit | None = None
) -> Problem:
    """The problem of a first pose that does not exist, front wheel at `at`."""
    return Problem.told(kind, at, 0.0, f"{what} with the front wheel", limit)


def _no_rear_place(search: PoseSearch, place: ContactPair, at: tuple[float, float]) -> Problem:
    """No ground within reach holds the rear wheel: too far away, or too slippery."""
    path, friction = search.path, search.friction
    behind = min(place.rear[1], place.front, place.face) - search.span[0]
    s = np.arange(place.rear[0], max(behind, place.rear[0] + 1e-6), 0.01)
    centre = path.centres(np.array([place.front]))[0]
    gap = np.hypot(*(path.centres(s) - centre).T)
    near = gap <= search.span[1]

    def holds(mu: float) -> Flags:
        wheels = np.stack([np.full(len(s), place.face), s], axis=1)
        spans = _core.com_intervals(path.native, wheels, mu)
        held: Flags = spans[:, 0] <= spans[:, 1]
        return held

    slope = _slope(search, place.face)
    if slope < math.pi / 3 and near.any() and not holds(friction)[near].any():
        low, high = friction, 5.0
        for _ in range(12):
            middle = (low + high) / 2
            low, high = (low, middle) if holds(middle)[near].any() else (middle, high)
        limit = Limit(needed=high, available=friction, quantity="friction", unit="1")
        return _stop(at, "statics", "the slope is too slippery", limit)
    least, most = search.span
    held = gap[holds(friction)]

    def apart(needed: float, available: float, what: str) -> Problem:
        quantity = "distance of the wheels"
        limit = Limit(needed=needed, available=available, quantity=quantity, unit="m")
        return _stop(at, "reach", what, limit)

    if len(held) and held.max() < least:
        return apart(least, float(held.max()), "what holds the rear wheel is too near")
    if len(held) and held.min() <= most:
        return _stop(at, "reach", "no place of the rear wheel is any good")
    nearest = float(held.min()) if len(held) else float(gap.min())
    return apart(nearest, most, "what holds the rear wheel is too far away")


def _slope(search: PoseSearch, s: float) -> float:
    normal = search.path.normals(np.array([s]))[0]
    return abs(math.atan2(normal[0], normal[1]))


def _approach(rules: Rules, amount: float) -> Rules:
    return rules._replace(clearance=CLEARANCE - amount, legs_distance=LEGS_DISTANCE - amount)


def _widen(rules: Rules, amount: float) -> Rules:
    lower, upper = rules.lower.copy(), rules.upper.copy()
    lower[3:7] -= amount
    upper[3:7] += amount
    return rules._replace(lower=lower, upper=upper)


def _least(
    search: PoseSearch,
    place: ContactPair,
    rears: Floats,
    relax: Callable[[Rules, float], Rules],
    most: float,
) -> float | None:
    """Least relaxation with which some rear wheel place has a pose; None if `most` has none."""
    start: Floats | None = None

    def works(amount: float) -> bool:
        nonlocal rears, start
        for i, rear in enumerate(rears):
            rules = relax(search.rules, amount)
            found = search.solve(place, float(rear), rules=rules, start=start)
            if found.solution.solved:
                start = found.solution.x
                rears = np.concatenate([rears[i : i + 1], np.delete(rears, i)])
                return True
        return False

    if not works(most):
        return None
    low, high = 0.0, most
    for _ in range(7):
        middle = (low + high) / 2
        low, high = (low, middle) if works(middle) else (middle, high)
    return high
