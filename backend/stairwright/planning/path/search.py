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

from .cells import Cells, World, columns, quality, row_start, volume_size
from .collide import legs_clear
from .kernels import convolve, dilate, gather, gather_cost, shift
from .tables import INF, Floats32, Lattice

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Bytes = NDArray[np.uint8]
Flags = NDArray[np.bool_]

# Wheel moves (front, rear); the first three roll forward.
MOVES = np.array(
    [[1, 1], [1, 0], [0, 1], [1, -1], [-1, 1], [-1, 0], [0, -1], [-1, -1]], dtype=np.int32
)
FORWARD = 3


@nb.njit(cache=True)
def _neighbour(cells: Cells, c: int, m: int, sign: int) -> int:
    """The cell that move `m` comes from (sign -1) or leads to (+1), or -1."""
    i = cells.front[c] + sign * MOVES[m, 0]
    j = cells.rear[c] + sign * MOVES[m, 1]
    if i < 0 or j < 0 or i >= len(cells.number) or j >= len(cells.number):
        return -1
    return int(cells.number[i, j])


@nb.njit(cache=True)
def _offset(cells: Cells, lat: Lattice, c: int, p: int) -> int:
    """Flat shift from a pose's place in cell `c` to its place in cell `p`."""
    return shift(
        lat, cells.t0[c] - cells.t0[p], cells.z0[c] - cells.z0[p], cells.x0[c] - cells.x0[p]
    )


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
        w: The problem.
        cells: Its cells.
        source: Start cell (goal cell when `back`).
        seed: (3,) lattice pose (t, z, x, window indices) round which the source is entered.
        moves: How many of `MOVES` are allowed.
        back: Follow moves backward and run through the cells in reverse.
        qual: (cells, volume) quality, zero at first, computed on first use.
        state: (cells,) 0 not computed, 1 computed, 2 nothing possible.
        width: (cells, volume) result so far, zero at first.
        alive: (cells,) whether anything in the cell is reached.
    """
    lat = w.lat
    n = len(cells.front)
    pad, result = np.zeros(volume_size(lat), np.uint8), np.zeros(volume_size(lat), np.uint8)
    clear = np.ones(lat.nx, np.bool_)
    changed = False
    for k in range(n):
        c = n - 1 - k if back else k
        if state[c] == 2:
            continue
        entered = c == source
        pad[:] = 0
        for m in range(moves):
            p = _neighbour(cells, c, m, 1 if back else -1)
            if p >= 0 and alive[p]:
                entered = True
                gather(width[p], _offset(cells, lat, c, p), pad)
        if not entered:
            continue
        if state[c] == 0:
            state[c] = 1
            if not quality(w, cells, c, qual[c]):
                state[c] = 2
                continue
        dilate(pad, result, lat)
        if c == source:
            for t in range(max(0, seed[0] - 2), min(lat.nt, seed[0] + 3)):
                for z in range(max(0, seed[1] - 2), min(lat.nz, seed[1] + 3)):
                    for x in range(max(0, seed[2] - 2), min(lat.nx, seed[2] + 3)):
                        result[row_start(lat, t, z) + x] = 255
        for t in range(lat.nt):
            pitch = (cells.t0[c] + t - lat.pitches // 2) * lat.turn
            cos, sin = math.cos(pitch), math.sin(pitch)
            for z in range(lat.nz):
                a = row_start(lat, t, z)
                q, v, r = qual[c, a : a + lat.nx], width[c, a : a + lat.nx], result[a : a + lat.nx]
                some = np.uint8(0)
                for x in range(lat.nx):
                    u = q[x] if q[x] < r[x] else r[x]
                    grown = u if u > v[x] else np.uint8(0)
                    r[x] = grown
                    some = some | grown
                if some == 0:
                    continue
                first, last = lat.nx, 0
                for x in range(lat.nx):
                    if r[x] > 0 and v[x] == 0:
                        first, last = min(first, x), x + 1
                if last > 0 and not back:
                    legs_clear(w, cells, c, cos, sin, z, first, last, clear)
                for x in range(lat.nx):
                    if r[x] > 0:
                        if v[x] == 0 and not back and not clear[x]:
                            q[x] = 0
                        else:
                            v[x] = r[x]
                            alive[c] = True
                            changed = True
    return changed


@nb.njit(cache=True)
def step_cost(w: World, cells: Cells, c: int, m: int) -> float:
    """Cost of rolling into cell `c` by move `m`: distance, dearer when one wheel rolls alone."""
    i, j = cells.front[c] - MOVES[m, 0], cells.rear[c] - MOVES[m, 1]
    length = abs(w.s[cells.front[c]] - w.s[i]) + abs(w.s[cells.rear[c]] - w.s[j])
    return float(length) * (1.0 if m == 0 else (1.25 if m < FORWARD else 2.5)) / (2.0 * w.lat.step)


@nb.njit(cache=True, error_model="numpy", fastmath=True)
def pose_cost(w: World, cells: Cells, c: int, t: int, z: int, pulls: Floats, row: Floats32) -> bool:
    """Cost (nx,) of the poses in row (t, z) of cell `c`, INF where impossible; False if all are.

    `pulls`: weights of CoM margin, pitch; nominal height above the wheels' mean [m]; the margin
    wished for [m].
    """
    lat = w.lat
    fz, rz, tz, sf, sr, st, a, b = columns(w, cells, c, t, z)
    if b <= a:
        return False
    row[:] = INF
    i, j, tt = cells.front[c], cells.rear[c], cells.t0[c] + t
    pitch = (tt - lat.pitches // 2) * lat.turn
    mean = 0.5 * (w.centres[i, 1] + w.centres[j, 1])
    rise = ((cells.z0[c] + z) * lat.step - mean) / pulls[2] - 1.0
    lean = pitch + 0.8 * cells.slope[c]
    base = np.float32(0.075 * pulls[1] * lean * lean + 0.3 * rise * rise)
    spans = cells.spans[c]
    lo, hi = np.float32(spans[4]), np.float32(spans[5])
    rlo, rhi = np.float32(spans[2]), np.float32(spans[3])
    if spans[2] > spans[3]:
        rlo = rhi = np.float32(0.5 * (spans[0] + spans[1]))
    mass = np.float32(1.0 / w.robot.mass)
    share = np.float32(w.robot.trunk_mass / w.robot.mass)
    wish, heavy = np.float32(pulls[3]), np.float32(0.25 * pulls[0])
    worst, zero, half = np.float32(-0.06), np.float32(0.0), np.float32(0.5)
    step = np.float32(lat.step)
    first = np.float32((cells.x0[c] + a) * lat.step)
    fc = w.front_table.cost[i, tt, fz, a + sf : b + sf]
    fm = w.front_table.moment[i, tt, fz, a + sf : b + sf]
    rc = w.rear_table.cost[j, tt, rz, a + sr : b + sr]
    rm = w.rear_table.moment[j, tt, rz, a + sr : b + sr]
    tc = w.trunk[tt, tz, a + st : b + st]
    out = row[a:b]
    for x in range(b - a):
        e = fc[x] + rc[x] + tc[x]
        com = share * (first + np.float32(x) * step) + mass * (fm[x] + rm[x])
        h = max(zero, wish - max(worst, min(com - lo, hi - com))) / wish
        k = max(zero, wish - max(worst, min(com - rlo, rhi - com))) / wish
        out[x] = half * e + base + heavy * (h * h + k * k)
    return True


@nb.njit(cache=True)
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
) -> bool:
    """One sweep of the cheapest way from `source` through poses at least `level` wide.

    Args:
        w: The problem.
        cells: Its cells.
        source: Start cell.
        seed: (3,) lattice pose round which it is entered.
        moves: How many of `MOVES` are allowed.
        smooth: Cost of one lattice step of the body.
        pulls: See `pose_cost`.
        level: Least quality of the ways from the start (`width`) and to the goal (`rest`).
        width: (cells, volume).
        rest: (cells, volume).
        value: (cells, volume) costs so far, INF at first.
        alive: (cells,) who has any.

    Returns:
        Whether anything changed.
    """
    lat = w.lat
    size = volume_size(lat)
    a, b = np.empty(size, np.float32), np.full(size, INF, np.float32)
    row = np.empty(lat.nx, np.float32)
    least = np.uint8(level)
    changed = False
    for c in range(len(cells.front)):
        wide = np.uint8(0)
        p8, q8 = width[c], rest[c]
        for k in range(size):
            u = p8[k] if p8[k] < q8[k] else q8[k]
            wide = u if u > wide else wide
        if wide < least:
            continue
        entered = c == source
        a[:] = INF
        for m in range(moves):
            p = _neighbour(cells, c, m, -1)
            if p >= 0 and alive[p]:
                entered = True
                cost = step_cost(w, cells, c, m)
                gather_cost(value[p], _offset(cells, lat, c, p), cost, a)
        if not entered:
            continue
        convolve(a, b, lat, smooth)
        if c == source:
            for t in range(max(0, seed[0] - 2), min(lat.nt, seed[0] + 3)):
                for z in range(max(0, seed[1] - 2), min(lat.nz, seed[1] + 3)):
                    for x in range(max(0, seed[2] - 2), min(lat.nx, seed[2] + 3)):
                        far = abs(t - seed[0]) + abs(z - seed[1]) + abs(x - seed[2])
                        b[row_start(lat, t, z) + x] = np.float32(far)
        for t in range(lat.nt):
            for z in range(lat.nz):
                k = row_start(lat, t, z)
                p, q = p8[k : k + lat.nx], q8[k : k + lat.nx]
                some = np.uint8(0)
                for x in range(lat.nx):
                    u = p[x] if p[x] < q[x] else q[x]
                    some = u if u > some else some
                if some < least or not pose_cost(w, cells, c, t, z, pulls, row):
                    continue
                r, v = b[k : k + lat.nx], value[c, k : k + lat.nx]
                for x in range(lat.nx):
                    if p[x] >= least and q[x] >= least and r[x] < INF and row[x] < INF:
                        cost = r[x] + row[x]
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
            p = _neighbour(cells, c, m, -1)
            if p < 0:
                continue
            cost = step_cost(w, cells, c, m)
            ot, oz = cells.t0[c] - cells.t0[p], cells.z0[c] - cells.z0[p]
            ox = cells.x0[c] - cells.x0[p]
            for dt in range(-2, 3):
                tt = t + dt + ot
                for dz in range(-2, 3):
                    zz = z + dz + oz
                    if tt < 0 or tt >= lat.nt or zz < 0 or zz >= lat.nz:
                        continue
                    for dx in range(-2, 3):
                        xx = x + dx + ox
                        if xx < 0 or xx >= lat.nx:
                            continue
                        v = value[p, row_start(lat, tt, zz) + xx] + cost
                        v += price[dt + 2] + price[dz + 2] + price[dx + 2]
                        if v < best:
                            best, bc, bt, bz, bx = v, p, tt, zz, xx
        if bc < 0:
            return -1
        c, t, z, x = bc, bt, bz, bx
    return -1
