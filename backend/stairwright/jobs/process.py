"""One worker process, seen from an event loop: asked one thing at a time, and killed at will."""

from __future__ import annotations

import asyncio
import contextlib
import pickle
import socket
import threading
from collections.abc import Callable
from multiprocessing.process import BaseProcess
from typing import Any, cast

from . import launch
from .failures import WorkerDied
from .worker import LENGTH, Limits, packed, serve


class WorkerProcess(asyncio.Protocol):
    """Made by `start`. Ask only while it is not busy.

    Attributes:
        gone: Set when the process has ended.
        given_up: Whether it was killed on purpose.
    """

    def __init__(self, process: BaseProcess) -> None:
        self.gone = asyncio.Event()
        self.given_up = False
        self._received = bytearray()
        self._answer: asyncio.Future[bytes] | None = None
        self._transport: asyncio.Transport
        self._process = process

    @classmethod
    async def start(cls, limits: Limits) -> WorkerProcess:
        """Fork one; it may take until everything that is preloaded is there.

        Raises:
            OSError: If the system has no room for it.
            EOFError: If the process that it is forked from ends meanwhile.
        """
        ours, theirs = socket.socketpair()
        try:
            process = launch.context().Process(target=serve, args=(theirs, limits), daemon=True)
            await _in_thread(process.start)
            theirs.close()  # only now: without it nobody would see the process end
            loop = asyncio.get_running_loop()
            _, worker = await loop.create_unix_connection(lambda: cls(process), sock=ours)
        except BaseException:
            ours.close()  # a process that starts all the same ends with it
            theirs.close()
            raise
        return worker

    @property
    def busy(self) -> bool:
        """Whether it is at something: asked, no answer yet, and not dead."""
        return not (self._answer is None or self.gone.is_set())

    async def ask(self, function: Callable[..., Any], *args: Any) -> tuple[bool, Any]:
        """Whether `function(*args)` returned there, and what it returned or raised.

        Raises:
            WorkerDied: If the process ends meanwhile.
        """
        task = packed((function, args))
        answer = self._answer = asyncio.get_running_loop().create_future()
        self._transport.write(task)
        content = await answer
        return cast("tuple[bool, Any]", pickle.loads(content))  # noqa: S301 - our own process

    def kill(self) -> None:
        """End it, whatever it is at."""
        self.given_up = True
        self._process.kill()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Called by the loop."""
        self._transport = cast("asyncio.Transport", transport)

    def data_received(self, data: bytes) -> None:
        """Called by the loop with the next part of an answer."""
        self._received += data
        if len(self._received) < LENGTH.size:
            return
        (length,) = LENGTH.unpack_from(self._received)
        if len(self._received) < LENGTH.size + length:
            return
        content, self._received = bytes(self._received[LENGTH.size :]), bytearray()
        answer, self._answer = self._answer, None
        if answer is not None and not answer.done():
            answer.set_result(content)

    def connection_lost(self, _: Exception | None) -> None:
        """Called by the loop when the process has ended."""
        self.gone.set()
        if self._answer is not None and not self._answer.done():
            reason = "the process that did the work died (out of memory?)"
            self._answer.set_exception(WorkerDied(reason))


async def _in_thread(function: Callable[[], None]) -> None:
    """Like `asyncio.to_thread`, but a server that ends does not wait for the thread.

    Workers cannot be started before everything is imported and compiled, which takes seconds.
    """
    loop = asyncio.get_running_loop()
    over: asyncio.Future[None] = loop.create_future()

    def settle(problem: Exception | None) -> None:
        if over.done():
            return
        if problem is None:
            over.set_result(None)
        else:
            over.set_exception(problem)

    def work() -> None:
        problem = None
        try:
            function()
        except Exception as error:  # noqa: BLE001 - handed on to the caller
            problem = error
        with contextlib.suppress(RuntimeError):  # the loop has ended meanwhile
            loop.call_soon_threadsafe(settle, problem)

    threading.Thread(target=work, daemon=True).start()
    await over
