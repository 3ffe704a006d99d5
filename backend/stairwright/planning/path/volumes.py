"""The volumes of the search's cells: their memory, and how they lie against each other."""

from __future__ import annotations

import threading
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

from .cells import Cells, volume_size
from .kernels import shift
from .tables import Floats32, Lattice

Ints = NDArray[np.int32]
Bytes = NDArray[np.uint8]

_KEPT = 64_000_000  # bytes of an array that is kept for the next search of this thread


@leaf
def offset(cells: Cells, lat: Lattice, c: int, p: int) -> int:
    """Flat shift from a pose's place in cell `c` to its place in cell `p`."""
    return shift(
        lat, cells.t0[c] - cells.t0[p], cells.z0[c] - cells.z0[p], cells.x0[c] - cells.x0[p]
    )


class Volumes(NamedTuple):
    """Volumes of the cells that are entered, in the order in which they are.

    Attributes:
        slot: (n,) row of a cell in the arrays below, -1 where there is none.
        used: (1,) rows used.
        width: (rows, volume) least quality (see `cells.quality`) on the best way to a pose, 0 where
            there is none.
        value: (rows, volume) cost of the cheapest way.
        first, last: (n,) range of positions in `width` that are reached; first >= last: none are.
        best: (n,) largest width of a cell.
        low, high: (n,) the same range for `value`.
    """

    slot: Ints
    used: Ints
    width: Bytes
    value: Floats32
    first: Ints
    last: Ints
    best: Bytes
    low: Ints
    high: Ints


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


def make_volumes(n: int, lat: Lattice) -> Volumes:
    """Empty volumes for `n` cells; they share memory with earlier ones of this thread."""
    size = volume_size(lat)
    return Volumes(
        np.full(n, -1, np.int32), np.zeros(1, np.int32),
        _array("width", n, size, np.uint8),
        _array("value", n, size, np.float32),
        np.full(n, size, np.int32), np.zeros(n, np.int32), np.zeros(n, np.uint8),
        np.full(n, size, np.int32), np.zeros(n, np.int32),
    )  # fmt: skip
