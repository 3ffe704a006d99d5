"""A fair queue in front of a few workers: owners take turns, whoever asks more waits longer."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections import OrderedDict, deque
from collections.abc import AsyncIterator, Callable

from .failures import QueueFull

_SMOOTHING = 0.2  # weight of the newest duration in the running mean


class FairQueue:
    """Slots for `capacity` tasks at once; at most `limit` wait.

    Belongs to one event loop.
    """

    def __init__(self, capacity: int, limit: int, name: str) -> None:
        self.capacity = capacity
        self.limit = limit
        self.name = name
        self.running = 0
        self.observe: Callable[[float], None] = _ignore  # called with the time [s] that one waited
        self._waiting: OrderedDict[str, deque[asyncio.Future[None]]] = OrderedDict()
        self._duration = 1.0  # s, running mean

    @property
    def length(self) -> int:
        """How many wait."""
        return sum(len(line) for line in self._waiting.values())

    def check(self) -> None:
        """Whether one more may wait.

        Raises:
            QueueFull: If not; says when to come back.
        """
        if self.running >= self.capacity and self.length >= self.limit:
            wait = self._duration * max(1, self.length) / self.capacity
            raise QueueFull(
                f"{self.length} {self.name} are waiting already", retry_after=max(1.0, wait)
            )

    @contextlib.asynccontextmanager
    async def slot(self, owner: str) -> AsyncIterator[None]:
        """Wait for a free worker and hold it.

        Raises:
            QueueFull: If too many wait.
        """
        self.check()
        asked = time.monotonic()
        if self.running < self.capacity:
            self.running += 1
        else:
            await self._wait(owner)
        start = time.monotonic()
        self.observe(start - asked)
        try:
            yield
        finally:
            spent = time.monotonic() - start
            self._duration += _SMOOTHING * (spent - self._duration)
            self._hand_over()

    async def _wait(self, owner: str) -> None:
        turn: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiting.setdefault(owner, deque()).append(turn)
        try:
            await turn
        except asyncio.CancelledError:
            if turn.done() and not turn.cancelled():  # got the slot and gave up at once
                self._hand_over()
            else:
                self._leave(owner, turn)
            raise

    def _leave(self, owner: str, turn: asyncio.Future[None]) -> None:
        line = self._waiting.get(owner)
        if line is not None and turn in line:
            line.remove(turn)
            if not line:
                del self._waiting[owner]

    def _hand_over(self) -> None:
        """Give a slot that is free now to the next owner in turn."""
        while self._waiting:
            owner, line = self._waiting.popitem(last=False)
            turn = line.popleft()
            if line:
                self._waiting[owner] = line  # to the end: the others come first
            if not turn.done():
                turn.set_result(None)
                return
        self.running -= 1


def _ignore(_: float) -> None:
    """Nobody wants to know."""
