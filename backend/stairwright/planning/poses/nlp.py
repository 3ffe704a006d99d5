"""The paper's pose optimisation (eqs 17-22) as one parametric problem in CasADi.

The variables are those of eq 18, X = [x_c, z_c, pitch, q], and the wheels' arc lengths on the
wheel-centre curve, which turn "the rim is on the terrain" (eq 19) into an exact equation. Terrain,
robot and weights are parameters: a problem is built once per process.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import casadi as ca

from stairwright.planning.poses.extra_terms import NONE, ExtraTerms, SymbolicPose
from stairwright.planning.poses.separation import (
    CellBlock,
    box_gap,
    link_gap,
    point_gap,
    segment_gap,
)
from stairwright.planning.poses.terrain_window import CORNERS, EDGES, PIECES
from stairwright.robot.symbolic import DIMENSIONS, Point, Shape, Skeleton, between, forward

VARIABLES = ("x_c", "z_c", "pitch", "q1", "q2", "q3", "q4", "s_front", "s_rear")
WHEEL, HIP, GROUND, SELF, EXTRA = "wheel", "hip", "ground", "self", "extra"


@dataclass(frozen=True)
class Layout:
    """Where the collision points sit; see `stairwright.robot.description.CollisionPoints`."""

    trunk: tuple[tuple[float, float], ...]
    thigh: tuple[float, ...]
    calf: tuple[float, ...]


@dataclass(frozen=True)
class Problem:
    """The symbolic problem: `nlp` for `casadi.nlpsol`, and what each constraint row is.

    Attributes:
        nlp: Dictionary of x, p, f, g.
        rows: (m,) kind of each constraint: `WHEEL` (equal to 0), `HIP` (at least 0), `GROUND`
            and `SELF` (distances in m, at least their bound), `EXTRA` (the user's, at least 0).
    """

    nlp: dict[str, Any]
    rows: tuple[str, ...]


@lru_cache(maxsize=16)
def build(layout: Layout, links: bool, cells: int, extra: ExtraTerms = NONE) -> Problem:
    """The problem with the collision points of `layout`, or with exact links.

    Args:
        layout: Collision points of eq 21.
        links: Keep whole links (capsules) and the trunk (a box) clear of the terrain, instead of
            the points alone; the points lie on them.
        cells: Number of convex cells of ground.
        extra: Cost terms and constraints of the user.
    """
    X = ca.SX.sym("X", len(VARIABLES))
    reference = ca.SX.sym("reference", 7)  # x, z, pitch, q
    weights = ca.SX.sym("weights", 7)
    size = ca.SX.sym("size", len(DIMENSIONS))
    curves = [ca.SX.sym(f"curve_{k}", 4, PIECES + 1) for k in range(2)]
    normals = ca.SX.sym("normals", 2, cells * EDGES)
    offsets = ca.SX.sym("offsets", cells * EDGES)
    corners = ca.SX.sym("corners", 2, cells * CORNERS)
    shape = Shape.from_vector(size)
    pose = forward(shape, X[0], X[1], X[2], ca.vertsplit(X[3:7]))

    rows: list[tuple[str, Any]] = []
    places = [_on_curve(curves[k], X[7 + k], shape.wheel_radius) for k in range(2)]
    for k, (centre, _) in enumerate(places):
        rows.append((WHEEL, pose.wheels[k][0] - centre[0]))
        rows.append((WHEEL, pose.wheels[k][1] - centre[1]))
    rows.append((HIP, pose.hips[1][0] - places[1][1]))  # eq 20
    blocks = [
        CellBlock(
            [(normals[0, j], normals[1, j], offsets[j]) for j in range(i * EDGES, (i + 1) * EDGES)],
            [(corners[0, j], corners[1, j]) for j in range(i * CORNERS, (i + 1) * CORNERS)],
        )
        for i in range(cells)
    ]
    for block in blocks:  # eq 21
        gaps = _link_gaps(pose, shape, block) if links else _point_gaps(pose, shape, layout, block)
        rows.extend((GROUND, gap) for gap in gaps)
    rows.extend((SELF, gap) for gap in _self_gaps(pose, shape))

    error = X[:7] - reference
    cost = ca.dot(weights * error, error)  # eq 17, with the posture terms that make it unique
    if extra:
        symbolic = SymbolicPose.of(X, reference, pose)
        cost += extra.cost_of(symbolic)
        rows.extend((EXTRA, value) for value in extra.constraints_of(symbolic))
    p = ca.vertcat(
        reference,
        weights,
        size,
        *(ca.vec(curve) for curve in curves),
        ca.vec(normals),
        offsets,
        ca.vec(corners),
    )
    nlp = {"x": X, "p": p, "f": cost, "g": ca.vertcat(*(row for _, row in rows))}
    return Problem(nlp, tuple(kind for kind, _ in rows))


def _on_curve(curve: Any, s: Any, radius: Any) -> tuple[Point, Any]:
    """Wheel centre at arc length `s`, and the contact's x."""
    x, z = curve[0, PIECES], curve[1, PIECES]
    heading = curve[2, 0]
    for k in range(PIECES):
        start, length, angle, curvature = (curve[i, k] for i in range(4))
        # The first piece goes on backward, the last one forward: bounds on s keep inside.
        u = s - start if k == 0 else ca.fmax(s - start, 0)
        u = ca.fmin(u, length) if k + 1 < PIECES else u
        turned = angle - curvature * u
        arc = ca.if_else(curvature > 0, 1, 0)
        x += (1 - arc) * u * ca.cos(angle) + arc * radius * (ca.sin(angle) - ca.sin(turned))
        z += (1 - arc) * u * ca.sin(angle) + arc * radius * (ca.cos(turned) - ca.cos(angle))
        heading = ca.if_else(s >= start, turned, heading)
    return (x, z), x + radius * ca.sin(heading)


def _point_gaps(pose: Skeleton, shape: Shape, layout: Layout, block: CellBlock) -> list[Any]:
    from stairwright.robot.symbolic import to_world

    points = [
        to_world(pose.trunk, pose.pitch, (2 * shape.half_length * u, 2 * shape.half_height * v))
        for u, v in layout.trunk
    ]
    for leg in range(2):
        points += [between(pose.hips[leg], pose.knees[leg], t) for t in layout.thigh]
        points += [between(pose.knees[leg], pose.wheels[leg], t) for t in layout.calf]
    return [point_gap(point, block) for point in points]


def _link_gaps(pose: Skeleton, shape: Shape, block: CellBlock) -> list[Any]:
    gaps = [box_gap(pose, shape, block)]
    for leg in range(2):
        hip, knee, wheel = pose.hips[leg], pose.knees[leg], pose.wheels[leg]
        gaps.append(link_gap(hip, knee, shape.thigh[leg], block) - shape.thigh_radius[leg])
        gaps.append(link_gap(knee, wheel, shape.calf[leg], block) - shape.calf_radius[leg])
    return gaps


def _self_gaps(pose: Skeleton, shape: Shape) -> list[Any]:
    """Distances between the front and the rear leg: wheels and links, which share a plane."""
    (fw, rw), wheel = pose.wheels, shape.wheel_radius
    gaps = [ca.sqrt((fw[0] - rw[0]) ** 2 + (fw[1] - rw[1]) ** 2 + 1e-12) - 2 * wheel]
    for own, other in ((0, 1), (1, 0)):
        hip, knee, foot = pose.hips[other], pose.knees[other], pose.wheels[other]
        upper, lower = shape.thigh[other], shape.calf[other]
        thigh, calf = shape.thigh_radius[other], shape.calf_radius[other]
        gaps.append(segment_gap(pose.wheels[own], hip, knee, upper) - wheel - thigh)
        gaps.append(segment_gap(pose.wheels[own], knee, foot, lower) - wheel - calf)
        joint = shape.thigh_radius[own]
        gaps.append(segment_gap(pose.knees[own], hip, knee, upper) - joint - thigh)
        gaps.append(segment_gap(pose.knees[own], knee, foot, lower) - joint - calf)
    return gaps
