"""Generators of common terrain."""

from __future__ import annotations

import math
from typing import Literal, get_args

from stairwright.arguments import as_friction
from stairwright.errors import InputError

from .profile import Terrain

Direction = Literal["up", "down", "up-down"]

MAX_STEPS = 200


def flat(length: float = 4.0, name: str = "flat", friction: float = 0.6) -> Terrain:
    """Level ground of `length` [m], centred on x = 0."""
    _positive(length=length)
    return _terrain(
        name, f"Level ground, {length:g} m.", [(-length / 2, 0.0), (length / 2, 0.0)], friction
    )


def ramp(
    rise: float,
    slope: float,
    *,
    direction: Direction = "up",
    approach: float = 1.5,
    platform: float = 2.0,
    name: str | None = None,
    friction: float = 0.6,
) -> Terrain:
    """One inclined plane from x = 0, with level ground before and after.

    Args:
        rise: Height gained or lost [m].
        slope: Angle from the horizontal [rad], above 0 and below pi/2.
        direction: ``up-down`` goes up, over a platform, and down again.
        approach: Level ground before it [m].
        platform: Level ground on top and, going down again, after it [m].
        name: Name of the terrain; made from the measures by default.
        friction: Coulomb friction, wheel on terrain.

    Raises:
        InputError: If a measure is out of range.
    """
    if not 0.0 < slope < math.pi / 2:
        raise InputError("must lie between 0 and pi/2 rad", ("slope",))
    return stair(
        rise,
        count=1,
        direction=direction,
        face_angle=slope,
        approach=approach,
        platform=platform,
        name=name or f"ramp-{math.degrees(slope):.0f}deg-{rise:g}-{direction}",
        friction=friction,
    )


def stair(
    rise: float,
    run: float = 0.30,
    count: int = 1,
    *,
    direction: Direction = "up",
    face_angle: float = math.pi / 2,
    approach: float = 1.5,
    platform: float = 2.0,
    name: str | None = None,
    friction: float = 0.6,
) -> Terrain:
    """A flight of `count` equal steps whose first face starts at x = 0.

    Args:
        rise: Height of a step [m].
        run: Horizontal distance between the edges of two steps [m].
        count: Number of steps; of each flight for ``up-down``.
        direction: ``up``, ``down``, or ``up-down`` over a platform.
        face_angle: Of the faces from the horizontal [rad]; pi/2 is vertical.
        approach: Level ground before the flight [m].
        platform: Level ground on top and, going down again, after it [m].
        name: Name of the terrain; made from the measures by default.
        friction: Coulomb friction, wheel on terrain.

    Raises:
        InputError: If a measure is out of range, or the faces are longer than the run.
    """
    _positive(rise=rise, approach=approach, platform=platform)
    if direction not in get_args(Direction):
        raise InputError(f"must be one of: {', '.join(get_args(Direction))}", ("direction",))
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= MAX_STEPS:
        raise InputError(f"must be a whole number from 1 to {MAX_STEPS}", ("count",))
    if not 0.0 < face_angle <= math.pi / 2:
        raise InputError("must be above 0 and at most pi/2 rad", ("face_angle",))
    depth = 0.0 if face_angle > math.pi / 2 - 1e-9 else rise / math.tan(face_angle)
    if count > 1:
        _positive(run=run)
        if depth > run:
            raise InputError(f"must be at least the depth of a face, {depth:.4g} m", ("run",))

    points: list[tuple[float, float]] = [(-approach, 0.0)]
    x = z = 0.0
    flights = {"up": (1,), "down": (-1,), "up-down": (1, -1)}[direction]
    for sign in flights:
        for _ in range(count):
            points.append((x, z))
            z += sign * rise
            points.append((x + depth, z))
            x += run
        x += depth + platform - run
    points.append((x, z))
    rounded = [(round(px, 9) + 0.0, round(pz, 9) + 0.0) for px, pz in points]
    steps = "One step" if count == 1 else f"{count} steps"
    tread = "" if count == 1 else f", run {run:g} m"
    angle = "" if depth == 0.0 else f", faces at {math.degrees(face_angle):.3g} degrees"
    return _terrain(
        name or f"stair-{rise:g}-{run:g}-x{count}-{direction}",
        f"{steps} {direction}, rise {rise:g} m{tread}{angle}.",
        rounded,
        friction,
        measure="rise" if count == 1 else "count",
    )


def _terrain(
    name: str,
    description: str,
    points: list[tuple[float, float]],
    friction: float,
    measure: str = "length",
) -> Terrain:
    """The terrain; `measure` is what makes it too large, if it is."""
    friction = as_friction(friction)
    if any(abs(value) > 100.0 for point in points for value in point):
        raise InputError("the terrain would reach further than 100 m", (measure,))
    return Terrain(name=name, description=description, points=points, friction=friction)


def _positive(**values: float) -> None:
    for name, value in values.items():
        if not 0.0 < value <= 100.0:
            raise InputError("must be above 0 and at most 100 m", (name,))
