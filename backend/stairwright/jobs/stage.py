"""What the process that workers are forked from is at, as a line in a file.

It starts long before it can be asked anything.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

VARIABLE = "STAIRWRIGHT_STAGE_FILE"
_LENGTH = 200  # bytes, written at once, so that no reader finds half a line


class Stage:
    """A line that one process writes and another reads; None of both without a file."""

    def __init__(self, path: Path | None) -> None:
        self.path = path

    @classmethod
    def create(cls) -> Stage:
        """A new one, which processes started from now on find; to be closed."""
        handle, name = tempfile.mkstemp(prefix="stairwright-stage-")
        os.close(handle)
        os.environ[VARIABLE] = name
        return cls(Path(name))

    @classmethod
    def inherited(cls) -> Stage:
        """The one of the process that started this one."""
        name = os.environ.get(VARIABLE)
        return cls(Path(name) if name else None)

    def tell(self, text: str) -> None:
        """Say what is being done."""
        if self.path is None:
            return
        # Never made anew when nobody listens any more; on a full disk work goes before words.
        with contextlib.suppress(OSError), self.path.open("r+b") as file:
            file.write(text.encode("ascii", "replace")[:_LENGTH].ljust(_LENGTH))

    def text(self) -> str:
        """What was said last."""
        with contextlib.suppress(OSError):
            return "" if self.path is None else self.path.read_text(encoding="ascii").strip()
        return ""

    def close(self) -> None:
        """Nobody wants to know any more."""
        if self.path is not None:
            self.path.unlink(missing_ok=True)
