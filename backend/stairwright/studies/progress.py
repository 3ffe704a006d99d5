"""Finished cells on their way: told as they come, written down every so often."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from .serial import Finished
from .store import ResultStore
from .variables import Record

WRITE_EVERY = 2.0  # s


@dataclass(frozen=True)
class Progress:
    """How far a study is.

    Attributes:
        done: Cells whose state is known.
        total: Cells that are to be known in the end; of boundaries, as far as can be told.
        spent: Time since this process began with it [s].
        left: Remaining time [s], None while it cannot be told.
        new: What is new since the last report.
    """

    done: int
    total: int
    spent: float
    left: float | None
    new: Finished


Report = Callable[[Progress], None]


class Meter:
    """Makes reports of finished cells; the remaining time follows from this run's own pace."""

    def __init__(self, done: int, total: int, report: Report | None) -> None:
        self.done, self.total = done, total
        self._report = report
        self._begun, self._before = time.monotonic(), done

    def tell(self, new: Finished) -> None:
        """Report finished cells."""
        self.done += len(new)
        self.total = max(self.total, self.done)
        if self._report is not None:
            spent = time.monotonic() - self._begun
            pace = (self.done - self._before) / spent if spent > 0.0 else 0.0
            left = (self.total - self.done) / pace if pace > 0.0 else None
            self._report(Progress(self.done, self.total, spent, left, new))


class Writer:
    """Writes cells down every so often: a write costs about 20 ms however few they are."""

    def __init__(self, store: ResultStore) -> None:
        self._store = store
        self._held: dict[int, Record] = {}
        self._written = time.monotonic()

    def __enter__(self) -> Writer:
        return self

    def __exit__(self, *_: object) -> None:
        self.flush()

    def add(self, finished: Finished) -> None:
        """Take in finished cells."""
        self._held.update(finished)
        if time.monotonic() - self._written >= WRITE_EVERY:
            self.flush()

    def flush(self) -> None:
        """Write what is held."""
        self._store.write(self._held)
        self._held, self._written = {}, time.monotonic()
