"""What this machine has: where data lies that ships with the program or is its user's; cores; how
much memory this process uses.
"""

from __future__ import annotations

import mmap
import os
import sys
from pathlib import Path

from .errors import InputError

_PACKAGE = Path(__file__).resolve().parent


def data_folder(name: str) -> Path:
    """A folder (``terrains``, ``robots``, ``native``) of the checkout or of the installed wheel."""
    shipped = _PACKAGE / "data" / name
    return shipped if shipped.is_dir() else _PACKAGE.parents[1] / name


def checkout() -> Path | None:
    """The checkout in whose own environment, the one of `./dev`, this runs; None elsewhere."""
    root = _PACKAGE.parents[1]
    ours = (root / "dev").is_file() and Path(sys.prefix).resolve() == root / ".venv"
    return root if ours else None


def default_data_folder() -> Path:
    """Where this platform keeps a user's data, or systemd a service's.

    Raises:
        InputError: If this user has no home, as users of services often do.
    """
    state = os.environ.get("STATE_DIRECTORY", "").split(":")[0]
    if state:
        return Path(state)
    try:
        home = Path.home()
    except RuntimeError:
        raise InputError(
            "this user has no home folder: name a folder for the data in STAIRWRIGHT_DATA"
        ) from None
    if sys.platform == "darwin":
        return home / "Library" / "Application Support" / "stairwright"
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local") / "stairwright"
    return Path(os.environ.get("XDG_DATA_HOME") or home / ".local" / "share") / "stairwright"


def all_cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def address_space() -> int:
    """Bytes of address space in use now; where no /proc tells, a guess on the high side."""
    return _statm(0, otherwise=2 * 2**30)


def resident_memory() -> int:
    """Bytes of memory in use now; 0 where no /proc tells."""
    return _statm(1, otherwise=0)


def _statm(column: int, otherwise: int) -> int:
    try:
        with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123
            return int(file.read().split()[column]) * mmap.PAGESIZE
    except OSError:
        return otherwise
