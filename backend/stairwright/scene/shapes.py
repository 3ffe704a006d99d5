"""Triangle meshes of the robot's parts and of the extruded terrain (vertices, faces).

Vertices are not shared between faces that meet at a hard edge, so that smooth shading keeps the
edge crisp. Axes: x forward, y left, z up; wheels and motors turn about y, links hang along -z.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stairwright.arrays import Floats
from stairwright.robot.description import Robot
from stairwright.robot.legs import LinkForm
from stairwright.robot.parts import Outline

HALF_WIDTH = 0.5  # m, of the extruded terrain
_STEEP = 1.0  # rad; faces that are steeper count as risers


class Mesh(NamedTuple):
    """Vertices (n, 3) in m and triangles (m, 3)."""

    vertices: Floats
    faces: NDArray[np.uint32]


def merge(*meshes: Mesh) -> Mesh:
    """One mesh of several."""
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate(
            [mesh.faces + np.uint32(o) for mesh, o in zip(meshes, offsets, strict=False)]
        ),
    )


def moved(mesh: Mesh, offset: tuple[float, float, float]) -> Mesh:
    """The mesh shifted by `offset` [m]."""
    return Mesh(mesh.vertices + np.array(offset), mesh.faces)


def polygons(corners: Floats) -> Mesh:
    """Flat convex polygons (k, n, 3), counter-clockwise seen from outside, as triangle fans."""
    k, n, _ = corners.shape
    fan = np.array([[0, i, i + 1] for i in range(1, n - 1)], dtype=np.uint32)
    faces = (fan[None] + (np.arange(k, dtype=np.uint32) * n)[:, None, None]).reshape(-1, 3)
    return Mesh(corners.reshape(-1, 3), faces.astype(np.uint32))


def prism(lower: Floats, upper: Floats, lower_z: float, upper_z: float) -> Mesh:
    """A convex prism or frustum between two polygons (n, 2) in x-y, anticlockwise from above."""
    bottom = np.column_stack([lower, np.full(len(lower), lower_z)])
    top = np.column_stack([upper, np.full(len(upper), upper_z)])
    nxt = np.roll(np.arange(len(lower)), -1)
    sides = np.stack([bottom, bottom[nxt], top[nxt], top], axis=1)
    return merge(polygons(sides), polygons(top[None]), polygons(bottom[None, ::-1]))


def octagon(a: float, b: float, c: float) -> Floats:
    """A rectangle (8, 2) of half sides `a`, `b` with corners cut by `c`, anticlockwise."""
    half = np.array([(a - c, -b), (a, -b + c), (a, b - c), (a - c, b)])
    return np.concatenate([half, -half])


def rounded_box(size: tuple[float, float, float], chamfer: float) -> Mesh:
    """A box about the origin with chamfered edges all round [m]."""
    x, y, z = (s / 2 for s in size)
    c = min(chamfer, 0.45 * min(x, y, z) * 2)

    def outline(inset: float) -> Floats:
        a, b = x - inset, y - inset
        return octagon(a, b, c)

    return merge(
        prism(outline(c), outline(0.0), -z, -z + c),
        prism(outline(0.0), outline(0.0), -z + c, z - c),
        prism(outline(0.0), outline(c), z - c, z),
    )


def disc(radius: float, width: float, chamfer: float, segments: int = 24) -> Mesh:
    """A solid of revolution about y: a disc with chamfered rims [m]."""
    rings = [
        (radius - chamfer, -width / 2),
        (radius, -width / 2 + chamfer),
        (radius, width / 2 - chamfer),
        (radius - chamfer, width / 2),
    ]
    return revolved(rings, segments, capped=True)


def ring(outer: float, inner: float, width: float, chamfer: float) -> Mesh:
    """A tyre about y: a ring of rectangular section with chamfered shoulders [m]."""
    section = [
        (inner, -width / 2),
        (outer - chamfer, -width / 2),
        (outer, -width / 2 + chamfer),
        (outer, width / 2 - chamfer),
        (outer - chamfer, width / 2),
        (inner, width / 2),
        (inner, -width / 2),
    ]
    return revolved(section, 28, capped=False)


def revolved(section: list[tuple[float, float]], segments: int, capped: bool) -> Mesh:
    """Bands between consecutive (radius, y) pairs turned about y; caps close the first and last."""
    angle = np.linspace(0.0, 2 * math.pi, segments + 1)
    unit = np.column_stack([np.cos(angle), np.zeros_like(angle), -np.sin(angle)])
    parts = []
    for (r0, y0), (r1, y1) in itertools.pairwise(section):
        # Vertices are shared along the band (round) and not between bands (crisp shoulders).
        low, high = unit * r0 + [0, y0, 0], unit * r1 + [0, y1, 0]
        n = segments + 1
        i = np.arange(segments, dtype=np.uint32)
        faces = np.concatenate(
            [np.column_stack([i, i + n, i + 1]), np.column_stack([i + 1, i + n, i + n + 1])]
        )
        parts.append(Mesh(np.concatenate([low, high]), faces[:, ::-1].astype(np.uint32)))
    if capped:
        r0, y0 = section[0]
        r1, y1 = section[-1]
        parts.append(polygons((unit[:-1] * r0 + [0, y0, 0])[None]))
        parts.append(polygons((unit[:-1] * r1 + [0, y1, 0])[None, ::-1]))
    return merge(*parts)


def trunk(robot: Robot) -> Mesh:
    """The body, its outline exactly the planner's."""
    return merge(*(_piece(piece) for piece in robot.body.outline))


