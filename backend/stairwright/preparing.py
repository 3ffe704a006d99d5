"""What the first use on a machine waits for, told to whoever waits.

Kernels that were not compiled at set-up are compiled at their first use, and kept.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

_listeners: list[Callable[[int], None]] = []
_compiled: list[str] = []


def compiled(name: str) -> None:
    """Called when a kernel was compiled."""
    _compiled.append(name)
    for listener in _listeners:
        listener(len(_compiled))


def count() -> int:
    """How many kernels this process has compiled so far."""
    return len(_compiled)


def listen(listener: Callable[[int], None]) -> None:
    """Have `listener` called with the number of kernels that are compiled, after each."""
    _listeners.append(listener)


class Teller:
    """Tells a person on stderr: once at the beginning, then now and then."""

    def __init__(self, every: float = 5.0) -> None:
        self._every = every  # s
        self._begun = self._last = 0.0

    def __call__(self, count: int) -> None:
        """Say how far it is."""
        now = time.monotonic()
        if not self._begun:
            self._begun = self._last = now
            _say("compiling for this machine; this happens once and takes a minute or two")
        elif now - self._last >= self._every:
            self._last = now
            _say(f"compiling: {count} functions in {now - self._begun:.0f} s so far")


def _say(text: str) -> None:
    print(f"stairwright: {text}", file=sys.stderr, flush=True)
