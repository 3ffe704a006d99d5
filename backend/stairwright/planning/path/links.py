"""How far a link is from the ground, for all wheel samples at once: loops that compilers vectorise.

Float32 in metres from the first sample: good for 1e-6 m on a window of the search.
"""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

from .ground import Ground

Floats32 = NDArray[np.float32]
Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BURIED = np.float32(-1.0)  # squared gap of a link that starts in the ground or crosses its face


@nb.njit(cache=True, nogil=True)
def faces_near(g: Ground, x: Floats, z: Floats, reach: float) -> tuple[Floats32, Ints]:
    """The ground's segments that come within `reach` of wheels, and which wheels those are.

    Args:
        g: The ground.
        x, z: (n,) wheel centres, x rising [m].
        reach: In x [m].

    Returns:
        (k, 6) corner, vector, top above the lowest of its wheels, 1 / length^2; all but the last
        two as differences from the first wheel's centre. (k, 2) first and last + 1 of the wheels.
    """
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
    return faces[:count], wheels[:count]


@nb.njit(cache=True, error_model="numpy", fastmath=True, nogil=True)
def nearer(
    faces: Floats32, wheels: Ints, x: Floats32, z: Floats32, link: Floats32, reach: float,
    best: Floats32,
) -> None:  # fmt: skip
    """Lower `best` to the squared gap between the ground and a link that moves with the wheel.

    Args:
        faces, wheels: Of `faces_near`.
        x, z: (n,) wheel centres less the first [m].
        link: (4,) where it begins, from the wheel's centre, and its vector [m].
        reach: Larger gaps leave `best` as it is [m].
        best: (n,) squared gaps [m^2], `BURIED` where the link begins in the ground or crosses it.
    """
    ax, az, lx, lz = link[0], link[1], link[2], link[3]
    zero, one, buried = np.float32(0.0), np.float32(1.0), BURIED
    over = one / max(lx * lx + lz * lz, np.float32(1e-18))
    low, high = min(zero, lx) + ax - reach, max(zero, lx) + ax + reach
    bottom = az + min(zero, lz) - reach
    for k in range(len(faces)):
        if faces[k, 4] < bottom:
            continue
        a, b = wheels[k, 0], wheels[k, 1]
        near, far = faces[k, 0] - high, faces[k, 0] + faces[k, 2] - low
        while a < b and x[a] < near:
            a += 1
        while b > a and x[b - 1] > far:
            b -= 1
        cx, cz = faces[k, 0] - ax, faces[k, 1] - az
        ex, ez, short = faces[k, 2], faces[k, 3], faces[k, 5]
        turn, along = lx * ez - lz * ex, lx * ex + lz * ez
        u, v, out = x[a:b], z[a:b], best[a:b]
        for i in range(b - a):
            # From the link's begin to the face's; `cross` > 0 on the ground's side of either.
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
