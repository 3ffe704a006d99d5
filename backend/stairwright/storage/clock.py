"""Time as the store needs it: an order of uses that no change of the system's clock upsets.

A robot's computer often has no battery for its clock: it starts in 1970, or 100 days ahead, and is
put right later. So nothing is removed for its age, and "last used" is counted on a clock of the
store's own, which only ever goes forward.
"""

from __future__ import annotations

import time
from pathlib import Path

LEAST_JUMP = 60.0  # s; smaller steps are what keeping a clock right looks like
LONG_UNUSED = 30 * 86400.0  # s; after this either the machine was off or its clock is wrong
_DAY = 86400.0  # s
_STEADY = getattr(time, "CLOCK_BOOTTIME", time.CLOCK_MONOTONIC)  # goes on while the machine sleeps


class UseClock:
    """Seconds since 1970, unless the system's clock is behind what it was: then later ones."""

    def __init__(self, newest: float) -> None:
        """`newest` is the latest time that was ever written down [s]."""
        self._ahead = max(time.time(), newest) - time.monotonic()

    def now(self) -> float:
        """Later than all that was written down before [s]."""
        return self._ahead + time.monotonic()


class ClockWatch:
    """Notices when the system's clock is set while the service runs."""

    def __init__(self) -> None:
        self._offset = _offset()

    def jump(self) -> float:
        """Seconds that the clock was set forward (below 0: back) since the last look, or 0."""
        before, self._offset = self._offset, _offset()
        change = self._offset - before
        return change if abs(change) >= LEAST_JUMP else 0.0


def _offset() -> float:
    return time.time() - time.clock_gettime(_STEADY)


def last_written(database: Path) -> float | None:
    """When the database was last written, by the clock of that time; None if there is none."""
    files = (database, database.with_name(f"{database.name}-wal"))
    return max((file.stat().st_mtime for file in files if file.is_file()), default=None)


def doubt(last: float | None) -> str | None:
    """What is odd about the clock, given when the data was last written; None if nothing is."""
    if last is None:
        return None
    ahead = time.time() - last
    if ahead < -LEAST_JUMP:
        return f"the clock is {duration(-ahead)} behind the last use of the data folder"
    if ahead > LONG_UNUSED:
        return f"the data folder was last used {duration(ahead)} ago, if the clock is right"
    return None


def duration(seconds: float) -> str:
    """For people."""
    return f"{seconds / _DAY:.0f} days" if seconds >= 2 * _DAY else f"{seconds:.0f} s"
