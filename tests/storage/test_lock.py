"""One server a data folder."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from stairwright.errors import InputError
from stairwright.storage.lock import FolderLock


def test_a_second_holder_is_told_who_has_it(tmp_path: Path) -> None:
    first = FolderLock(tmp_path)
    with pytest.raises(InputError, match=r"another server \(process [0-9]+\)") as refused:
        FolderLock(tmp_path, patience=0.1)
    assert "STAIRWRIGHT_DATA" in str(refused.value)
    first.release()
    FolderLock(tmp_path, patience=0.1).release()


def test_a_holder_that_was_killed_holds_nothing(tmp_path: Path) -> None:
    code = f"""
from pathlib import Path
from stairwright.storage.lock import FolderLock
lock = FolderLock(Path({str(tmp_path)!r}))
print("held", flush=True)
input()
"""
    with subprocess.Popen([sys.executable, "-c", code], stdin=-1, stdout=-1) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == b"held\n"
        with pytest.raises(InputError):
            FolderLock(tmp_path, patience=0.1)
        holder.kill()
        holder.wait()
        FolderLock(tmp_path, patience=5.0).release()
