"""The series of a rollout that is still running: out of its worker through a file, line by line.

A worker appends, whoever watches reads on from where it was: neither waits for the other, and
every watcher sees each sample once.
"""

from __future__ import annotations

import os
import tempfile
import time
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import orjson

if TYPE_CHECKING:
    from stairwright.simulation.record import Recorder

EVERY = 0.1  # s of wall time between chunks
STRIDE = 4  # of the recorded samples, at 100 Hz, one in so many is sent
DIGITS = 5  # decimals: what can be seen
NAMES = ("time", "pitch", "pitch_desired", "progress", "q", "q_desired", "base_position",
         "base_quaternion")  # fmt: skip


class LiveSeries:
    """The file of one run; it goes when nobody holds this object any more."""

    def __init__(self) -> None:
        with tempfile.NamedTemporaryFile(prefix="stairwright-live-", delete=False) as file:
            self.path = file.name
        weakref.finalize(self, Path(self.path).unlink, missing_ok=True)

    def after(self, offset: int) -> tuple[list[bytes], int]:
        """Chunks, as JSON, that were written after `offset` bytes, and the offset behind them."""
        with Path(self.path).open("rb") as file:
            file.seek(offset)
            complete, newline, _ = file.read().rpartition(b"\n")
        if not newline:
            return [], offset
        return complete.split(b"\n"), offset + len(complete) + 1


class Broadcast:
    """Called again and again by who rolls out with the record so far; sends what is new."""

    def __init__(self, send: Callable[[bytes], None], every: float = EVERY) -> None:
        """`send` takes a chunk, a line of JSON; at most one in `every` [s]."""
        self._send = send
        self._every = every
        self._next = 0  # the first sample, of those recorded, that was not sent yet
        self._sent = -every

    def __call__(self, recorder: Recorder) -> None:
        """Send a chunk if it is time for one."""
        now = time.monotonic()
        if now - self._sent < self._every or len(recorder) <= self._next:
            return
        self._sent = now
        series = recorder.series(self._next, STRIDE)
        if not len(series.time):  # what follows is not finite
            return
        chunk: dict[str, Any] = {"from": self._next // STRIDE}
        for name in NAMES:
            chunk[name] = np.round(getattr(series, name), DIGITS)
        self._next += STRIDE * len(chunk["time"])
        self._send(orjson.dumps(chunk, option=orjson.OPT_SERIALIZE_NUMPY) + b"\n")


def append(path: str, line: bytes) -> None:
    """Write a chunk to the file of a `LiveSeries`, at once and whole."""
    handle = os.open(path, os.O_WRONLY | os.O_APPEND)
    try:
        os.write(handle, line)
    finally:
        os.close(handle)
