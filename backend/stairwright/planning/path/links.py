"""How far legs are from the ground, for all wheel samples at once: loops that compilers vectorise.

Float32 in metres from the first sample: good for 1e-6 m on a window of the search.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import vector_leaf
from stairwright.robot.description import Planar

from .ground import Ground, link_clearance

Floats32 = NDArray[np.float32]
Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BURIED = np.float32(-1.0)  # squared gap of a link that starts in the ground or crosses its face


class Near(NamedTuple):
    """The ground near wheels; lengths are differences from the first wheel's centre [m].

    Attributes:
        x, z: (n,) wheel centres.
        faces: (k, 6) corner, vector, top above the lowest of its wheels, 1 / length^2.
        wheels: (k, 2) first and last + 1 of the wheels that a face is near to.
    """

    x: Floats32
    z: Floats32
    faces: Floats32
    wheels: Ints


@nb.njit(cache=True, nogil=True)
def ground_near(g: Ground, centres: Floats, reach: float) -> Near:
    """What of the ground comes within `reach` [m] in x of wheels at `centres` (n, 2), x rising."""
    x, z = centres[:, 0], centres[:, 1]
    a = int(np.searchsorted(g.x, x[0] - reach))
    b = int(np.searchsorted(g.x, x[-1] + reach, side="right"))
    a, b = max(a - 1, 0), min(b, len(g.x) - 1)
    faces = np.empty((max(b - a, 0), 6), np.float32)
    wheels = np.empty((max(b - a, 0), 2), np.int64)
    count = 0
    for k in range(a, b):
        first = int(np.searchsorted(x, g.x[k] - reach))
        last = int(np.searchsorted(x, g.x[k + 1] + reach, side="right"))
        if first >= last:
            continue
        ex, ez = g.x[k + 1] - g.x[k], g.z[k + 1] - g.z[k]
        faces[count, 0], faces[count, 1] = g.x[k] - x[0], g.z[k] - z[0]
        faces[count, 2], faces[count, 3] = ex, ez
        faces[count, 4] = max(g.z[k], g.z[k + 1]) - z[first:last].min()
        faces[count, 5] = 1.0 / max(ex * ex + ez * ez, 1e-18)
        wheels[count, 0], wheels[count, 1] = first, last
        count += 1
    return Near(
        (x - x[0]).astype(np.float32), (z - z[0]).astype(np.float32), faces[:count], wheels[:count]
    )


@nb.njit(cache=True, nogil=True)
def ground_clearance(
    g: Ground, near: Near, p: Planar, centres: Floats, hip: tuple[float, float],
    thigh: tuple[float, float], look: float, least: float, out: Floats32,
) -> None:  # fmt: skip
    """Fill `out` (n,) with the clearance of a leg that moves with the wheel [m].

    Args:
        g, near: The ground, and what of it is near.
        p: The robot.
        centres: (n, 2) wheel centres [m].
        hip: From the wheel's centre [m].
        thigh: Its vector [m].
        look: Clearances beyond this are not told apart [m].
        least: Clearances below this are not told apart [m].
        out: (n,) filled.
    """
    link, other = np.empty(4, np.float32), np.empty(len(out), np.float32)
    reach, calf_reach = look + p.thigh_radius, look + p.calf_radius
    out[:], other[:] = reach * reach, calf_reach * calf_reach
    knee = (hip[0] + thigh[0], hip[1] + thigh[1])
    link[0], link[1], link[2], link[3] = hip[0], hip[1], thigh[0], thigh[1]
    nearer(near, link, reach, out)
    link[0], link[1], link[2], link[3] = knee[0], knee[1], -knee[0], -knee[1]
    nearer(near, link, calf_reach, other)
    deepest = -min(p.thigh_radius, p.calf_radius)  # no link in the ground has more clearance
    for i in range(len(out)):
        if out[i] >= 0.0 and other[i] >= 0.0:
            out[i] = min(math.sqrt(out[i]) - p.thigh_radius, math.sqrt(other[i]) - p.calf_radius)
        elif deepest < least:
            out[i] = deepest
        else:
            x, z = centres[i, 0], centres[i, 1]
            kx, kz = x + knee[0], z + knee[1]
            upper = link_clearance(g, x + hip[0], z + hip[1], kx, kz, p.thigh_radius, look)
            out[i] = min(upper, link_clearance(g, kx, kz, x, z, p.calf_radius, look))


@vector_leaf
def nearer(near: Near, link: Floats32, reach: float, best: Floats32) -> None:
    """Lower `best` to the squared gap between the ground and a link that moves with the wheel.

    Args:
        near: The ground.
        link: (4,) where it begins, from the wheel's centre, and its vector [m].
        reach: Larger gaps leave `best` as it is [m].
        best: (n,) squared gaps [m^2], `BURIED` where the link begins in the ground or crosses it.
    """
    x, z, faces, wheels = near.x, near.z, near.faces, near.wheels
    ax, az, lx, lz = link[0], link[1], link[2], link[3]
    zero, one, buried = np.float32(0.0), np.float32(1.0), BURIED
    over = one / max(lx * lx + lz * lz, np.float32(1e-18))
    low, high = min(zero, lx) + ax - reach, max(zero, lx) + ax + reach
    bottom = az + min(zero, lz) - reach
    for k in range(len(faces)):
        if faces[k, 4] < bottom:
            continue
        a, b = wheels[k, 0], wheels[k, 1]
        first, last = faces[k, 0] - high, faces[k, 0] + faces[k, 2] - low
        while a < b and x[a] < first:
            a += 1
        while b > a and x[b - 1] > last:
            b -= 1
        cx, cz = faces[k, 0] - ax, faces[k, 1] - az
        ex, ez, short = faces[k, 2], faces[k, 3], faces[k, 5]
        turn, along = lx * ez - lz * ex, lx * ex + lz * ez
        u, v, out = x[a:b], z[a:b], best[a:b]
        for i in range(b - a):
            # From the link's begin to the face's; s, f: on which side of link and of face.
            rx, rz = cx - u[i], cz - v[i]
            re, rl = rx * ex + rz * ez, rx * lx + rz * lz
            s, f = lx * rz - lz * rx, ez * rx - ex * rz
            t = min(one, max(zero, -re * short))
            px, pz = rx + t * ex, rz + t * ez
            gap = px * px + pz * pz
            t = min(one, max(zero, (along - re) * short))
            px, pz = rx + t * ex - lx, rz + t * ez - lz
            gap = min(gap, px * px + pz * pz)
            t = min(one, max(zero, rl * over))
            px, pz = rx - t * lx, rz - t * lz
            gap = min(gap, px * px + pz * pz)
            t = min(one, max(zero, (rl + along) * over))
            px, pz = rx + ex - t * lx, rz + ez - t * lz
            gap = min(gap, px * px + pz * pz)
            crosses = (s * (s + turn) < zero) & (f * (f - turn) < zero)
            under = (rx <= zero) & (rx + ex >= zero) & (f < zero) & (ex > zero)
            gap = buried if crosses | under else gap
            out[i] = min(out[i], gap)