def _piece(piece: Outline) -> Mesh:
    points = np.array(piece.points)
    low, high = points.min(axis=0), points.max(axis=0)
    (x, z), (length, height) = (low + high) / 2, high - low
    if len(points) == 4 and np.all((points == low) | (points == high)):
        return moved(rounded_box((length, piece.width, height), 0.012), (x, 0.0, z))
    a, b = points, np.roll(points, -1, axis=0)
    if np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) > 0.0:
        points = points[::-1]  # anticlockwise seen along -z, once z is -y
    upright = prism(points * [1.0, -1.0], points * [1.0, -1.0], -piece.width / 2, piece.width / 2)
    x, y, z = upright.vertices.T
    return Mesh(np.stack([x, z, -y], axis=1), upright.faces)


def trunk_trim(robot: Robot) -> Mesh:
    """Dark details: hip axles across the body and a face plate that shows where forward is."""
    main = np.array(robot.body.outline[0].points)
    (_, low), (nose, high) = main.min(axis=0), main.max(axis=0)
    width, height = robot.body.outline[0].width, high - low
    across = 2 * robot.hips.half_track - robot.wheel.width
    axles = [
        moved(disc(0.30 * height, across, 0.004, 24), (x, 0.0, z))
        for x, z in (robot.hips.front, robot.hips.rear)
    ]
    plate = moved(
        rounded_box((0.004, 0.62 * width, 0.42 * height), 0.001), (nose, 0, (low + high) / 2)
    )
    return merge(*axles, plate)


def link(length: float, radius: float, wide: float) -> Mesh:
    """A bar from the origin to -z * length: broader at its upper joint, capped by both joints."""
    a, b = max(radius, 0.012) * 1.25, max(radius, 0.010)

    def outline(half: float) -> Floats:
        c = 0.35 * half
        return octagon(half, wide / 2, c)

    return prism(outline(b), outline(a), -length, 0.0)


def limb(form: LinkForm, wide: float) -> Mesh:
    """Bars along the capsules of a thigh or a calf, in its frame."""
    bars = []
    for (ax, az), (bx, bz), radius in form.capsules:
        length = math.hypot(bx - ax, bz - az)
        bar = link(length, radius, wide)
        c, s = ((az - bz) / length, (ax - bx) / length) if length else (1.0, 0.0)
        x, y, z = bar.vertices.T
        bars.append(Mesh(np.stack([ax + c * x + s * z, y, az - s * x + c * z], axis=1), bar.faces))
    return merge(*bars)


def joint(radius: float, width: float) -> Mesh:
    """A motor or knee: a short disc about y."""
    return disc(radius, width, 0.15 * radius, 28)


