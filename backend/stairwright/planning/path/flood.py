"""First pass of the search: the widest way to every pose, and so the verdict whether there is one.

Every cell (a pair of wheel samples) holds a volume over pitch, z and x. A move takes one or both
wheels to the next sample while the body shifts by up to two lattice steps in each direction. The
width of a pose is the least quality (CoM margin, at the reserved friction where that is possible)
on the best way to it: one byte a pose, so a cell costs microseconds.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from .cells import Cells, World, quality, row_start, volume_size
from .collide import legs_clear
from .kernels import dilate, gather, reach
from .volumes import Volumes, offset

Ints = NDArray[np.int32]
Bytes = NDArray[np.uint8]
Flags = NDArray[np.bool_]


@nb.njit(cache=True, nogil=True)
def flood(w: World, cells: Cells, v: Volumes, source: int, seed: Ints, moves: int) -> bool:
    """One sweep of the widest path from cell `source` over all cells; True if anything changed.

    Args:
        w: The problem.
        cells: Its cells.
        v: Their volumes: `quality` and `width` are filled.
        source: Start cell.
        seed: (3,) lattice pose (t, z, x, window indices) round which the source is entered.
        moves: How many of `MOVES` are allowed.
    """
    lat = w.lat
    size, margin = volume_size(lat), reach(lat)
    pad, result = np.zeros(size, np.uint8), np.zeros(size, np.uint8)
    clear = np.ones(lat.nx, np.bool_)
    changed = False
    for c in range(len(cells.front)):
        if v.dead[c]:
            continue
        lo, hi = size, 0
        for m in range(moves):
            p = cells.origin[c, m]
            if p >= 0 and v.first[p] < v.last[p]:
                by = offset(cells, lat, c, p)
                lo, hi = min(lo, v.first[p] - by), max(hi, v.last[p] - by)
        if c == source:
            lo, hi = 0, size
        lo, hi = max(0, lo - margin), min(size, hi + margin)
        if lo >= hi:
            continue
        a, b = max(0, lo - margin), min(size, hi + margin)
        pad[a:b] = 0
        result[a:b] = 0
        for m in range(moves):
            p = cells.origin[c, m]
            if p >= 0 and v.first[p] < v.last[p]:
                by = offset(cells, lat, c, p)
                gather(v.width[v.slot[p]], v.first[p], v.last[p], by, pad)
        dilate(pad, result, lo, hi, lat)
        if c == source:
            for t in range(max(0, seed[0] - 2), min(lat.nt, seed[0] + 3)):
                for z in range(max(0, seed[1] - 2), min(lat.nz, seed[1] + 3)):
                    for x in range(max(0, seed[2] - 2), min(lat.nx, seed[2] + 3)):
                        result[row_start(lat, t, z) + x] = 255
        k = v.slot[c]
        if k < 0:
            k = v.used[0]
            v.quality[k] = 0
            if not quality(w, cells, c, v.quality[k]):
                v.dead[c] = True
                continue
            v.used[0] += 1
            v.slot[c] = k
            v.width[k] = 0
        if _grow(w, cells, v, c, lo, hi, result, clear):
            changed = True
    return changed


@nb.njit(cache=True, nogil=True)
def _grow(
    w: World, cells: Cells, v: Volumes, c: int, lo: int, hi: int, result: Bytes, clear: Flags
) -> bool:
    """Widen the ways to poses of cell `c` to what `result` holds in [lo, hi); True if any grew."""
    lat = w.lat
    quality, width = v.quality[v.slot[c]], v.width[v.slot[c]]
    q, u, r = quality[lo:hi], width[lo:hi], result[lo:hi]
    some = np.uint8(0)
    for k in range(hi - lo):
        least = q[k] if q[k] < r[k] else r[k]
        grown = least if least > u[k] else np.uint8(0)
        r[k] = grown
        some = some | grown
    if some == 0:
        return False
    changed = False
    i, j = cells.front[c], cells.rear[c]
    wheels = (w.centres[i, 0], w.centres[i, 1], w.centres[j, 0], w.centres[j, 1])
    page = lat.row * (lat.nz + 4)
    for t in range(max(0, lo // page - 2), min(lat.nt, hi // page - 1)):
        pitch = (cells.t0[c] + t - lat.pitches // 2) * lat.turn
        cos, sin = math.cos(pitch), math.sin(pitch)
        for z in range(lat.nz):
            begin = row_start(lat, t, z)
            if begin + lat.nx <= lo or begin >= hi:
                continue
            a, b = max(begin, lo), min(begin + lat.nx, hi)
            q, u, r = quality[a:b], width[a:b], result[a:b]
            first, last, some = b - a, 0, np.uint8(0)
            for x in range(b - a):
                some = some | r[x]
            if some == 0:
                continue
            for x in range(b - a):
                if r[x] > 0 and u[x] == 0:
                    first, last = min(first, x), x + 1
            if last > 0:
                legs_clear(
                    w.robot, w.front, w.rear, w.legs_gap, wheels, cells.x0[c] * lat.step, lat.step,
                    (cells.z0[c] + z) * lat.step, cos, sin, a - begin + first, a - begin + last,
                    clear,
                )  # fmt: skip
            for x in range(b - a):
                if r[x] > 0:
                    if u[x] == 0 and not clear[a - begin + x]:
                        q[x] = 0
                    else:
                        u[x] = r[x]
                        v.best[c] = max(v.best[c], r[x])
                        v.first[c] = min(v.first[c], a + x)
                        v.last[c] = max(v.last[c], a + x + 1)
                        changed = True
    return changed
