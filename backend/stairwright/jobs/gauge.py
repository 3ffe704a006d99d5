"""Progress out of a worker and the wish to cancel into it, over 16 bytes of shared memory.

No lock and no pipe: whichever side dies at whatever moment, the other one is not held up.
"""

from __future__ import annotations

import mmap
import struct
import tempfile
import weakref
from pathlib import Path

from stairwright.errors import Cancelled

_PROGRESS = struct.Struct("=d")
_SIZE, _CANCEL = 16, 8  # bytes; offset of the flag


class Gauge:
    """One task's gauge; both sides open it by its path."""

    def __init__(self, path: str) -> None:
        self.path = path
        with Path(path).open("r+b") as file:
            self._memory = mmap.mmap(file.fileno(), _SIZE)

    @classmethod
    def create(cls) -> Gauge:
        """A new one at zero; its file goes when the object goes."""
        with tempfile.NamedTemporaryFile(prefix="stairwright-", delete=False) as file:
            file.write(bytes(_SIZE))
        gauge = cls(file.name)
        weakref.finalize(gauge, Path(file.name).unlink, missing_ok=True)
        return gauge

    def report(self, progress: float) -> None:
        """Called by the worker: how much is done, 0..1.

        Raises:
            Cancelled: If the other side wants the work stopped.
        """
        _PROGRESS.pack_into(self._memory, 0, min(1.0, max(0.0, progress)))
        if self._memory[_CANCEL]:
            raise Cancelled("cancelled")

    @property
    def progress(self) -> float:
        """What was reported last."""
        return float(_PROGRESS.unpack_from(self._memory, 0)[0])

    def cancel(self) -> None:
        """Ask the worker to stop at its next report."""
        self._memory[_CANCEL] = 1
