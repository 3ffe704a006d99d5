"""The lattice search: widest path over all poses first, then the cheapest among the wide ones.

Every cell (a pair of wheel samples) holds a volume over pitch, z and x. A move takes one or both
wheels to the next sample while the body shifts by up to two lattice steps in each direction.

1. `flood` spreads quality (CoM margin, at the reserved friction where that is possible): the value
   of a pose is the least quality on the best way to it. One byte a pose, so a cell costs
   microseconds; it is also the verdict on impossible terrain.
2. `cheapest` finds the smoothest way among poses whose best way through them is wide enough.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from .cells import Cells, World, columns, legs_clear, quality
from .tables import INF, ROW, Floats32, Lattice

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Bytes = NDArray[np.uint8]
Flags = NDArray[np.bool_]

# Wheel moves (front, rear); the first three roll forward.
MOVES = np.array(
    [[1, 1], [1, 0], [0, 1], [1, -1], [-1, 1], [-1, 0], [0, -1], [-1, -1]], dtype=np.int32
)
FORWARD = 3
_FAR = np.float32(2.6)  # cost of two lattice steps in one move, in steps


@nb.njit(cache=True)
def _gather(volume: Bytes, cells: Cells, lat: Lattice, c: int, p: int, pad: Bytes) -> None:
    """pad = max(pad, volume of cell `p` seen from cell `c`); pad has two lattice steps of rim."""
    ot, oz, ox = cells.t0[c] - cells.t0[p], cells.z0[c] - cells.z0[p], cells.x0[c] - cells.x0[p]
    x0, x1 = max(-2, -ox), min(lat.nx + 2, lat.nx - ox)
    for t in range(max(-2, -ot), min(lat.nt + 2, lat.nt - ot)):
        for z in range(max(-2, -oz), min(lat.nz + 2, lat.nz - oz)):
            src = volume[p, t + ot, z + oz]
            dst = pad[t + 2, z + 2]
            for x in range(x0, x1):
                v = src[x + ox]
                u = dst[x + 2]
                dst[x + 2] = v if v > u else u


@nb.njit(cache=True)
def _dilate(pad: Bytes, tmp: Bytes, lat: Lattice) -> None:
    """Largest value within two lattice steps along each axis, in place (the rim is scratch)."""
    for t in range(lat.nt + 4):
        for z in range(lat.nz + 4):
            a, b = pad[t, z], tmp[t, z]
            for x in range(2, lat.nx + 2):
                u = a[x - 2] if a[x - 2] > a[x - 1] else a[x - 1]
                v = a[x + 2] if a[x + 2] > a[x + 1] else a[x + 1]
                u = u if u > v else v
                b[x] = u if u > a[x] else a[x]
    for t in range(lat.nt + 4):
        for z in range(2, lat.nz + 2):
            b = pad[t, z]
            a0, a1, a2, a3, a4 = (
                tmp[t, z - 2],
                tmp[t, z - 1],
                tmp[t, z],
                tmp[t, z + 1],
                tmp[t, z + 2],
            )
            for x in range(2, lat.nx + 2):
                u = a0[x] if a0[x] > a1[x] else a1[x]
                v = a3[x] if a3[x] > a4[x] else a4[x]
                u = u if u > v else v
                b[x] = u if u > a2[x] else a2[x]
    for t in range(2, lat.nt + 2):
        for z in range(2, lat.nz + 2):
            b = tmp[t, z]
            a0, a1, a2, a3, a4 = (
                pad[t - 2, z],
                pad[t - 1, z],
                pad[t, z],
                pad[t + 1, z],
                pad[t + 2, z],
            )
            for x in range(2, lat.nx + 2):
                u = a0[x] if a0[x] > a1[x] else a1[x]
                v = a3[x] if a3[x] > a4[x] else a4[x]
                u = u if u > v else v
                b[x] = u if u > a2[x] else a2[x]


@nb.njit(cache=True)
def flood(
    w: World,
    cells: Cells,
    source: int,
    seed: Ints,
    moves: int,
    back: bool,
    qual: Bytes,
    state: Bytes,
    width: Bytes,
    alive: Flags,
) -> bool:
    """One sweep of the widest path from cell `source` over all cells; True if anything changed.

    Args:
        w, cells: The problem.
        source: Start cell (goal cell when `back`).
        seed: (3,) lattice pose (t, z, x, window indices) round which the source is entered.
        moves: How many of `MOVES` are allowed.
        back: Follow moves backward and run through the cells in reverse.
        qual: (cells, nt, nz, ROW) quality, computed on first use.
        state: (cells,) 0 not computed, 1 computed, 2 nothing possible.
        width: (cells, nt, nz, ROW) result so far.
        alive: (cells,) whether anything in the cell is reached.
    """
    lat = w.lat
    n = len(cells.front)
    pad = np.zeros((lat.nt + 4, lat.nz + 4, ROW + 4), np.uint8)
    tmp = np.zeros((lat.nt + 4, lat.nz + 4, ROW + 4), np.uint8)
    points = np.empty((2, 3, 2))
    changed = False
    for k in range(n):
        c = n - 1 - k if back else k
        if state[c] == 2:
            continue
        any_from = c == source
        pad[:] = 0
        if c == source:
            for t in range(max(0, seed[0] - 2), min(lat.nt, seed[0] + 3)):
                for z in range(max(0, seed[1] - 2), min(lat.nz, seed[1] + 3)):
                    for x in range(max(0, seed[2] - 2), min(lat.nx, seed[2] + 3)):
                        pad[t + 2, z + 2, x + 2] = 255
        sign = -1 if not back else 1
        for m in range(moves):
            i = cells.front[c] + sign * MOVES[m, 0]
            j = cells.rear[c] + sign * MOVES[m, 1]
            if i < 0 or j < 0 or i >= len(w.s) or j >= len(w.s):
                continue
            p = cells.index[i, j]
            if p < 0 or not alive[p]:
                continue
            if not any_from:
                any_from = True
            _gather(width, cells, lat, c, p, pad)
        if not any_from:
            continue
        if state[c] == 0:
            state[c] = 1
            if not quality(w, cells, c, qual[c]):
                state[c] = 2
                continue
        if c != source:
            _dilate(pad, tmp, lat)
        result = pad if c == source else tmp
        for t in range(lat.nt):
            for z in range(lat.nz):
                q, v, r = qual[c, t, z], width[c, t, z], result[t + 2, z + 2]
                some = np.uint8(0)
                for x in range(lat.nx):
                    u = q[x] if q[x] < r[x + 2] else r[x + 2]
                    grown = u if u > v[x] else np.uint8(0)
                    r[x + 2] = grown
                    some = some | grown
                if some == 0:
                    continue
                for x in range(lat.nx):
                    grown = r[x + 2]
                    if grown > 0:
                        if v[x] == 0 and not back and not legs_clear(w, cells, c, t, z, x, points):
                            q[x] = 0
                        else:
                            v[x] = grown
                            alive[c] = True
                            changed = True
    return changed


@nb.njit(cache=True)
def _step_cost(w: World, cells: Cells, c: int, m: int) -> float:
    """Cost of rolling into cell `c` by move `m`: distance, dearer when one wheel rolls alone."""
    i, j = cells.front[c] - MOVES[m, 0], cells.rear[c] - MOVES[m, 1]
    length = abs(w.s[cells.front[c]] - w.s[i]) + abs(w.s[cells.rear[c]] - w.s[j])
    return length * (1.0 if m == 0 else (1.25 if m < FORWARD else 2.5)) / (2.0 * w.lat.step)


@nb.njit(cache=True, error_model="numpy")
def _convolve(a: Floats32, b: Floats32, lat: Lattice, cost: float) -> None:
    """Min-plus convolution with the cost of body motion along each axis; the result is in `b`."""
    one, far = np.float32(cost), np.float32(cost) * _FAR
    for t in range(lat.nt + 4):
        for z in range(lat.nz + 4):
            s, d = a[t, z], b[t, z]
            for x in range(2, lat.nx + 2):
                u = min(s[x - 1], s[x + 1]) + one
                v = min(s[x - 2], s[x + 2]) + far
                d[x] = min(s[x], min(u, v))
    for t in range(lat.nt + 4):
        for z in range(2, lat.nz + 2):
            d = a[t, z]
            s0, s1, s2, s3, s4 = b[t, z - 2], b[t, z - 1], b[t, z], b[t, z + 1], b[t, z + 2]
            for x in range(2, lat.nx + 2):
                u = min(s1[x], s3[x]) + one
                v = min(s0[x], s4[x]) + far
                d[x] = min(s2[x], min(u, v))
    for t in range(2, lat.nt + 2):
        for z in range(2, lat.nz + 2):
            d = b[t, z]
            s0, s1, s2, s3, s4 = a[t - 2, z], a[t - 1, z], a[t, z], a[t + 1, z], a[t + 2, z]
            for x in range(2, lat.nx + 2):
                u = min(s1[x], s3[x]) + one
                v = min(s0[x], s4[x]) + far
                d[x] = min(s2[x], min(u, v))


@nb.njit(cache=True, error_model="numpy")
def pose_cost(w: World, cells: Cells, c: int, t: int, z: int, pulls: Floats, row: Floats32) -> None:
    """Cost (ROW,) of the poses in row (t, z) of cell `c`, INF where impossible.

    `pulls`: weights of CoM margin, pitch; nominal height above the wheels' mean [m]; the margin
    wished for [m].
    """
    lat = w.lat
    row[:] = INF
    fz, rz, tz, sf, sr, st = columns(w, cells, c, t, z)
    if fz < 0:
        return
    i, j, tt = cells.front[c], cells.rear[c], cells.t0[c] + t
    pitch = (tt - lat.pitches // 2) * lat.turn
    mean = 0.5 * (w.centres[i, 1] + w.centres[j, 1])
    rise = ((cells.z0[c] + z) * lat.step - mean) / pulls[2] - 1.0
    base = np.float32(
        0.5 * pulls[1] * 0.15 * (pitch + 0.8 * cells.slope[c]) ** 2 + 0.3 * rise * rise
    )
    spans = cells.spans[c]
    lo, hi = np.float32(spans[4]), np.float32(spans[5])
    rlo, rhi = np.float32(spans[2]), np.float32(spans[3])
    if spans[2] > spans[3]:
        rlo = rhi = np.float32(0.5 * (spans[0] + spans[1]))
    mass = np.float32(1.0 / w.robot.mass)
    share = np.float32(w.robot.trunk_mass / w.robot.mass)
    wish, heavy = np.float32(pulls[3]), np.float32(0.25 * pulls[0])
    worst, zero, half = np.float32(-0.06), np.float32(0.0), np.float32(0.5)
    x_first, step = np.float32(cells.x0[c] * lat.step), np.float32(lat.step)
    fc, fm = w.front_table.cost[i, tt, fz], w.front_table.moment[i, tt, fz]
    rc, rm = w.rear_table.cost[j, tt, rz], w.rear_table.moment[j, tt, rz]
    tc = w.trunk[tt, tz]
    for x in range(max(0, max(-sf, -sr)), min(lat.nx, min(ROW - sf, ROW - sr))):
        e = fc[x + sf] + rc[x + sr] + tc[x + st]
        com = share * (x_first + np.float32(x) * step) + mass * (fm[x + sf] + rm[x + sr])
        h = max(zero, wish - max(worst, min(com - lo, hi - com))) / wish
        k = max(zero, wish - max(worst, min(com - rlo, rhi - com))) / wish
        row[x] = half * e + base + heavy * (h * h + k * k)


@nb.njit(cache=True, error_model="numpy")
def cheapest(
    w: World,
    cells: Cells,
    source: int,
    seed: Ints,
    moves: int,
    smooth: float,
    pulls: Floats,
    level: int,
    width: Bytes,
    rest: Bytes,
    value: Floats32,
    alive: Flags,
    back: bool,
) -> bool:
    """One sweep of the cheapest way from `source` through poses at least `level` wide.

    `value` (cells, nt, nz, ROW) holds the costs so far; `alive` (cells,) who has any. Returns
    whether anything changed.
    """
    lat = w.lat
    n = len(cells.front)
    a = np.full((lat.nt + 4, lat.nz + 4, ROW + 4), INF, np.float32)
    b = np.full((lat.nt + 4, lat.nz + 4, ROW + 4), INF, np.float32)
    row = np.empty(ROW, np.float32)
    least = np.uint8(level)
    changed = False
    for k in range(n):
        c = n - 1 - k if back else k
        wide = False
        for t in range(lat.nt):
            for z in range(lat.nz):
                p, q = width[c, t, z], rest[c, t, z]
                some = np.uint8(0)
                for x in range(lat.nx):
                    u = p[x] if p[x] < q[x] else q[x]
                    some = u if u > some else some
                if some >= least:
                    wide = True
        if not wide:
            continue
        found = c == source
        a[:] = INF
        if found:
            for t in range(max(0, seed[0] - 2), min(lat.nt, seed[0] + 3)):
                for z in range(max(0, seed[1] - 2), min(lat.nz, seed[1] + 3)):
                    for x in range(max(0, seed[2] - 2), min(lat.nx, seed[2] + 3)):
                        far = abs(t - seed[0]) + abs(z - seed[1]) + abs(x - seed[2])
                        a[t + 2, z + 2, x + 2] = np.float32(far)
        for m in range(moves):
            i, j = cells.front[c] - MOVES[m, 0], cells.rear[c] - MOVES[m, 1]
            if i < 0 or j < 0 or i >= len(w.s) or j >= len(w.s):
                continue
            p = cells.index[i, j]
            if p < 0 or not alive[p]:
                continue
            found = True
            cost = np.float32(_step_cost(w, cells, c, m))
            ot, oz, ox = (
                cells.t0[c] - cells.t0[p],
                cells.z0[c] - cells.z0[p],
                cells.x0[c] - cells.x0[p],
            )
            x0, x1 = max(-2, -ox), min(lat.nx + 2, lat.nx - ox)
            for t in range(max(-2, -ot), min(lat.nt + 2, lat.nt - ot)):
                for z in range(max(-2, -oz), min(lat.nz + 2, lat.nz - oz)):
                    s, d = value[p, t + ot, z + oz], a[t + 2, z + 2]
                    for x in range(x0, x1):
                        d[x + 2] = min(d[x + 2], s[x + ox] + cost)
        if not found:
            continue
        if c != source:
            _convolve(a, b, lat, smooth)
        result = a if c == source else b
        for t in range(lat.nt):
            for z in range(lat.nz):
                p, q = width[c, t, z], rest[c, t, z]
                some = np.uint8(0)
                for x in range(lat.nx):
                    u = p[x] if p[x] < q[x] else q[x]
                    some = u if u > some else some
                if some < least:
                    continue
                pose_cost(w, cells, c, t, z, pulls, row)
                r, v = result[t + 2, z + 2], value[c, t, z]
                for x in range(lat.nx):
                    if p[x] >= least and q[x] >= least and r[x + 2] < INF and row[x] < INF:
                        cost = r[x + 2] + row[x]
                        if cost < v[x] - np.float32(1e-4):
                            v[x] = cost
                            alive[c] = True
                            changed = True
    return changed


@nb.njit(cache=True)
def trace(
    w: World,
    cells: Cells,
    source: int,
    goal: int,
    pose: Ints,
    moves: int,
    smooth: float,
    value: Floats32,
    out: Ints,
) -> int:
    """Follow the costs back from `pose` in `goal`; rows (front, rear, pitch, z, x) into `out`.

    Returns their number (goal first), or -1 if the way does not end within `out`.
    """
    lat = w.lat
    c, t, z, x = goal, pose[0], pose[1], pose[2]
    price = np.array([2.6, 1.0, 0.0, 1.0, 2.6]) * smooth
    for n in range(len(out)):
        out[n, 0], out[n, 1] = cells.front[c], cells.rear[c]
        out[n, 2] = cells.t0[c] + t - lat.pitches // 2
        out[n, 3], out[n, 4] = cells.z0[c] + z, cells.x0[c] + x
        if c == source:
            return n + 1
        best, bc, bt, bz, bx = 1e8, -1, 0, 0, 0
        for m in range(moves):
            i, j = cells.front[c] - MOVES[m, 0], cells.rear[c] - MOVES[m, 1]
            if i < 0 or j < 0 or i >= len(w.s) or j >= len(w.s):
                continue
            p = cells.index[i, j]
            if p < 0:
                continue
            cost = _step_cost(w, cells, c, m)
            ot, oz, ox = (
                cells.t0[c] - cells.t0[p],
                cells.z0[c] - cells.z0[p],
                cells.x0[c] - cells.x0[p],
            )
            for dt in range(-2, 3):
                tt = t + dt + ot
                if tt < 0 or tt >= lat.nt:
                    continue
                for dz in range(-2, 3):
                    zz = z + dz + oz
                    if zz < 0 or zz >= lat.nz:
                        continue
                    for dx in range(-2, 3):
                        xx = x + dx + ox
                        if xx < 0 or xx >= lat.nx:
                            continue
                        v = (
                            value[p, tt, zz, xx]
                            + cost
                            + price[dt + 2]
                            + price[dz + 2]
                            + price[dx + 2]
                        )
                        if v < best:
                            best, bc, bt, bz, bx = v, p, tt, zz, xx
        if bc < 0:
            return -1
        c, t, z, x = bc, bt, bz, bx
    return -1
