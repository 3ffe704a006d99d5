"""How far a study or a search for designs is, and how long the rest takes."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .serial import Finished


@dataclass(frozen=True)
class Progress:
    """How far a study is, counted in cells, or a search, counted in designs.

    Attributes:
        done: Cells whose state is known; designs that were tried, a whole generation at a time.
        total: That are to be known in the end; of boundaries, as far as can be told.
        left: Remaining time [s], None while it cannot be told.
        partly: Of those that are at work, how many their work so far makes.
        new: Cells since the last report.
    """

    done: int
    total: int
    left: float | None = None
    partly: float = 0.0
    new: Finished = field(default_factory=dict)

    @property
    def share(self) -> float:
        """Of all the work, 0..1."""
        return (self.done + self.partly) / self.total if self.total else 0.0


Report = Callable[[Progress], None]


class Pace:
    """How long the rest takes at a run's own pace; what was known before it took none."""

    def __init__(self, done: int) -> None:
        self._begun, self._before = time.monotonic(), done

    def left(self, done: float, total: int) -> float | None:
        """Remaining time [s], None while it cannot be told."""
        own = done - self._before
        return (time.monotonic() - self._begun) * (total - done) / own if own > 0.0 else None


class Meter:
    """Makes reports of finished cells."""

    def __init__(self, done: int, total: int, report: Report | None) -> None:
        self.done, self.total = done, total
        self._report, self._pace = report, Pace(done)

    def tell(self, new: Finished) -> None:
        """Report finished cells."""
        self.done += len(new)
        self.total = max(self.total, self.done)
        if self._report is not None:
            left = self._pace.left(self.done, self.total)
            self._report(Progress(self.done, self.total, left, new=new))
