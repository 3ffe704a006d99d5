"""Poses dense enough that joints may be interpolated linearly between them."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.robot.description import Planar
from stairwright.terrain.wheel_path import curve_at

from .contacts import TOUCH
from .legs import Leg, calf_joint, knee_point, thigh_joint

Floats = NDArray[np.float64]

_MISS = 0.0006  # m; largest distance of an interpolated wheel from its curve
_PASSES = 10


@leaf
def _joints(p: Planar, leg: Leg, body: Floats, wx: float, wz: float) -> tuple[float, float]:
    c, s = math.cos(body[2]), math.sin(body[2])
    dx = wx - body[0] - c * leg.hip_x - s * leg.hip_z
    dz = wz - body[1] + s * leg.hip_x - c * leg.hip_z
    kx, kz = knee_point(dx, dz, p.thigh, p.calf, leg.knee)
    return thigh_joint(kx, kz, body[2], leg), calf_joint(dx, dz, p.thigh, p.calf, leg.knee)


@nb.njit(cache=True, nogil=True)
def _misses(
    pieces: Floats, p: Planar, leg: Leg, s0: float, s1: float, b0: Floats, b1: Floats
) -> float:
    """Largest distance of the wheel from its curve when trunk and joints move linearly."""
    r = p.wheel_radius
    x0, z0, _, _ = curve_at(pieces, r, s0)
    x1, z1, _, _ = curve_at(pieces, r, s1)
    t0, c0 = _joints(p, leg, b0, x0, z0)
    t1, c1 = _joints(p, leg, b1, x1, z1)
    worst = 0.0
    for k in range(1, 4):
        f = 0.25 * k
        x, z = b0[0] + f * (b1[0] - b0[0]), b0[1] + f * (b1[1] - b0[1])
        pitch = b0[2] + f * (b1[2] - b0[2])
        a = pitch + t0 + f * (t1 - t0)
        b = a + c0 + f * (c1 - c0)
        c, s = math.cos(pitch), math.sin(pitch)
        x += c * leg.hip_x + s * leg.hip_z - p.thigh * math.sin(a) - p.calf * math.sin(b)
        z += -s * leg.hip_x + c * leg.hip_z - p.thigh * math.cos(a) - p.calf * math.cos(b)
        wx, wz, nx, nz = curve_at(pieces, r, s0 + f * (s1 - s0))
        # What counts is the gap to the terrain; along the curve some slack does no harm.
        across = abs((x - wx) * nx + (z - wz) * nz)
        worst = max(worst, across, 0.25 * math.hypot(x - wx, z - wz))
    return worst


@nb.njit(cache=True, nogil=True)
def _far_apart(
    pieces: Floats, p: Planar, front: Leg, rear: Leg, s: Floats, body: Floats, miss: float
) -> NDArray[np.bool_]:
    bad = np.zeros(len(s) - 1, np.bool_)
    for k in range(len(s) - 1):
        a = _misses(pieces, p, front, s[k, 0], s[k + 1, 0], body[k], body[k + 1])
        b = _misses(pieces, p, rear, s[k, 1], s[k + 1, 1], body[k], body[k + 1])
        bad[k] = max(a, b) > miss
    return bad


def contact_changes(pieces: Floats, corners: Floats, s: Floats) -> Floats:
    """Where contacts change between nodes, as fractional node numbers (m,).

    Args:
        pieces, corners: The wheel-centre curve.
        s: (n, 2) arc lengths of front and rear wheel.
    """
    marks = np.concatenate([pieces[1:, 1], corners - TOUCH, corners, corners + TOUCH])
    found = [np.empty(0)]
    for wheel in range(2):
        a, b = s[:-1, wheel], s[1:, wheel]
        lo, hi = np.minimum(a, b), np.maximum(a, b)
        for mark in marks[(marks > lo.min()) & (marks < hi.max())]:
            k = np.flatnonzero((lo < mark) & (mark < hi))
            found.append(k + (mark - a[k]) / (b[k] - a[k]))
    return np.concatenate(found)


def densify(
    pieces: Floats,
    p: Planar,
    legs: tuple[Leg, Leg],
    s: Floats,
    body: Floats,
    changes: Floats,
) -> tuple[Floats, Floats]:
    """Insert nodes where contacts change, then halve intervals until linear motion fits.

    Args:
        pieces: The wheel-centre curve.
        p, legs: The robot.
        s: (n, 2) arc lengths of front and rear wheel.
        body: (n, 3) trunk poses.
        changes: Of `contact_changes`.

    Returns:
        The denser `s` and `body`.
    """
    t = np.arange(len(s), dtype=float)
    u = np.unique(np.concatenate([t, changes]))
    u = u[np.concatenate([[True], np.diff(u) > 1e-6])]
    for _ in range(_PASSES):
        dense_s = np.stack([np.interp(u, t, s[:, k]) for k in range(2)], axis=1)
        dense_body = np.stack([np.interp(u, t, body[:, k]) for k in range(3)], axis=1)
        bad = _far_apart(pieces, p, legs[0], legs[1], dense_s, dense_body, _MISS)
        if not bad.any():
            break
        u = np.sort(np.concatenate([u, 0.5 * (u[:-1] + u[1:])[bad]]))
    return dense_s, dense_body
