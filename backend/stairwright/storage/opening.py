"""Opening the database on a bad day: damaged, on a full disk, in a folder that is read-only.

A damaged file is set aside, never removed, and what can be read of it is taken over. Where nothing
can be written, the service reads a copy in memory: what is stored stays in reach.
"""

from __future__ import annotations

import errno
import logging
import os
import shutil
import sqlite3
import tempfile
import weakref
from pathlib import Path
from typing import Any

from sqlalchemy import Engine, create_engine, event
from sqlalchemy.exc import DatabaseError
from sqlalchemy.pool import QueuePool

from stairwright.errors import InputError

from .database import BUSY_TIMEOUT, open_database
from .salvage import salvage, set_aside

logger = logging.getLogger(__name__)

_DAMAGED = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
_UNWRITABLE = (
    sqlite3.SQLITE_READONLY,
    sqlite3.SQLITE_IOERR,
    sqlite3.SQLITE_CANTOPEN,
    sqlite3.SQLITE_FULL,
    sqlite3.SQLITE_PERM,
)
_FULL = (errno.ENOSPC, errno.EDQUOT)
_PROBE = bytes(65536)  # about what the smallest result takes
_MEMORY = "file:stairwright-{}?mode=memory&cache=shared"


def open_soundly(path: Path) -> tuple[Engine, str | None]:
    """The database, and in one sentence why nothing can be saved; None if it can.

    Raises:
        InputError: If another program holds it, or it comes from a newer version of this one.
    """
    try:
        engine = _open(path)
        _try_to_write(engine, path)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"the data folder {path.parent} is no folder") from None
    except (DatabaseError, OSError) as error:
        reason = _why_unwritable(error, path.parent)
        if reason is None:
            raise InputError(f"the database {path} cannot be used: {_cause(error)}") from error
        return _copy_in_memory(path), reason
    return engine, None


def is_damage(error: BaseException) -> bool:
    """Whether SQLite says that the file itself is at fault."""
    return _code(error) in _DAMAGED


def _code(error: BaseException) -> int:
    origin = error.orig if isinstance(error, DatabaseError) else error
    return getattr(origin, "sqlite_errorcode", 0) & 0xFF


def _cause(error: BaseException) -> object:
    return error.orig if isinstance(error, DatabaseError) else error


def _open(path: Path, *, copied: bool = False) -> Engine:
    """Open, migrate and check it; a damaged one is set aside for a new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    engine: Engine | None = None
    try:
        engine = open_database(path)
        with engine.connect() as connection:
            verdict = connection.exec_driver_sql("PRAGMA quick_check(1)").scalar()
        if verdict == "ok":
            return engine
        logger.error("the database %s is damaged: %s", path, " ".join(str(verdict).split()))
    except DatabaseError as error:
        if not is_damage(error):
            raise
        logger.error("the database %s is damaged: %s", path, _cause(error))
    if engine is not None:
        engine.dispose()
    _write_something(path.parent)  # or else the new one could not be made, with the old one gone
    kept = set_aside(path)
    engine = open_database(path)
    taken = salvage(kept, engine)
    found = ", ".join(f"{count} {name}" for name, count in taken.items() if count) or "nothing"
    if copied:
        logger.error("%s could be read from the damaged database, which stays where it is", found)
    else:
        logger.error(
            "the damaged database is kept as %s; %s could be read from it and is in the new one; "
            "for the rest stop the service and restore a backup",
            kept,
            found,
        )
    return engine


def _try_to_write(engine: Engine, path: Path) -> None:
    """Save nothing, but all the way to the disk."""
    with engine.begin() as connection:
        connection.exec_driver_sql("BEGIN IMMEDIATE")
        connection.exec_driver_sql("PRAGMA user_version = 0")
    folder = path.parent / "artefacts"
    folder.mkdir(exist_ok=True)
    _write_something(folder)


def _write_something(folder: Path) -> None:
    with tempfile.TemporaryFile(dir=folder) as file:
        file.write(_PROBE)
        file.flush()
        os.fsync(file.fileno())


def _why_unwritable(error: DatabaseError | OSError, folder: Path) -> str | None:
    if not isinstance(error, OSError):
        if _code(error) not in _UNWRITABLE:
            return None
        try:
            _write_something(folder)  # the system says more clearly what SQLite only calls I/O
        except OSError as clearer:
            return _why_unwritable(clearer, folder)
    number, cause = 0, str(_cause(error))
    if isinstance(error, OSError):
        number, cause = error.errno or 0, error.strerror or cause
    cure = "free some space" if number in _FULL else "make it writable for this user"
    return (
        f"the data folder {folder} cannot be written ({cause}), so nothing is saved: "
        f"{cure}, or name another one in STAIRWRIGHT_DATA, and restart the service"
    )


def _copy_in_memory(path: Path) -> Engine:
    """What is in the database now, in memory, for reading only."""
    with tempfile.TemporaryDirectory(prefix="stairwright-", dir=_somewhere()) as folder:
        copy = Path(folder) / path.name
        for suffix in ("", "-wal"):  # what was saved last is in the log still
            source = path.with_name(path.name + suffix)
            try:
                shutil.copyfile(source, copy.with_name(copy.name + suffix))
            except FileNotFoundError:
                continue
            except OSError as error:
                logger.error("%s cannot be read: %s", source, error.strerror)
                break
        engine = _open(copy, copied=True)
        address = _MEMORY.format(os.path.basename(folder))  # noqa: PTH119 - a name, not a path
        keeper = sqlite3.connect(address, uri=True, check_same_thread=False)
        with engine.connect() as connection:
            original: Any = connection.connection.driver_connection
            original.backup(keeper)
        engine.dispose()

    def connect() -> sqlite3.Connection:
        return sqlite3.connect(address, BUSY_TIMEOUT, uri=True, check_same_thread=False)

    memory = create_engine("sqlite://", creator=connect, poolclass=QueuePool)
    weakref.finalize(memory, keeper.close)  # the memory lasts as long as a connection to it

    @event.listens_for(memory, "connect")
    def configure(connection: Any, _: Any) -> None:
        connection.execute("PRAGMA query_only = ON")

    return memory


def _somewhere() -> str:
    """A folder for a moment; in memory where there is such a one, since disks may be full."""
    for folder in ("/dev/shm", tempfile.gettempdir()):  # noqa: S108 - a folder of our own in it
        if os.access(folder, os.W_OK | os.X_OK):
            return folder
    raise InputError("there is no folder for temporary files: name one in TMPDIR")
