"""Front leg against rear leg for many poses of the trunk, written so that it vectorises.

Float32 in metres from the front wheel: good for 1e-6 m.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import vector_leaf
from stairwright.robot.description import Planar

from .legs import Leg

Floats32 = NDArray[np.float32]
Flags = NDArray[np.bool_]


@nb.njit(cache=True, fastmath=True, inline="always")
def _near(px, pz, ax, az, dx, dz, inverse):  # type: ignore[no-untyped-def]
    """Squared distance of a point from the segment a + t d, 1 / |d|^2 given."""
    t = ((px - ax) * dx + (pz - az) * dz) * inverse
    t = min(np.float32(1.0), max(np.float32(0.0), t))
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
    return np.float32(0.0) if max(s1 * s2, s3 * s4) < np.float32(0.0) else near


@vector_leaf
def legs_clear(
    p: Planar,
    front: Leg,
    rear: Leg,
    gap: float,
    apart: tuple[float, float],
    x: Floats32,
    z: Floats32,
    cos: Floats32,
    sin: Floats32,
    clear: Flags,
) -> None:
    """Set `clear` (n,): whether the legs keep their gap.

    Args:
        p: The robot.
        front: Front leg.
        rear: Rear leg.
        gap: That the legs keep [m].
        apart: x and z of the rear wheel from the front wheel [m].
        x: (n,) of the trunk from the front wheel [m].
        z: (n,) of the trunk from the front wheel [m].
        cos: (n,) of the trunk's pitch.
        sin: (n,) of the trunk's pitch.
        clear: (n,) result.
    """
    single, zero, half = np.float32, np.float32(0.0), np.float32(0.5)
    fx, fz, rx, rz = (
        single(front.hip_x), single(front.hip_z), single(rear.hip_x), single(rear.hip_z),
    )  # fmt: skip
    wx, wz = single(apart[0]), single(apart[1])
    thigh, calf = single(p.thigh * p.thigh), single(p.calf * p.calf)
    it, ic = single(1.0) / thigh, single(1.0) / calf
    rt, rc, rw = p.thigh_radius, p.calf_radius, p.wheel_radius
    tt, tc, cc = (
        single((2 * rt + gap) ** 2), single((rt + rc + gap) ** 2), single((2 * rc + gap) ** 2),
    )  # fmt: skip
    tw, cw = single((rt + rw + gap) ** 2), single((rc + rw + gap) ** 2)
    split = thigh - calf
    knee, other = single(front.knee), single(rear.knee)
    for k in range(len(clear)):
        hx, hz = x[k] + cos[k] * fx + sin[k] * fz, z[k] - sin[k] * fx + cos[k] * fz
        gx, gz = x[k] + cos[k] * rx + sin[k] * rz, z[k] - sin[k] * rx + cos[k] * rz
        # Knees, as in `legs.knee_point`; the front wheel is the origin.
        square = hx * hx + hz * hz
        m = half * (split + square) / square
        n = knee * math.sqrt(max(zero, thigh / square - m * m))
        kx, kz = hx - m * hx + n * hz, hz - m * hz - n * hx
        ex, ez = wx - gx, wz - gz
        square = ex * ex + ez * ez
        m = half * (split + square) / square
        n = other * math.sqrt(max(zero, thigh / square - m * m))
        jx, jz = gx + m * ex - n * ez, gz + m * ez + n * ex
        room = _links(hx, hz, kx, kz, gx, gz, jx, jz, it, it) - tt
        room = min(room, _links(hx, hz, kx, kz, jx, jz, wx, wz, it, ic) - tc)
        room = min(room, _links(kx, kz, zero, zero, gx, gz, jx, jz, ic, it) - tc)
        room = min(room, _links(kx, kz, zero, zero, jx, jz, wx, wz, ic, ic) - cc)
        room = min(room, _near(wx, wz, hx, hz, kx - hx, kz - hz, it) - tw)
        room = min(room, _near(wx, wz, kx, kz, -kx, -kz, ic) - cw)
        room = min(room, _near(zero, zero, gx, gz, jx - gx, jz - gz, it) - tw)
        room = min(room, _near(zero, zero, jx, jz, wx - jx, wz - jz, ic) - cw)
        clear[k] = room >= zero
