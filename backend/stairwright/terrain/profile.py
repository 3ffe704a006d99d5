"""The terrain: an x-monotone polyline in the x-z plane, extruded along y."""

from __future__ import annotations

import itertools
import math
from functools import cached_property
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from stairwright.arguments import MOST_FRICTION
from stairwright.arrays import Floats
from stairwright.documents import Model, content_hash
from stairwright.errors import InputError

MOST_COORDINATE = 100.0  # m
Coordinate = Annotated[float, Field(ge=-MOST_COORDINATE, le=MOST_COORDINATE)]
Point = tuple[Coordinate, Coordinate]

MERGE_DISTANCE = 1e-9  # m; nearer points are one point


class Terrain(Model):
    """A profile and its friction (``stairwright/terrain/1``). Metres, world frame.

    `x` never decreases along `points`; equal `x` is a vertical face. `start` and `goal` are the
    trunk's x at both ends; without them the robot starts on the first flat stretch and ends on
    the last one.
    """

    schema_: Literal["stairwright/terrain/1"] = Field("stairwright/terrain/1", alias="schema")
    name: str = Field("unnamed", min_length=1, max_length=100, pattern=r"^[\w .+-]+$")
    description: str = Field("", max_length=2000)
    points: list[Point] = Field(min_length=2, max_length=2000)
    friction: float = Field(
        0.6, gt=0.0, le=MOST_FRICTION, description="Coulomb friction, wheel on terrain"
    )
    start: Coordinate | None = Field(None, description="x of the trunk at the start [m]")
    goal: Coordinate | None = Field(None, description="x of the trunk at the goal [m]")

    @model_validator(mode="after")
    def _check_shape(self) -> Terrain:
        x = [point[0] for point in self.points]
        for i in range(1, len(x)):
            if x[i] < x[i - 1]:
                raise InputError(
                    f"x must never decrease, but point {i} (x = {x[i]:g}) lies behind point "
                    f"{i - 1} (x = {x[i - 1]:g}): overhangs are not supported",
                    ("points", i),
                )
        if x[-1] - x[0] < 1e-3:
            raise InputError("the profile must extend along x by at least 1 mm", ("points",))
        for name, value in (("start", self.start), ("goal", self.goal)):
            if value is not None and not x[0] <= value <= x[-1]:
                raise InputError(
                    f"must lie on the profile, between {x[0]:g} and {x[-1]:g} m", (name,)
                )
        if self.start is not None and self.goal is not None and self.goal <= self.start:
            raise InputError(f"must lie ahead of the start at {self.start:g} m", ("goal",))
        return self

    @cached_property
    def vertices(self) -> Floats:
        """(n, 2) corners: repeated points merged, zero-width slits closed, straight runs joined."""
        return simplify(np.array(self.points, dtype=float))

    @cached_property
    def hash(self) -> str:
        """Hash of what planning depends on (not of name and description)."""
        shape = self.model_dump(mode="json", include={"points", "friction", "start", "goal"})
        return content_hash(shape)

    def height(self, x: float) -> float:
        """Height of the ground at `x` [m]; the upper end where a face is vertical."""
        return float(height_at(self.vertices, np.array([x]))[0])


def simplify(points: Floats) -> Floats:
    """Corners of a polyline (n, 2) without repeated points, zero-width slits and collinear points.

    Of several points with one x only those matter that an observer above can see: the first, the
    highest and the last. A zero-width spike stays: it obstructs.
    """
    p: list[list[float]] = points.tolist()  # plain numbers: numpy is slow on one at a time
    out: list[tuple[float, float]] = []
    i = 0
    while i < len(p):
        j = i
        while j + 1 < len(p) and p[j + 1][0] - p[i][0] <= MERGE_DISTANCE:
            j += 1
        first, last = p[i], p[j]
        top = max(z for _, z in p[i : j + 1])
        for x, z in (first, (first[0], top), last):
            if not out or math.dist((x, z), out[-1]) > MERGE_DISTANCE:
                out.append((first[0], z))
        i = j + 1
    return np.array(_join_collinear(out))


def _join_collinear(p: list[tuple[float, float]]) -> list[tuple[float, float]]:
    keep = p[:1]
    for (bx, bz), (cx, cz) in itertools.pairwise(p[1:]):
        ax, az = bx - keep[-1][0], bz - keep[-1][1]
        ox, oz = cx - bx, cz - bz
        if abs(ax * oz - az * ox) > 1e-12 * max(1.0, math.hypot(ax, az)) or ax * ox + az * oz < 0:
            keep.append((bx, bz))
    return [*keep, p[-1]]


def height_at(vertices: Floats, x: Floats) -> Floats:
    """Upper ground height (n,) at `x` (n,); constant beyond the ends."""
    left = np.interp(x, vertices[:, 0], vertices[:, 1])
    # np.interp takes one side of a vertical face; take the highest vertex at exactly that x.
    lo = np.searchsorted(vertices[:, 0], x - MERGE_DISTANCE, side="left")
    hi = np.searchsorted(vertices[:, 0], x + MERGE_DISTANCE, side="right")
    for i in np.flatnonzero(hi > lo):
        left[i] = vertices[lo[i] : hi[i], 1].max()
    return left
