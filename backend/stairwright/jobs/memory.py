"""Memory that is free inside a process, and that the system could have."""

from __future__ import annotations

import contextlib
import ctypes


def give_memory_back() -> None:
    """Return to the system what the C library keeps for the next need; a matter of milliseconds.

    While tasks come one after another that is better kept: asking for it again takes longer than
    some plans. Where the C library is not glibc, nothing happens.
    """
    with contextlib.suppress(AttributeError):
        ctypes.CDLL(None).malloc_trim(0)
