"""What the process that workers are forked from is at, as a line in a file.

It starts long before it can be asked anything.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
import weakref
from pathlib import Path

VARIABLE = "STAIRWRIGHT_STAGE_FILE"


class Stage:
    """A line that one process writes and another reads; None of both without a file."""

    def __init__(self, path: Path | None) -> None:
        self.path = path

    @classmethod
    def create(cls) -> Stage:
        """A new one, which processes started from now on find; its file goes with the object."""
        handle, name = tempfile.mkstemp(prefix="stairwright-stage-")
        os.close(handle)
        os.environ[VARIABLE] = name
        stage = cls(Path(name))
        weakref.finalize(stage, Path(name).unlink, missing_ok=True)
        return stage

    @classmethod
    def inherited(cls) -> Stage:
        """The one of the process that started this one."""
        name = os.environ.get(VARIABLE)
        return cls(Path(name) if name else None)

    def tell(self, text: str) -> None:
        """Say what is being done."""
        if self.path is None or not self.path.exists():
            return  # nobody listens (any more)
        partial = self.path.with_name(f"{self.path.name}.{os.getpid()}")
        with contextlib.suppress(OSError):  # a full disk: work is more important than words
            partial.write_text(text, encoding="utf-8")
            partial.replace(self.path)

    def text(self) -> str:
        """What was said last."""
        with contextlib.suppress(OSError):
            return "" if self.path is None else self.path.read_text(encoding="utf-8")
        return ""
