"""What stops the robot: the constraint that must give way for a pose to exist, and by how much."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from stairwright import _core
from stairwright.arrays import Flags, Floats
from stairwright.planning.plan import Limit, Pose, Problem
from stairwright.planning.poses.pose_search import (
    CLEARANCE,
    LEGS_DISTANCE,
    ContactPair,
    PoseSearch,
    Rules,
)
from stairwright.planning.standing import NoStandingPose
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

_ENDLESS = 100.0  # margins beyond it, friction or m, stand for what no value mends


def no_standing_pose(terrain: Terrain, robot: Robot, error: NoStandingPose) -> Problem:
    """The problem of a course without room to stand at an end."""
    path = wheel_path(terrain, robot.wheel.radius)
    x, z = map(float, path.contacts(np.array([min(max(error.s, 0.0), path.length)]))[0])
    message, limit = f"No place to stand at the {error.kind}: {error}", error.limit
    if limit is not None:
        message += f"; needs {limit.quantity} {limit.needed:.3f} m, has {limit.available:.3f} m"
    message += f", at x = {x:.2f} m, z = {z:.2f} m"
    return Problem(kind=error.kind, at=(x, z), progress=0.0, message=message, limit=limit)


def statics_problem(search: PoseSearch, pose: Pose) -> Problem:
    """The problem of a pose whose centre of mass has no equilibrium inside the friction cones."""
    return Problem(
        kind="statics",
        at=pose.contacts[0],
        progress=pose.progress,
        message=(
            "The ground cannot hold the robot here: the centre of mass lies "
            f"{-pose.margins.com * 1e3:.0f} mm outside what friction {search.friction:g} allows."
            if pose.margins.com > -_ENDLESS
            else f"No centre of mass is held here with friction {search.friction:g}."
        ),
        limit=statics_limit(search.friction, pose),
    )


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
        return Problem(
            kind="reach",
            at=at,
            progress=0.0,
            message=(
                "The legs do not reach: no pose puts the front wheel here and the rear wheel "
                "behind its hip, whatever single limit gives way."
            ),
        )
    _, kind, amount = min(found)
    if kind == "clearance":
        text = f"Trunk or links would have to come {amount * 1e3:.0f} mm closer to the ground"
        limit = Limit(
            needed=CLEARANCE, available=CLEARANCE - amount, quantity="clearance", unit="m"
        )
        return Problem(kind="clearance", at=at, progress=0.0, message=text + ".", limit=limit)
    if kind == "joint_limit":
        text = f"A joint would have to turn {amount:.2f} rad beyond its limit."
        limit = Limit(needed=amount, available=0.0, quantity="joint range beyond limit", unit="rad")
        return Problem(kind="joint_limit", at=at, progress=0.0, message=text, limit=limit)
    text = f"The rear wheel cannot stay behind its hip (eq 20): {amount * 1e3:.0f} mm are missing."
    limit = Limit(needed=amount, available=0.0, quantity="rear hip behind contact", unit="m")
    return Problem(kind="reach", at=at, progress=0.0, message=text, limit=limit)


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
        return Problem(
            kind="statics",
            at=at,
            progress=0.0,
            message=(
                f"The ground is too slippery: on this slope the wheels need friction {high:.2f}, "
                f"there is {friction:g}."
            ),
            limit=Limit(needed=high, available=friction, quantity="friction", unit="1"),
        )
    held = gap[holds(friction)]
    if len(held) and held.max() < search.span[0]:
        return Problem(
            kind="reach",
            at=at,
            progress=0.0,
            message=(
                f"Too narrow: with the front wheel here only ground within {held.max():.2f} m "
                f"holds the rear wheel, and the two need {search.span[0]:.2f} m between them."
            ),
            limit=Limit(
                needed=search.span[0], available=float(held.max()),
                quantity="distance of the wheels", unit="m",
            ),
        )  # fmt: skip
    if len(held) and held.min() <= search.span[1]:
        return Problem(
            kind="reach",
            at=at,
            progress=0.0,
            message="With the front wheel here no place of the rear wheel is any good.",
        )
    needed = float(held.min()) if len(held) else float(gap.min())
    return Problem(
        kind="reach",
        at=at,
        progress=0.0,
        message=(
            f"Too high: with the front wheel here the rear wheel has nowhere to stand within "
            f"{search.span[1]:.2f} m; the nearest ground that holds it is {needed:.2f} m away."
        ),
        limit=Limit(
            needed=needed, available=search.span[1], quantity="distance of the wheels", unit="m"
        ),
    )


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
