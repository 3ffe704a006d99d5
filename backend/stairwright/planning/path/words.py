"""A row of the lattice as one word: a bit tells whether its column is possible."""

from __future__ import annotations

import numba as nb
import numpy as np
from numba.cpython.unsafe.numbers import trailing_zeros

WORD = 64  # columns that one word tells of


@nb.njit(cache=True)
def shifted(word: np.uint64, by: int) -> np.uint64:
    """A word whose bit k is bit k + by of `word`, 0 where that has none."""
    if abs(by) >= WORD:
        return np.uint64(0)
    return word >> np.uint64(by) if by >= 0 else word << np.uint64(-by)


@nb.njit(cache=True)
def between(low: int, high: int) -> np.uint64:
    """A word whose bits `low` to `high` (excluded, less than `WORD`) are set."""
    one = np.uint64(1)
    return (one << np.uint64(high)) - (one << np.uint64(low))


@nb.njit(cache=True)
def lowest(word: np.uint64) -> np.int64:
    """Which is the lowest bit that is set in `word`, which is not 0."""
    return np.int64(trailing_zeros(word))  # type: ignore[call-arg]
