"""How many cells make a batch: two seconds' worth, by what they took so far; more for many workers.

A scheduler takes about 2 ms a batch: a thousand workers with batches of 2 s would keep it busy.
"""

from __future__ import annotations

import math
import time

TARGET = 2.0  # s of a batch, for a few workers
LONGEST = 5.0  # s, for many
_MANY = 500  # workers that have the longest batches
FIRST = 0.3  # s of the first ones: a picture should appear soon
MOST = 512  # cells
_SMOOTHING = 0.3  # weight of the newest batch in the running mean
IN_FLIGHT = 2  # batches a worker: one at work, one waiting


class BatchSizes:
    """Sizes for one run over many cells."""

    def __init__(self) -> None:
        self._begun = time.monotonic()
        self.typical: float | None = None  # s that a cell takes

    def learn(self, cells: int, seconds: float) -> None:
        """A batch has taken so long."""
        each = seconds / max(1, cells)
        before = each if self.typical is None else self.typical
        self.typical = before + _SMOOTHING * (each - before)

    def next(self, left: int, workers: int) -> int:
        """Cells of the next batch, where so many are left for so many workers.

        Towards the end batches shrink, so that all workers end together.
        """
        if self.typical is None:
            return 1
        passed = time.monotonic() - self._begun
        target = TARGET + (LONGEST - TARGET) * min(1.0, workers / _MANY)
        seconds = min(target, max(FIRST, passed / 2))
        size = max(1, round(seconds / max(self.typical, 1e-6)))
        even = math.ceil(left / (2 * max(1, workers)))
        return max(1, min(size, even, MOST))
