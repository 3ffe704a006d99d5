"""One server a data folder: two would take each other's jobs for those of one that has died.

The system itself lets go of the lock when its holder ends, however that comes about.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import logging
import os
import time
from pathlib import Path

from stairwright.errors import InputError

LOCK = "stairwright.lock"
PATIENCE = 5.0  # s for a server that is just ending, as in a quick restart
_LOOK_EVERY = 0.05  # s
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL)

logger = logging.getLogger(__name__)


class FolderLock:
    """Held from the start until `release`, or until the process ends.

    A folder that cannot be written, or a file system without locks, is used without one.

    Raises:
        InputError: If another process holds it still after `patience` [s].
    """

    def __init__(self, folder: Path, patience: float = PATIENCE) -> None:
        self._handle: int | None = None
        try:
            folder.mkdir(parents=True, exist_ok=True)
            # Not inherited by workers, which may outlive this process for a moment.
            handle = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        except OSError:
            return  # opening the database will say what is wrong
        try:
            self._lock(handle, folder, patience)
        except BaseException:
            os.close(handle)
            raise
        self._handle = handle

    def _lock(self, handle: int, folder: Path, patience: float) -> None:
        give_up = time.monotonic() + patience
        while True:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                if time.monotonic() >= give_up:
                    raise InputError(_refusal(handle, folder)) from None
                time.sleep(_LOOK_EVERY)
            except OSError as error:
                if error.errno not in _NO_LOCKS:
                    raise
                logger.warning("no locks in %s: make sure that no other server uses it", folder)
                return
            else:
                with contextlib.suppress(OSError):  # a full disk: the number is for people only
                    os.ftruncate(handle, 0)
                    os.pwrite(handle, f"{os.getpid()}\n".encode(), 0)
                return

    def release(self) -> None:
        """Let the next one have the folder; nothing happens the second time."""
        if self._handle is not None:
            os.close(self._handle)
            self._handle = None


def _refusal(handle: int, folder: Path) -> str:
    holder = os.pread(handle, 20, 0).decode("ascii", "replace").strip()
    who = f"another server (process {holder})" if holder.isdigit() else "another server"
    return (
        f"{who} uses the data folder {folder}: stop it first, "
        "or give this one a folder of its own in STAIRWRIGHT_DATA"
    )
