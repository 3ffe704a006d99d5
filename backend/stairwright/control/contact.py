"""Which place and which face of the terrain each wheel is on, and which forces it can take there.

A wheel's place is the arc length of the nearest point of the wheel-centre curve. At a concave
corner the curve has a kink and the wheel touches two faces, which asks for two rules:

- Projection alone keeps pushing on the face that the wheel comes from, and the robot waits there
  for ever. While the plan is already past a corner that the wheel has not passed (or the other way
  round), the *planned* face counts.
- While plan and wheel are both in the corner, it leans on the face before, on the face after, or on
  both, as the static forces of the plan do. On both, the friction cones span one wider cone round
  the bisector of the normals, whose apex is the wheel's centre. A wheel farther off that is on the
  very face that the plan leans on stays with it.
"""

from __future__ import annotations

import math

from stairwright.arrays import Floats
from stairwright.terrain.wheel_path import WheelPath

WINDOW = 0.15  # m; a wheel is looked for this far from where it was
CORNER_REACH = 0.04  # m; how far from a corner the planned face may count
# A plan this near to a corner counts on both faces: m, and at most so much of the wheel's radius,
# which would else be well up a riser that it is still meant to lean beside.
CORNER_PLANNED, CORNER_SHARE = 0.008, 0.16
CORNER_MEASURED = 1.25  # times that; a wheel this near to a corner gets there at once
BEFORE, AFTER, BOTH = 0, 1, 2  # faces of a corner that a wheel leans on
WIDEST = math.radians(80.0)  # half of the widest cone
_BESIDE = 1e-6  # m


def locate(path: WheelPath, x: float, z: float, near: float) -> float:
    """Arc length of the wheel centre (x, z), near where it was; anywhere if `near` is NaN."""
    if math.isnan(near):
        return path.native.project(x, z, 0.0, path.length)
    return path.native.project(x, z, max(0.0, near - WINDOW), near + WINDOW)


def face_normal(path: WheelPath, measured: float, planned: float) -> tuple[float, float]:
    """Unit normal (x, z) of the face that the wheel at `measured` shall push on."""
    at = measured
    if abs(planned - measured) < CORNER_REACH:
        low, high = min(planned, measured), max(planned, measured)
        for corner in path.corners:
            if low <= corner < high:
                at = corner + _BESIDE if planned > measured else corner - _BESIDE
    return path.normal(at)


def support(
    path: WheelPath, measured: float, planned: float, friction: float, lean: int, out: Floats
) -> None:
    """How the wheel at `measured` is carried, into `out` (8,); in a corner as `lean` says.

    ``[nx, nz, friction, reach, ax, az, bx, bz]``: normal and friction of the cone of its force, how
    far the force acts from the wheel's centre [m] (the radius; 0 in a corner), and the normals of
    the face before and after a corner (both the same elsewhere).
    """
    near = min(CORNER_PLANNED, CORNER_SHARE * path.radius)
    for corner in path.corners:
        if abs(planned - corner) >= near:
            continue
        if abs(measured - corner) >= CORNER_MEASURED * near:
            if lean != (BEFORE if measured < corner else AFTER):
                continue
            nx, nz = path.normal(measured)
            break
        (ax, az), (bx, bz) = path.normal(corner - _BESIDE), path.normal(corner + _BESIDE)
        if lean == BOTH:
            length = math.hypot(ax + bx, az + bz)
            half = 0.5 * math.acos(min(1.0, max(-1.0, ax * bx + az * bz)))
            wide = math.tan(min(WIDEST, half + math.atan(friction)))
            out[0], out[1], out[2], out[3] = (ax + bx) / length, (az + bz) / length, wide, 0.0
            out[4], out[5], out[6], out[7] = ax, az, bx, bz
            return
        nx, nz = (ax, az) if lean == BEFORE else (bx, bz)
        break
    else:
        nx, nz = face_normal(path, measured, planned)
    out[0], out[1], out[2], out[3] = nx, nz, friction, path.radius
    out[4], out[5], out[6], out[7] = nx, nz, nx, nz


def wheel_traction(held: Floats, fx: float, fz: float) -> float:
    """Tangential force [N] that a wheel must drive when the ground's force on it is (fx, fz).

    On one face it is the force's tangential part. In a corner, normal forces of both faces carry
    what lies between the normals; only what lies beyond one of them needs traction on that face.
    """
    ax, az, bx, bz = held[4], held[5], held[6], held[7]
    det = ax * bz - az * bx
    if abs(det) < 1e-9:
        return float(fx * az - fz * ax)
    before, after = (fx * bz - fz * bx) / det, (ax * fz - az * fx) / det
    if after < 0.0:
        return float(fx * az - fz * ax)
    if before < 0.0:
        return float(fx * bz - fz * bx)
    return 0.0
