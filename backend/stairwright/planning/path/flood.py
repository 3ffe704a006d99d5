"""First pass of the search: the widest way to every pose, and so the verdict whether there is one.

Every cell (a pair of wheel samples) holds a volume over pitch, z and x. A move takes one or both
wheels to the next sample while the body shifts by up to two lattice steps in each direction. The
width of a pose is the least quality (CoM margin, at the reserved friction where that is possible)
on the best way to it: one byte a pose, so a cell costs microseconds.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

from .cells import Cells, World, quality, row_start, table_rows, volume_size
from .collide import legs_clear
from .kernels import dilate, gather, reach
from .tables import Floats32, Lattice, moments
from .volumes import Volumes, offset
from .words import between, lowest, shifted

Ints = NDArray[np.int32]
Bytes = NDArray[np.uint8]
Flags = NDArray[np.bool_]


@nb.njit(cache=True, nogil=True)
def flood(w: World, cells: Cells, v: Volumes, entry: Flags, seed: Ints, moves: int) -> bool:
    """One sweep of the widest path from the cells of entry over all cells; True if any changed.

    A cell is left out if no cell that leads to it has changed since it was last looked at.

    Args:
        w: The problem.
        cells: Its cells.
        v: Their volumes: `width` is filled.
        entry: (n,) whether ways begin in a cell.
        seed: (3, 2) their first poses: range of lattice poses (t, z, x, window indices).
        moves: How many of `MOVES` are allowed.
    """
    lat = w.lat
    size, margin = volume_size(lat), reach(lat)
    pad, result = np.zeros(size, np.uint8), np.zeros(size, np.uint8)
    fresh = make_fresh(lat)
    changed, sweeps = False, v.sweeps
    for c in range(len(cells.front)):
        lo, hi = size, 0
        news = entry[c] and sweeps.seen[c] < 0
        for m in range(moves):
            p = cells.origin[c, m]
            if p >= 0 and v.first[p] < v.last[p]:
                by = offset(cells, lat, c, p)
                lo, hi = min(lo, v.first[p] - by), max(hi, v.last[p] - by)
                news |= sweeps.grown[p] > sweeps.seen[c]
        if not news:
            continue
        sweeps.clock[0] += 1
        sweeps.seen[c] = sweeps.clock[0]
        if entry[c]:
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
        if entry[c]:
            for t in range(seed[0, 0], seed[0, 1]):
                for z in range(seed[1, 0], seed[1, 1]):
                    k = row_start(lat, t, z)
                    result[k + seed[2, 0] : k + seed[2, 1]] = 255
        k = v.slot[c]
        if k < 0:
            k = v.used[0]
            v.used[0] += 1
            v.slot[c] = k
            v.width[k] = 0
        if _grow(w, cells, v, c, lo, hi, result, fresh):
            sweeps.grown[c] = sweeps.clock[0]
            changed = True
    return changed


class Fresh(NamedTuple):
    """Poses of a cell to which a way leads that is wider than before: room for all that it has.

    Attributes:
        at: Position in the cell's volume.
        com: x of the CoM [m].
        x, z: Of the trunk from the front wheel [m].
        cos, sin: Of its pitch.
        width: Of the way.
        clear: Whether the legs keep clear of each other.
    """

    at: Ints
    com: Floats32
    x: Floats32
    z: Floats32
    cos: Floats32
    sin: Floats32
    width: Bytes
    clear: Flags


@nb.njit(cache=True, nogil=True)
def make_fresh(lat: Lattice) -> Fresh:
    """Room for the poses of a cell."""
    n = lat.nt * lat.nz * lat.nx
    return Fresh(
        np.empty(n, np.int32), np.empty(n, np.float32), np.empty(n, np.float32),
        np.empty(n, np.float32), np.empty(n, np.float32), np.empty(n, np.float32),
        np.empty(n, np.uint8), np.empty(n, np.bool_),
    )  # fmt: skip


@leaf
def _wider(
    w: World, cells: Cells, c: int, lo: int, hi: int, result: Bytes, width: Bytes, fresh: Fresh
) -> int:
    """Fill `fresh` with possible poses in [lo, hi) where `result` is above `width`; how many."""
    lat = w.lat
    i, j = cells.front[c], cells.rear[c]
    left, down = cells.x0[c] * lat.step - w.centres[i, 0], cells.z0[c] * lat.step - w.centres[i, 1]
    mass, share = np.float32(1.0 / w.robot.mass), np.float32(w.robot.trunk_mass / w.robot.mass)
    carried = mass * (w.front_table.carried[i] + w.rear_table.carried[j])
    step, x_first = np.float32(lat.step), np.float32(cells.x0[c] * lat.step)
    front, rear, trunk = w.front_table.possible, w.rear_table.possible, w.trunk.possible
    page = lat.row * (lat.nz + 4)
    count = 0
    for t in range(max(0, lo // page - 2), min(lat.nt, hi // page - 1)):
        tt = cells.t0[c] + t
        pitch = (tt - lat.pitches // 2) * lat.turn
        cos, sin = math.cos(pitch), math.sin(pitch)
        fz, rz, tz, sf, sr, st, low, high = table_rows(w, cells, c, t)
        front_moments, fu, fv = moments(w.front_table, i, tt, sf, fz)
        rear_moments, ru, rv = moments(w.rear_table, j, tt, sr, rz)
        for z in range(low, high):
            k = row_start(lat, t, z)
            possible = shifted(front[i, tt, fz + z], sf) & shifted(rear[j, tt, rz + z], sr)
            possible &= trunk[tt, tz + z, st]
            if possible == 0:
                continue
            a, b = max(lo - k, 0), min(hi - k, lat.nx)
            if a >= b:
                continue
            fm, rm = front_moments[fv + z], rear_moments[rv + z]
            possible &= between(a, b)
            while possible != 0:
                x = lowest(possible)
                possible &= possible - np.uint64(1)
                if result[k + x] > width[k + x]:
                    legs = carried + mass * (fm[fu + x] + rm[ru + x])
                    fresh.at[count] = k + x
                    fresh.com[count] = share * (x_first + np.float32(x) * step) + legs
                    fresh.x[count], fresh.z[count] = left + x * lat.step, down + z * lat.step
                    fresh.cos[count], fresh.sin[count] = cos, sin
                    count += 1
    return count


@leaf
def _grow(
    w: World, cells: Cells, v: Volumes, c: int, lo: int, hi: int, result: Bytes, fresh: Fresh
) -> bool:
    """Widen the ways to poses of cell `c` to what `result` holds in [lo, hi); True if any grew."""
    i, j = cells.front[c], cells.rear[c]
    width = v.width[v.slot[c]]
    n = _wider(w, cells, c, lo, hi, result, width, fresh)
    quality(cells.spans[c], w.com, fresh.com[:n], fresh.width[:n])
    changed, count = False, 0
    for k in range(n):
        at = fresh.at[k]
        least = min(fresh.width[k], result[at])
        if least <= width[at]:
            continue
        if width[at] > 0:
            width[at] = least
            v.best[c] = max(v.best[c], least)
            changed = True
            continue
        fresh.at[count], fresh.width[count] = at, least
        fresh.x[count], fresh.z[count] = fresh.x[k], fresh.z[k]
        fresh.cos[count], fresh.sin[count] = fresh.cos[k], fresh.sin[k]
        count += 1
    if count == 0:
        return changed
    apart = (w.centres[j, 0] - w.centres[i, 0], w.centres[j, 1] - w.centres[i, 1])
    legs_clear(
        w.robot, w.front, w.rear, w.legs_gap, apart, fresh.x[:count], fresh.z[:count],
        fresh.cos[:count], fresh.sin[:count], fresh.clear[:count],
    )  # fmt: skip
    for k in range(count):
        at = fresh.at[k]
        if fresh.clear[k]:
            width[at] = fresh.width[k]
            v.best[c] = max(v.best[c], fresh.width[k])
            v.first[c] = min(v.first[c], at)
            v.last[c] = max(v.last[c], at + 1)
            changed = True
    return changed
