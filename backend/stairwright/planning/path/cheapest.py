"""Second pass of the search: the cheapest way among poses whose best way to them is wide enough."""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

from .cells import FORWARD, MOVES, Cells, World, row_start, table_rows, volume_size
from .kernels import convolve, gather_cost, reach
from .tables import INF, Floats32, moments
from .volumes import Costs, Volumes, offset
from .words import lowest

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Words = NDArray[np.uint64]

_PACKED = 8  # poses whose widths are in one word


@leaf
def step_cost(w: World, cells: Cells, c: int, m: int) -> float:
    """Cost of rolling into cell `c` by move `m`: distance, dearer when one wheel rolls alone."""
    i, j = cells.front[c] - MOVES[m, 0], cells.rear[c] - MOVES[m, 1]
    length = abs(w.s[cells.front[c]] - w.s[i]) + abs(w.s[cells.rear[c]] - w.s[j])
    return float(length) * (1.0 if m == 0 else (1.25 if m < FORWARD else 2.5)) / (2.0 * w.lat.step)


@leaf
def pose_costs(
    w: World, cells: Cells, c: int, pulls: Floats, width: Words, least: np.uint8, lo: int, hi: int,
    way: Floats32, out: Floats32,
) -> None:  # fmt: skip
    """Costs of ways to the poses of cell `c` in [lo, hi): of the `way` there and of the pose.

    Poses narrower than `least` cost INF.

    Args:
        w: The problem.
        cells: Its cells.
        c: The cell.
        pulls: Weights of CoM margin, pitch; nominal height above the wheels' mean [m]; the margin
            wished for [m].
        width: (volume / 8,) of the cell, eight poses in a word.
        least: Width.
        lo: First position.
        hi: Position after the last.
        way: (volume,) cost so far, INF where none leads.
        out: (volume,) filled from `lo` to `hi`.
    """
    lat = w.lat
    i, j = cells.front[c], cells.rear[c]
    mean = 0.5 * (w.centres[i, 1] + w.centres[j, 1])
    spans = cells.spans[c]
    low, high = np.float32(spans[4]), np.float32(spans[5])
    rlow, rhigh = np.float32(spans[2]), np.float32(spans[3])
    if spans[2] > spans[3]:
        rlow = rhigh = np.float32(0.5 * (spans[0] + spans[1]))
    mass = np.float32(1.0 / w.robot.mass)
    share = np.float32(w.robot.trunk_mass / w.robot.mass)
    wish, heavy = np.float32(pulls[3]), np.float32(0.25 * pulls[0])
    worst, zero, half = np.float32(-0.06), np.float32(0.0), np.float32(0.5)
    advance = share * np.float32(lat.step)
    first = share * np.float32(cells.x0[c] * lat.step)
    first += mass * (w.front_table.carried[i] + w.rear_table.carried[j])
    front, rear, trunk = w.front_table.cost, w.rear_table.cost, w.trunk.cost
    page, words = lat.row * (lat.nz + 4), lat.row // _PACKED
    out[lo:hi] = INF
    for t in range(max(0, lo // page - 2), min(lat.nt, hi // page - 1)):
        tt = cells.t0[c] + t
        lean = (tt - lat.pitches // 2) * lat.turn + 0.8 * cells.slope[c]
        fz, rz, tz, sf, sr, st, _, _ = table_rows(w, cells, c, t)
        front_moments, fu, fv = moments(w.front_table, i, tt, sf, fz)
        rear_moments, ru, rv = moments(w.rear_table, j, tt, sr, rz)
        for z in range(lat.nz):
            k = row_start(lat, t, z)
            rise = ((cells.z0[c] + z) * lat.step - mean) / pulls[2] - 1.0
            base = np.float32(0.075 * pulls[1] * lean * lean + 0.3 * rise * rise)
            for q in range(k // _PACKED, k // _PACKED + words):
                word = width[q]
                while word != 0:
                    byte = lowest(word) // 8
                    bits = np.uint64(8 * byte)
                    wide = np.uint8(word >> bits & np.uint64(255)) >= least
                    word &= ~(np.uint64(255) << bits)
                    at = q * _PACKED + byte
                    if not wide or at < lo or at >= hi or way[at] >= INF:
                        continue
                    x = at - k
                    e = front[i, tt, fz + z, x + sf] + rear[j, tt, rz + z, x + sr]
                    e += trunk[tt, tz + z, x + st]
                    legs = front_moments[fv + z, fu + x] + rear_moments[rv + z, ru + x]
                    com = first + np.float32(x) * advance + mass * legs
                    h = max(zero, wish - max(worst, min(com - low, high - com))) / wish
                    g = max(zero, wish - max(worst, min(com - rlow, rhigh - com))) / wish
                    out[at] = way[at] + half * e + base + heavy * (h * h + g * g)


@nb.njit(cache=True, nogil=True)
def cheapest(
    w: World,
    cells: Cells,
    v: Volumes,
    costs: Costs,
    source: int,
    seed: Ints,
    moves: int,
    smooth: float,
    pulls: Floats,
    level: int,
) -> bool:
    """One sweep of the cheapest way from `source` through poses at least `level` wide.

    A cell is left out if no cell that leads to it has changed since it was last looked at.

    Args:
        w: The problem.
        cells: Its cells.
        v: Their volumes.
        costs: What is filled.
        source: Start cell.
        seed: (3,) lattice pose round which it is entered.
        moves: How many of `MOVES` are allowed.
        smooth: Cost of one lattice step of the body.
        pulls: See `pose_costs`.
        level: Least width.

    Returns:
        Whether anything changed.
    """
    lat = w.lat
    size, margin = volume_size(lat), reach(lat)
    pad, result = np.full(size, INF, np.float32), np.full(size, INF, np.float32)
    least, widths = np.uint8(level), v.width.view(np.uint64)
    changed, sweeps = False, costs.sweeps
    for c in range(len(cells.front)):
        if costs.first[c] >= costs.last[c]:
            continue
        lo, hi = size, 0
        news = c == source and sweeps.seen[c] < 0
        for m in range(moves):
            p = cells.origin[c, m]
            if p >= 0 and costs.low[p] < costs.high[p]:
                by = offset(cells, lat, c, p)
                lo, hi = min(lo, costs.low[p] - by), max(hi, costs.high[p] - by)
                news |= sweeps.grown[p] > sweeps.seen[c]
        if not news:
            continue
        sweeps.clock[0] += 1
        sweeps.seen[c] = sweeps.clock[0]
        if c == source:
            lo, hi = 0, size
        lo, hi = max(0, lo - margin), min(size, hi + margin)
        if max(lo, costs.first[c]) >= min(hi, costs.last[c]):
            continue
        a, b = max(0, lo - margin), min(size, hi + margin)
        pad[a:b] = INF
        result[a:b] = INF
        for m in range(moves):
            p = cells.origin[c, m]
            if p >= 0 and costs.low[p] < costs.high[p]:
                by, at = offset(cells, lat, c, p), costs.base[p]
                cost, low, high = step_cost(w, cells, c, m), at + costs.low[p], at + costs.high[p]
                gather_cost(costs.value, low, high, at + by, cost, pad)
        convolve(pad, result, lo, hi, lat, smooth)
        if c == source:
            for t in range(max(0, seed[0] - 2), min(lat.nt, seed[0] + 3)):
                for z in range(max(0, seed[1] - 2), min(lat.nz, seed[1] + 3)):
                    for x in range(max(0, seed[2] - 2), min(lat.nx, seed[2] + 3)):
                        far = abs(t - seed[0]) + abs(z - seed[1]) + abs(x - seed[2])
                        result[row_start(lat, t, z) + x] = np.float32(far)
        lo, hi = max(lo, costs.first[c]), min(hi, costs.last[c])
        pose_costs(w, cells, c, pulls, widths[v.slot[c]], least, lo, hi, result, pad)
        if _keep(costs, c, lo, hi, pad):
            sweeps.grown[c] = sweeps.clock[0]
            changed = True
    return changed


@leaf
def _keep(costs: Costs, c: int, lo: int, hi: int, result: Floats32) -> bool:
    """Take over what of `result` in [lo, hi) is cheaper than what cell `c` has; True if any is."""
    while lo < hi and result[lo] >= INF:
        lo += 1
    while lo < hi and result[hi - 1] >= INF:
        hi -= 1
    if lo >= hi:
        return False
    value, at, low, high = costs.value, costs.base[c], costs.low[c], costs.high[c]
    if low >= high:
        new, room = result[lo:hi], value[at + lo : at + hi]
        for k in range(hi - lo):
            room[k] = new[k]
        costs.low[c], costs.high[c] = lo, hi
        return True
    for k in range(lo, low):
        value[at + k] = INF
    for k in range(high, hi):
        value[at + k] = INF
    costs.low[c], costs.high[c] = min(lo, low), max(hi, high)
    changed = False
    for k in range(lo, hi):
        if result[k] < value[at + k] - np.float32(1e-4):
            value[at + k] = result[k]
            changed = True
    return changed


@nb.njit(cache=True, nogil=True)
def trace(
    w: World,
    cells: Cells,
    costs: Costs,
    source: int,
    goal: int,
    pose: Ints,
    moves: int,
    smooth: float,
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
            p = cells.origin[c, m]
            if p < 0 or costs.low[p] >= costs.high[p]:
                continue
            at, cost = costs.base[p], step_cost(w, cells, c, m)
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
                        k = row_start(lat, tt, zz) + xx
                        if k < costs.low[p] or k >= costs.high[p]:
                            continue
                        u = costs.value[at + k] + cost
                        u += price[dt + 2] + price[dz + 2] + price[dx + 2]
                        if u < best:
                            best, bc, bt, bz, bx = u, p, tt, zz, xx
        if bc < 0:
            return -1
        c, t, z, x = bc, bt, bz, bx
    return -1