def tyre(robot: Robot) -> Mesh:
    """The wheel's outline: its outer radius and width are the planner's."""
    r = robot.wheel.radius
    return ring(r, 0.72 * r, robot.wheel.width, 0.10 * r)


def rim(robot: Robot) -> Mesh:
    """Hub and spokes, so that the wheel's rotation can be seen."""
    r, w = robot.wheel.radius, robot.wheel.width
    parts = [disc(0.30 * r, 1.10 * w, 0.05 * r, 24), ring(0.76 * r, 0.66 * r, 0.9 * w, 0.02 * r)]
    bar = rounded_box((0.13 * r, 0.55 * w, 0.50 * r), 0.02 * r)
    for a in np.linspace(0.0, 2 * math.pi, 5, endpoint=False):
        c, s = math.cos(a), math.sin(a)
        turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
        parts.append(Mesh((bar.vertices + np.array([0, 0, 0.47 * r])) @ turn.T, bar.faces))
    # One spoke differs, so that a turn by one spoke is not mistaken for none.
    valve = moved(rounded_box((0.20 * r, 1.02 * w, 0.16 * r), 0.02 * r), (0, 0, 0.60 * r))
    return merge(*parts, valve)


def sphere(radius: float, rings: int = 8, segments: int = 12) -> Mesh:
    """A small ball."""
    polar = np.linspace(0.0, math.pi, rings + 1)
    section = [(radius * math.sin(p), -radius * math.cos(p)) for p in polar]
    return revolved(section, segments, capped=False)


class Extrusion(NamedTuple):
    """The terrain extruded along y, by kind of face, and its visible edges (k, 2, 3)."""

    treads: Mesh
    risers: Mesh
    flanks: Mesh
    edges: Floats


def extrude(vertices: Floats, half_width: float, depth: float) -> Extrusion:
    """Solid below the profile `vertices` (n, 2), from y = -half_width to half_width [m].

    The floor lies `depth` below the lowest point.
    """
    floor = float(vertices[:, 1].min()) - depth
    a, b = vertices[:-1], vertices[1:]
    w = half_width

    def quad(*corners: tuple[Floats, Floats, float]) -> Floats:
        return np.stack([np.column_stack([x, np.full(len(x), y), z]) for x, z, y in corners], 1)

    top = quad(
        (a[:, 0], a[:, 1], w), (a[:, 0], a[:, 1], -w), (b[:, 0], b[:, 1], -w), (b[:, 0], b[:, 1], w)
    )
    step = np.abs(b - a)
    is_riser = np.arctan2(step[:, 1], step[:, 0]) > _STEEP
    level = np.full(len(a), floor)
    right = quad(
        (a[:, 0], level, -w), (b[:, 0], level, -w), (b[:, 0], b[:, 1], -w), (a[:, 0], a[:, 1], -w)
    )
    left = right[:, ::-1] * [1.0, -1.0, 1.0]
    ends = []
    for (x, z), sign in ((vertices[0], 1.0), (vertices[-1], -1.0)):
        end = np.array([(x, sign * w, floor), (x, -sign * w, floor), (x, -sign * w, z)])
        ends.append(np.concatenate([end, [(x, sign * w, z)]]))
    wide = step[:, 0] > 1e-9
    flanks = np.concatenate([right[wide], left[wide], np.array(ends)])
    return Extrusion(
        _or_point(top[~is_riser]), _or_point(top[is_riser]), polygons(flanks), _edges(vertices, w)
    )


def _or_point(quads: Floats) -> Mesh:
    """The quads, or one empty triangle: a mesh without faces is not drawn by every client."""
    return polygons(quads if len(quads) else np.zeros((1, 4, 3)))


def _edges(vertices: Floats, w: float) -> Floats:
    n = len(vertices)
    sides = [np.column_stack([vertices[:, 0], np.full(n, y), vertices[:, 1]]) for y in (-w, w)]
    along = [np.stack([side[:-1], side[1:]], axis=1) for side in sides]
    across = np.stack(sides, axis=1)
    return np.concatenate([*along, across])
