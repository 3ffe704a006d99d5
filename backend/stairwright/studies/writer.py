"""Finished cells are written down every so often."""

from __future__ import annotations

import time

from .serial import Finished
from .store import ResultStore
from .variables import Record

WRITE_EVERY = 2.0  # s


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
