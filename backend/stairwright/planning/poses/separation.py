"""Distances for the optimisation: points, links and the trunk from convex cells of ground.

Convex shapes are apart by at least d if some axis separates their projections by d. The axes tried
are the faces of both shapes, the best one counts (a hard maximum), so a gap is exact against faces
and never too large against corners.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import Any

import casadi as ca

from stairwright.robot.symbolic import Point, Scalar, Shape, Skeleton, to_world


@dataclass(frozen=True)
class CellBlock:
    """A convex cell: faces (normal x, normal z, offset) and corners, as CasADi scalars."""

    faces: list[tuple[Scalar, Scalar, Scalar]]
    corners: list[Point]


def _max(values: list[Any]) -> Any:
    return reduce(ca.fmax, values)


def _min(values: list[Any]) -> Any:
    return reduce(ca.fmin, values)


def point_gap(point: Point, cell: CellBlock) -> Any:
    """Signed distance of a point from the nearest face it is in front of."""
    return _max([nx * point[0] + nz * point[1] - d for nx, nz, d in cell.faces])


def link_gap(a: Point, b: Point, length: Scalar, cell: CellBlock) -> Any:
    """Separation of the segment a-b, which has this `length`, from a cell."""
    gaps = [ca.fmin(nx * a[0] + nz * a[1], nx * b[0] + nz * b[1]) - d for nx, nz, d in cell.faces]
    nx, nz = (a[1] - b[1]) / length, (b[0] - a[0]) / length
    heights = [nx * (c[0] - a[0]) + nz * (c[1] - a[1]) for c in cell.corners]
    return _max([*gaps, _min(heights), _min([-h for h in heights])])


def box_gap(pose: Skeleton, shape: Shape, cell: CellBlock) -> Any:
    """Separation of the trunk from a cell."""
    half_length, half_height = shape.half_length, shape.half_height
    box = [
        to_world(pose.trunk, pose.pitch, (u * half_length, v * half_height))
        for u, v in ((1, 1), (-1, 1), (-1, -1), (1, -1))
    ]
    gaps = [_min([nx * p[0] + nz * p[1] for p in box]) - d for nx, nz, d in cell.faces]
    c, s = ca.cos(pose.pitch), ca.sin(pose.pitch)
    x, z = pose.trunk
    for nx, nz, half in ((c, -s, half_length), (s, c, half_height)):
        heights = [nx * (p[0] - x) + nz * (p[1] - z) for p in cell.corners]
        gaps += [_min(heights) - half, _min([-h for h in heights]) - half]
    return _max(gaps)


def segment_gap(point: Point, a: Point, b: Point, length: Scalar) -> Any:
    """Distance of a point from the segment a-b, which has this `length`."""
    ux, uz = (b[0] - a[0]) / length, (b[1] - a[1]) / length
    t = (point[0] - a[0]) * ux + (point[1] - a[1]) * uz
    t = ca.fmin(ca.fmax(t, 0), length)
    dx, dz = point[0] - a[0] - t * ux, point[1] - a[1] - t * uz
    return ca.sqrt(dx * dx + dz * dz + 1e-12)
