"""Collision shapes as point clouds: whatever lies in their hull covers the shape."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from stairwright.arrays import Floats

from .frame import Frame
from .source import Source

_GEOM = mujoco.mjtGeom
_ROUND = 48  # corners of the polygon round a circle
_RINGS = 8


@dataclass(frozen=True)
class Solid:
    """A convex shape.

    Attributes:
        cloud: (n, 3) points in our frame whose hull holds it [m].
        kind: MuJoCo's type of shape.
        centre: (3,) in our frame [m].
        axis: (3,) of a cylinder or capsule, in our frame.
        radius: Of what is round [m].
        label: Body that it belongs to.
    """

    cloud: Floats
    kind: int
    centre: Floats
    axis: Floats
    radius: float
    label: str


def solids(
    source: Source, frame: Frame, bodies: Sequence[int], *, shown: bool = False
) -> list[Solid]:
    """What may touch something on `bodies`; with `shown` also what is only seen."""
    model = source.model
    found = []
    for body in bodies:
        first = int(model.body_geomadr[body])
        for geom in range(first, first + int(model.body_geomnum[body])):
            touches = model.geom_contype[geom] or model.geom_conaffinity[geom]
            if (touches or shown) and int(model.geom_type[geom]) != int(_GEOM.mjGEOM_PLANE):
                found.append(_solid(source, frame, geom, source.body(body)))
    return found


def _solid(source: Source, frame: Frame, geom: int, label: str) -> Solid:
    model, data = source.model, source.data
    axes = frame.axes @ data.geom_xmat[geom].reshape(3, 3)
    centre = frame.place(data.geom_xpos[geom])
    kind, size = _GEOM(int(model.geom_type[geom])), model.geom_size[geom]
    own, radius = _cloud(model, geom, kind, size)
    return Solid(centre + own @ axes.T, int(kind), centre, axes[:, 2], radius, label)


def _cloud(model: Any, geom: int, kind: Any, size: Floats) -> tuple[Floats, float]:
    """Points in the shape's own frame, and its radius."""
    a, b, c = size.tolist()
    if kind == _GEOM.mjGEOM_BOX:
        signs = np.array([(i, j, k) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        return signs * size, 0.0
    if kind == _GEOM.mjGEOM_CYLINDER:
        ring = _ring(a)
        return np.array([(x, y, z) for z in (-b, b) for x, y in ring]), a
    if kind == _GEOM.mjGEOM_CAPSULE:
        ball = _ball() * a
        end = np.array([0.0, 0.0, b])
        return np.concatenate([ball + end, ball - end]), a
    if kind == _GEOM.mjGEOM_SPHERE:
        return _ball() * a, a
    if kind == _GEOM.mjGEOM_ELLIPSOID:
        return _ball() * size, max(a, b, c)
    mesh = int(model.geom_dataid[geom])
    first = int(model.mesh_vertadr[mesh])
    count = int(model.mesh_vertnum[mesh])
    points: Floats = np.array(model.mesh_vert[first : first + count], np.float64)
    return points, 0.0


def _ring(radius: float) -> Floats:
    """(n, 2) corners of a polygon round a circle."""
    angle = (np.arange(_ROUND) + 0.5) * 2 * math.pi / _ROUND
    ring: Floats = (
        radius / math.cos(math.pi / _ROUND) * np.column_stack([np.cos(angle), np.sin(angle)])
    )
    return ring


def _ball() -> Floats:
    """Corners of a polyhedron round the unit ball: rings of latitude, and the poles.

    Its faces touch a ball of radius cos(half a step of longitude) cos(half a step of latitude).
    """
    step = math.pi / (2 * _RINGS)
    latitudes = (np.arange(-_RINGS, _RINGS + 1)) * step
    longitudes = np.arange(_ROUND) * 2 * math.pi / _ROUND
    lat, lon = np.meshgrid(latitudes, longitudes)
    points = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    grown: Floats = points.reshape(-1, 3) / (math.cos(step / 2) * math.cos(math.pi / _ROUND))
    return grown
