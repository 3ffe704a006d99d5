"""The service's side of `runner`: a child process that takes orders and reports."""

from __future__ import annotations

import asyncio
import contextlib
import sys
from collections.abc import AsyncIterator
from typing import Any

import orjson

_LONGEST = 64 * 2**20  # bytes of a report: a block of cells with their sentences
_COURTESY = 3.0  # s that it has to end by itself


class RunnerProcess:
    """One process; belongs to one event loop."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process

    @classmethod
    async def start(cls, workers: int, scheduler: str) -> RunnerProcess:
        """Start one.

        Raises:
            OSError: If the system has no room for it.
        """
        command = [sys.executable, "-m", "stairwright.studies.runner"]
        command += ["--workers", str(workers)]
        if scheduler:
            command += ["--scheduler", scheduler]
        pipe = asyncio.subprocess.PIPE
        return cls(
            await asyncio.create_subprocess_exec(*command, stdin=pipe, stdout=pipe, limit=_LONGEST)
        )

    @property
    def pid(self) -> int:
        """Of the process."""
        return self._process.pid

    async def order(self, what: dict[str, Any]) -> None:
        """Give an order; one that has died does not hear it."""
        assert self._process.stdin is not None
        with contextlib.suppress(ConnectionError):
            self._process.stdin.write(orjson.dumps(what) + b"\n")
            await self._process.stdin.drain()

    async def reports(self) -> AsyncIterator[dict[str, Any]]:
        """What it tells, until it ends."""
        assert self._process.stdout is not None
        while line := await self._process.stdout.readline():
            if line.endswith(b"\n"):
                yield orjson.loads(line)

    async def end(self) -> None:
        """Close its orders, wait, kill it if it does not listen."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        try:
            await asyncio.wait_for(self._process.wait(), _COURTESY)
        except TimeoutError:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()
            await self._process.wait()
