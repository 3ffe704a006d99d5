"""Who is at what: a sheet of shared memory on which workers note the task that they carry out.

The pool's own way to cancel may hit a worker that has just gone on to the next task, which is then
lost. With the sheet a worker is killed only inside the task that was given up: whoever wants a task
dead writes so and then looks whether it runs; a worker about to leave a task writes that it leaves
and then looks whether it is wanted dead, in which case it waits for that.
"""

from __future__ import annotations

import contextlib
import mmap
import os
import signal
import struct
import tempfile
import time
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import Any

from stairwright.errors import Cancelled

_LINE = struct.Struct("=qq")  # the worker at it or 0; whether the task was given up
_LINES = 1024
_SIZE = _LINE.size * _LINES
_PATIENCE = 0.2  # s that a worker waits for the end that was announced to it


class Board:
    """The side of the pool: one line for each task under way."""

    def __init__(self) -> None:
        with tempfile.NamedTemporaryFile(prefix="stairwright-board-", delete=False) as file:
            file.write(bytes(_SIZE))
        self.path = file.name
        self._memory = _map(file.name)
        self._free = list(range(_LINES))
        weakref.finalize(self, Path(file.name).unlink, missing_ok=True)

    def take(self) -> int:
        """A line for a new task; it must be given back when the task is over."""
        line = self._free.pop()
        _LINE.pack_into(self._memory, line * _LINE.size, 0, 0)
        return line

    def give_back(self, line: int) -> None:
        """The task is over, one way or the other."""
        self._free.append(line)

    def give_up(self, line: int) -> None:
        """End the task: a worker that is at it dies, one that will come to it leaves it."""
        struct.pack_into("=q", self._memory, line * _LINE.size + 8, 1)
        worker, _ = _LINE.unpack_from(self._memory, line * _LINE.size)
        if worker:
            with contextlib.suppress(ProcessLookupError):  # it has died by itself
                os.kill(worker, signal.SIGKILL)


_sheet: mmap.mmap | None = None  # this worker's view of its pool's board


def read_board(path: str) -> None:
    """Called once by each worker."""
    global _sheet
    _sheet = _map(path)


def carry_out(line: int, function: Callable[..., Any], *args: Any) -> Any:
    """Called by a worker for each task.

    Raises:
        Cancelled: If the task was given up before it began or as it ended.
        Exception: Whatever the function raises.
    """
    assert _sheet is not None
    at = line * _LINE.size
    _leave_if_given_up(at, 0.0)
    struct.pack_into("=q", _sheet, at, os.getpid())
    try:
        _leave_if_given_up(at, _PATIENCE)
        return function(*args)
    finally:
        struct.pack_into("=q", _sheet, at, 0)
        _leave_if_given_up(at, _PATIENCE)


def _leave_if_given_up(at: int, patience: float) -> None:
    assert _sheet is not None
    if struct.unpack_from("=q", _sheet, at + 8)[0]:
        time.sleep(patience)
        raise Cancelled("nobody waits for this task any more")


def _map(path: str) -> mmap.mmap:
    with Path(path).open("r+b") as file:
        return mmap.mmap(file.fileno(), _SIZE)
