"""How long a worker was at a task, and what became of it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from .failures import problem_of

Observer = Callable[[float, str], None]  # seconds; "done", or the kind of the problem


def ignore(_seconds: float, _outcome: str) -> None:
    """The observer where nobody wants to know."""


class Stopwatch:
    """Runs from `start` to the end of `measured`."""

    def __init__(self) -> None:
        self._begun: float | None = None

    def start(self) -> None:
        """A worker has the task."""
        self._begun = time.monotonic()

    @contextmanager
    def measured(self, observe: Observer) -> Iterator[None]:
        """Tell the observer when the block ends, if it was started in it."""
        outcome = "done"
        try:
            yield
        except asyncio.CancelledError:
            outcome = "cancelled"
            raise
        except Exception as error:
            outcome = str(problem_of(error)["type"]).rpartition(":")[2]
            raise
        finally:
            if self._begun is not None:
                observe(time.monotonic() - self._begun, outcome)
