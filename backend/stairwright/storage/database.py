"""The SQLite file: opened with a write-ahead log, brought up to date by migrations."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from pathlib import Path
from typing import Any

from sqlalchemy import Engine, create_engine, event, inspect

from stairwright.errors import InputError

MIGRATIONS = Path(__file__).with_name("migrations")
BUSY_TIMEOUT = 5.0  # s that a writer waits for another one


def open_database(path: Path) -> Engine:
    """Open or create the database and migrate it.

    Raises:
        InputError: If the folder cannot be written, or the file is no database of ours.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot use the data folder {path.parent}: {error.strerror}") from None
    engine = create_engine(f"sqlite:///{path}", connect_args={"timeout": BUSY_TIMEOUT})

    @event.listens_for(engine, "connect")
    def configure(connection: Any, _: Any) -> None:
        cursor = connection.cursor()
        cursor.execute("PRAGMA journal_mode=WAL")
        cursor.execute("PRAGMA synchronous=NORMAL")  # safe with WAL against kill -9
        cursor.close()

    _migrate(engine)
    return engine


def newest_revision() -> str:
    """The revision that the code needs: migrations' files begin with theirs."""
    return max(path.name.split("_")[0] for path in (MIGRATIONS / "versions").glob("[0-9]*_*.py"))


def _is_current(engine: Engine) -> bool:
    """Whether nothing has to be migrated, found out without Alembic, which is slow to import."""
    with engine.connect() as connection:
        if not inspect(connection).has_table("alembic_version"):
            return False
        found = connection.exec_driver_sql("SELECT version_num FROM alembic_version").scalar()
        return bool(found == newest_revision())


def _migrate(engine: Engine) -> None:
    if _is_current(engine) or (_migrated_apart(engine) and _is_current(engine)):
        return
    _migrate_here(engine)


def _migrated_apart(engine: Engine) -> bool:
    """Migrate in a process that ends: Alembic takes memory that a service would never give back.

    Only where no other thread may hold a lock at the moment of the fork; False if it did not work.
    """
    if sys.platform != "linux" or threading.active_count() > 1:
        return False
    engine.dispose()
    child = os.fork()
    if child == 0:
        status = 1
        with contextlib.suppress(Exception):  # the service meets it again and says what it is
            _migrate_here(engine)
            status = 0
        os._exit(status)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def _migrate_here(engine: Engine) -> None:
    from alembic import command  # takes a while to import
    from alembic.config import Config
    from alembic.runtime.migration import MigrationContext
    from alembic.script import ScriptDirectory

    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    scripts = ScriptDirectory.from_config(config)
    newest = scripts.get_current_head()
    with engine.connect() as connection:
        # One process migrates; another that starts meanwhile waits here and finds it done.
        connection.exec_driver_sql("BEGIN IMMEDIATE")
        found = MigrationContext.configure(connection).get_current_revision()
        if found and found not in {script.revision for script in scripts.walk_revisions()}:
            raise InputError(
                f"{engine.url.database} was written by a newer Stairwright ({found}, this one "
                f"knows {newest}): install that one again, or use another folder"
            )
        if found != newest:
            config.attributes["connection"] = connection
            command.upgrade(config, "head")
        connection.commit()
    assert inspect(engine).has_table("documents")
