"""The volumes of the search's cells: their memory, and how they lie against each other."""

from __future__ import annotations

import threading
from typing import Any, NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

from .cells import Cells, volume_size
from .kernels import shift
from .tables import Floats32, Lattice

Ints = NDArray[np.int32]
Longs = NDArray[np.int64]
Bytes = NDArray[np.uint8]
Flags = NDArray[np.bool_]

_KEPT = 64_000_000  # bytes of an array that is kept for the next search of this thread


@leaf
def offset(cells: Cells, lat: Lattice, c: int, p: int) -> int:
    """Flat shift from a pose's place in cell `c` to its place in cell `p`."""
    return shift(
        lat, cells.t0[c] - cells.t0[p], cells.z0[c] - cells.z0[p], cells.x0[c] - cells.x0[p]
    )


class Sweeps(NamedTuple):
    """What has happened to cells: a sweep leaves out those to which nothing new leads.

    Attributes:
        clock: (1,) how often any cell was looked at.
        grown: (n,) the clock when a cell's volume last changed.
        seen: (n,) the clock when ways into a cell were last looked for, -1: never.
    """

    clock: Ints
    grown: Ints
    seen: Ints


class Volumes(NamedTuple):
    """Volumes of the cells that are entered, in the order in which they are.

    Attributes:
        slot: (n,) row of a cell in the arrays below, -1 where there is none.
        used: (1,) rows used.
        width: (rows, volume) least quality (see `cells.quality`) on the best way to a pose, 0 where
            there is none.
        first, last: (n,) range of positions in `width` that are reached; first >= last: none are.
        best: (n,) largest width of a cell.
        sweeps: Over the cells.
    """

    slot: Ints
    used: Ints
    width: Bytes
    first: Ints
    last: Ints
    best: Bytes
    sweeps: Sweeps


class Costs(NamedTuple):
    """Costs of the cheapest ways to poses that are wide enough, of all cells one after the other.

    Attributes:
        value: Flat; position k of cell c is at `base[c]` + k.
        base: (n,).
        first, last: (n,) range of positions for which there is room; first >= last: none are.
        low, high: (n,) range of those that have a value.
        sweeps: Over the cells.
    """

    value: Floats32
    base: Longs
    first: Ints
    last: Ints
    low: Ints
    high: Ints
    sweeps: Sweeps


_memory = threading.local()


def _array(name: str, rows: int, columns: int, kind: Any) -> NDArray[Any]:
    """An uninitialised (rows, columns) array; small ones are used again by later searches."""
    size = rows * columns
    if size * np.dtype(kind).itemsize > _KEPT:
        return np.empty((rows, columns), kind)
    kept: NDArray[Any] | None = getattr(_memory, name, None)
    if kept is None or kept.size < size:
        kept = np.empty(size, kind)
        setattr(_memory, name, kept)
    return kept[:size].reshape(rows, columns)


def _no_sweeps(n: int) -> Sweeps:
    return Sweeps(np.zeros(1, np.int32), np.zeros(n, np.int32), np.full(n, -1, np.int32))


def make_volumes(n: int, lat: Lattice) -> Volumes:
    """Empty volumes for `n` cells; they share memory with earlier ones of this thread."""
    size = volume_size(lat)
    return Volumes(
        np.full(n, -1, np.int32), np.zeros(1, np.int32),
        _array("width", n, size, np.uint8),
        np.full(n, size, np.int32), np.zeros(n, np.int32), np.zeros(n, np.uint8),
        _no_sweeps(n),
    )  # fmt: skip


def make_costs(v: Volumes, level: int, wanted: Flags) -> Costs:
    """No costs yet, with room for poses at least `level` wide of the `wanted` cells (n,)."""
    first, last = _wide(v, np.uint8(level), wanted)
    room = np.maximum(last - first, 0).astype(np.int64)
    base = np.cumsum(room) - room - first
    value = _array("value", 1, int(room.sum()), np.float32)[0]
    low, high = np.zeros_like(first), np.zeros_like(last)
    return Costs(value, base, first, last, low, high, _no_sweeps(len(first)))


@nb.njit(cache=True, nogil=True)
def leading_to(cells: Cells, v: Volumes, level: int, goal: int, moves: int) -> Flags:
    """Which cells (n,) have poses at least `level` wide and lead to `goal` through such cells."""
    least = np.uint8(level)
    out = np.zeros(len(v.best), np.bool_)
    out[goal] = v.best[goal] >= least
    changed = True
    while changed:
        changed = False
        for c in range(len(out) - 1, -1, -1):
            if not out[c]:
                continue
            for m in range(moves):
                p = cells.origin[c, m]
                if p >= 0 and not out[p] and v.best[p] >= least:
                    out[p] = True
                    changed |= p > c  # those before it are still to come
    return out


@nb.njit(cache=True, nogil=True)
def _wide(v: Volumes, level: np.uint8, wanted: Flags) -> tuple[Ints, Ints]:
    """Range (n,), (n,) of positions of each `wanted` cell that are at least `level` wide."""
    n = len(v.best)
    first, last = np.zeros(n, np.int32), np.zeros(n, np.int32)
    for c in np.flatnonzero(wanted):
        width, a, b = v.width[v.slot[c]], v.first[c], v.last[c]
        while width[a] < level:
            a += 1
        while width[b - 1] < level:
            b -= 1
        first[c], last[c] = a, b
    return first, last
