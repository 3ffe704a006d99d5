"""Memory that is free inside a process, and that the system could have."""

from __future__ import annotations

import contextlib
import ctypes

from stairwright.resources import resident_memory

AMPLE = 512 << 20  # bytes of a worker that keeps memory between plans


def give_memory_back() -> None:
    """Return to the system what the C library keeps for the next need; a matter of milliseconds.

    While tasks come one after another that is better kept: asking for it again takes longer than
    some plans. Where the C library is not glibc, nothing happens.
    """
    with contextlib.suppress(AttributeError):
        ctypes.CDLL(None).malloc_trim(0)


def keep_no_more_than(most: int) -> None:
    """Give memory back where this process has more than `most` bytes resident; cheap to ask.

    A refusal of a large robot on high stairs takes up to 1 GB, of which threads' shares of the heap
    keep most: a worker of a cluster grew to 2.2 GB. Where there is no /proc, nothing happens.
    """
    if resident_memory() > most:
        give_memory_back()
