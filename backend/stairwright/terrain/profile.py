"""The terrain: an x-monotone polyline in the x-z plane, extruded along y."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from stairwright.arguments import MOST_FRICTION
from stairwright.documents import Model, content_hash
from stairwright.errors import InputError

Floats = NDArray[np.float64]
Coordinate = Annotated[float, Field(ge=-100.0, le=100.0)]
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
    out: list[Floats] = []
    i = 0
    while i < len(points):
        j = i
        while j + 1 < len(points) and points[j + 1, 0] - points[i, 0] <= MERGE_DISTANCE:
            j += 1
        column = points[i : j + 1]
        top = column[np.argmax(column[:, 1])]
        for point in (column[0], np.array([column[0, 0], top[1]]), column[-1]):
            if not out or np.hypot(*(point - out[-1])) > MERGE_DISTANCE:
                out.append(np.array([column[0, 0], point[1]]))
        i = j + 1
    return _join_collinear(np.array(out))


def _join_collinear(p: Floats) -> Floats:
    keep = [0]
    for i in range(1, len(p) - 1):
        a, b = p[i] - p[keep[-1]], p[i + 1] - p[i]
        cross = a[0] * b[1] - a[1] * b[0]
        if abs(cross) > 1e-12 * max(1.0, float(np.hypot(*a))) or a @ b < 0:
            keep.append(i)
    return p[[*keep, len(p) - 1]]


def height_at(vertices: Floats, x: Floats) -> Floats:
    """Upper ground height (n,) at `x` (n,); constant beyond the ends."""
    left = np.interp(x, vertices[:, 0], vertices[:, 1])
    # np.interp takes one side of a vertical face; take the highest vertex at exactly that x.
    lo = np.searchsorted(vertices[:, 0], x - MERGE_DISTANCE, side="left")
    hi = np.searchsorted(vertices[:, 0], x + MERGE_DISTANCE, side="right")
    for i in np.flatnonzero(hi > lo):
        left[i] = vertices[lo[i] : hi[i], 1].max()
    return left
