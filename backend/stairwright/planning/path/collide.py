"""Front leg against rear leg for whole rows of lattice poses, written so that it vectorises."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Planar

from .legs import Leg

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


@nb.njit(cache=True, fastmath=True, inline="always")
def _near(px, pz, ax, az, dx, dz, inverse):  # type: ignore[no-untyped-def]
    """Squared distance of a point from the segment a + t d, 1 / |d|^2 given."""
    t = ((px - ax) * dx + (pz - az) * dz) * inverse
    t = min(1.0, max(0.0, t))
    ex, ez = px - ax - t * dx, pz - az - t * dz
    return ex * ex + ez * ez


@nb.njit(cache=True, fastmath=True, inline="always")
def _links(ax, az, bx, bz, cx, cz, dx, dz, i1, i2):  # type: ignore[no-untyped-def]
    """Squared distance of the segments a-b and c-d; 0 where they cross. 1 / length^2 given."""
    ux, uz, vx, vz = bx - ax, bz - az, dx - cx, dz - cz
    s1 = ux * (cz - az) - uz * (cx - ax)
    s2 = ux * (dz - az) - uz * (dx - ax)
    s3 = vx * (az - cz) - vz * (ax - cx)
    s4 = vx * (bz - cz) - vz * (bx - cx)
    near = min(
        min(_near(ax, az, cx, cz, vx, vz, i2), _near(bx, bz, cx, cz, vx, vz, i2)),
        min(_near(cx, cz, ax, az, ux, uz, i1), _near(dx, dz, ax, az, ux, uz, i1)),
    )
    return 0.0 if max(s1 * s2, s3 * s4) < 0.0 else near


@nb.njit(cache=True, fastmath=True, nogil=True)
def legs_clear(
    p: Planar,
    front: Leg,
    rear: Leg,
    gap: float,
    wheels: tuple[float, float, float, float],
    base: float,
    step: float,
    bz: float,
    cos: float,
    sin: float,
    a: int,
    b: int,
    clear: Flags,
) -> None:
    """Set clear[a:b]: whether the legs keep their gap at columns a..b of a row of a cell.

    Args:
        p: The robot. Arguments are numbers: tuples of arrays cost more to pass than a row to check.
        front: Front leg.
        rear: Rear leg.
        gap: That the legs keep [m].
        wheels: x and z of the front and of the rear wheel [m].
        base: x of column 0 [m].
        step: Between columns [m].
        bz: z of the row [m].
        cos: Of the row's pitch.
        sin: Of the row's pitch.
        a: First column.
        b: Column after the last.
        clear: (nx,) result.
    """
    f0x, f0z = cos * front.hip_x + sin * front.hip_z, bz - sin * front.hip_x + cos * front.hip_z
    r0x, r0z = cos * rear.hip_x + sin * rear.hip_z, bz - sin * rear.hip_x + cos * rear.hip_z
    f2x, f2z, r2x, r2z = wheels
    l1, l2 = p.thigh, p.calf
    it, ic = 1.0 / (l1 * l1), 1.0 / (l2 * l2)
    rt, rc, rw = p.thigh_radius, p.calf_radius, p.wheel_radius
    tt, tc, cc = (2 * rt + gap) ** 2, (rt + rc + gap) ** 2, (2 * rc + gap) ** 2
    tw, cw = (rt + rw + gap) ** 2, (rc + rw + gap) ** 2
    split = l1 * l1 - l2 * l2
    for k in range(b - a):
        bx = base + (a + k) * step
        hx, gx = bx + f0x, bx + r0x
        # Knees, as in `legs.knee_point`.
        dx, dz = f2x - hx, f2z - f0z
        square = dx * dx + dz * dz
        m = 0.5 * (split + square) / square
        n = front.knee * math.sqrt(max(0.0, l1 * l1 / square - m * m))
        kx, kz = hx + m * dx - n * dz, f0z + m * dz + n * dx
        ex, ez = r2x - gx, r2z - r0z
        square = ex * ex + ez * ez
        m = 0.5 * (split + square) / square
        n = rear.knee * math.sqrt(max(0.0, l1 * l1 / square - m * m))
        jx, jz = gx + m * ex - n * ez, r0z + m * ez + n * ex
        room = _links(hx, f0z, kx, kz, gx, r0z, jx, jz, it, it) - tt
        room = min(room, _links(hx, f0z, kx, kz, jx, jz, r2x, r2z, it, ic) - tc)
        room = min(room, _links(kx, kz, f2x, f2z, gx, r0z, jx, jz, ic, it) - tc)
        room = min(room, _links(kx, kz, f2x, f2z, jx, jz, r2x, r2z, ic, ic) - cc)
        room = min(room, _near(r2x, r2z, hx, f0z, kx - hx, kz - f0z, it) - tw)
        room = min(room, _near(r2x, r2z, kx, kz, f2x - kx, f2z - kz, ic) - cw)
        room = min(room, _near(f2x, f2z, gx, r0z, jx - gx, jz - r0z, it) - tw)
        room = min(room, _near(f2x, f2z, jx, jz, r2x - jx, r2z - jz, ic) - cw)
        clear[a + k] = room >= 0.0
