"""How many cells make a batch: about two seconds' worth, from what cells took so far."""

from __future__ import annotations

import math
import time

TARGET = 2.0  # s of a batch
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
        seconds = min(TARGET, max(FIRST, passed / 2))
        size = max(1, round(seconds / max(self.typical, 1e-6)))
        even = math.ceil(left / (2 * max(1, workers)))
        return max(1, min(size, even, MOST))
