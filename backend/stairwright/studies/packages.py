"""The packages that studies need beyond the rest: which are missing, and how they come."""

from __future__ import annotations

import asyncio
import contextlib
import importlib
import os
import shlex
import signal
from importlib.util import find_spec

from stairwright.errors import InputError
from stairwright.jobs.failures import Failure
from stairwright.resources import checkout

NEEDED = ("cryptography", "distributed", "optuna", "xarray", "zarr")
INSTALLING = "installing what studies need, about 100 MB, once"
_LONGEST = 1800.0  # s that installing may take


def absent() -> list[str]:
    """Those that cannot be imported."""
    importlib.invalidate_caches()
    return [name for name in NEEDED if find_spec(name) is None]


def missing() -> str:
    """What to do about it, in a sentence."""
    command = "pip install 'stairwright[studies]'" if checkout() is None else "./dev studies"
    return (
        f"studies need a few more packages: {command} "
        "(xarray, Zarr, Dask distributed, Optuna; about 100 MB)"
    )


def check_packages() -> None:
    """Be sure that they are there.

    Raises:
        InputError: Says how to install them.
    """
    if names := absent():
        raise InputError(f"{missing()}; not there: {', '.join(names)}")


class NotInstalled(Failure):
    """They are missing, and cannot be installed."""

    status = 503
    kind = "missing"


class Installer:
    """Runs the command that installs them, for all who wait. Belongs to one event loop.

    Nobody stops it: packages that are half there would be worse than none.
    """

    def __init__(self, command: str) -> None:
        self._command = command
        self._task: asyncio.Task[None] | None = None

    def started(self) -> asyncio.Task[None]:
        """The installation: the one that is at work, or a new one.

        Its error is a `NotInstalled` with the last line of what the command said.
        """
        if self._task is None or self._task.done():
            self._task = asyncio.create_task(self._install())
        return self._task

    async def _install(self) -> None:
        try:
            process = await asyncio.create_subprocess_exec(
                *shlex.split(self._command),
                stdin=asyncio.subprocess.DEVNULL,
                stdout=asyncio.subprocess.PIPE,
                stderr=asyncio.subprocess.STDOUT,
                start_new_session=True,  # Ctrl-C is for the service
            )
        except (OSError, ValueError) as error:
            raise _not_installed(f"{self._command}: {error}") from None
        try:
            output, _ = await asyncio.wait_for(process.communicate(), _LONGEST)
        except TimeoutError:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            raise _not_installed(f"it took longer than {_LONGEST:.0f} s") from None
        if process.returncode != 0:
            lines = output.decode(errors="replace").strip().splitlines()
            raise _not_installed(lines[-1] if lines else f"exit status {process.returncode}")
        if names := absent():
            raise _not_installed(f"{', '.join(names)} are still not there")


def _not_installed(why: str) -> NotInstalled:
    plain = why.removeprefix("▸").strip()  # ./dev marks what it says itself
    return NotInstalled(f"what studies need cannot be installed: {plain}; the next one tries again")
