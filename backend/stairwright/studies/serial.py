"""The plainest engine: one cell after the other, in this process."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Protocol

from .cell import evaluate
from .document import Study
from .grid import point
from .question import Questions
from .variables import Record

Finished = Mapping[int, Record]  # cells by number
Stopped = Callable[[], bool]
FIRST, BATCH = 0.5, 2.0  # s between two batches: the first ones, the others


class Engine(Protocol):
    """Whoever evaluates cells, here or elsewhere, in any order."""

    def evaluate(self, study: Study, cells: Sequence[int], stopped: Stopped) -> Iterator[Finished]:
        """Cells as they are done; ends early, without those that are left, once `stopped`."""

    def close(self) -> None:
        """End what it started."""


class SerialEngine:
    """Needs neither processes nor Dask; what the others must agree with."""

    def evaluate(self, study: Study, cells: Sequence[int], stopped: Stopped) -> Iterator[Finished]:
        """See `Engine`."""
        questions = Questions(study)
        done: dict[int, Record] = {}
        begun = since = time.monotonic()
        for cell in cells:
            if stopped():
                break
            done[cell] = evaluate(questions, point(study, cell))
            now = time.monotonic()
            if now - since >= min(BATCH, max(FIRST, (now - begun) / 4)):
                yield done
                done, since = {}, time.monotonic()
        if done:
            yield done

    def close(self) -> None:
        """Nothing was started."""
