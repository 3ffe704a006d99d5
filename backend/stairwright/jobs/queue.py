"""A fair queue in front of a few workers: owners take turns, whoever asks more waits longer."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections import Counter, OrderedDict, deque
from collections.abc import AsyncIterator, Callable

from .failures import QueueFull

_SMOOTHING = 0.2  # weight of the newest duration in the running mean
_GUESS = 1.0  # s, of a task's duration before one has ended


class FairQueue:
    """Slots for `capacity` tasks at once; at most `limit` wait.

    One owner alone can hold neither all slots nor all places: where all that runs is one owner's,
    `reserve` further slots are open to others, and who has nothing here yet may wait even where
    the queue is full, as long as no more than `limit` owners wait. Belongs to one event loop.
    """

    def __init__(self, capacity: int, limit: int, name: str, reserve: int = 0) -> None:
        self.capacity = capacity
        self.limit = limit
        self.name = name
        self.reserve = reserve
        self.typical: float | None = None  # s that a task takes, running mean
        self.observe: Callable[[float], None] = _ignore  # called with the time [s] that one waited
        self._running: Counter[str] = Counter()
        self._waiting: OrderedDict[str, deque[asyncio.Future[None]]] = OrderedDict()

    @property
    def running(self) -> int:
        """How many slots are held."""
        return self._running.total()

    @property
    def length(self) -> int:
        """How many wait."""
        return sum(len(line) for line in self._waiting.values())

    def ahead(self, owner: str, rank: int) -> int:
        """How many of those that wait now come before the `rank`-th (from 0) of an owner's."""
        count, before = rank, True
        for other, line in self._waiting.items():
            if other == owner:
                before = False
            else:
                count += min(len(line), rank + before)
        return count

    def check(self, owner: str) -> None:
        """Whether one more of this owner's may wait.

        Raises:
            QueueFull: If not; says when to come back.
        """
        if self._may_start(owner) or self.length < self.limit:
            return
        if owner in self._running or owner in self._waiting or len(self._waiting) >= self.limit:
            typical = _GUESS if self.typical is None else self.typical
            wait = typical * max(1, self.length) / self.capacity
            raise QueueFull(
                f"{self.length} {self.name} are waiting already", retry_after=max(1.0, wait)
            )

    @contextlib.asynccontextmanager
    async def slot(self, owner: str, *, accepted: bool = False) -> AsyncIterator[None]:
        """Wait for a free worker and hold it. What was accepted earlier may wait in any case.

        Raises:
            QueueFull: If too many wait.
        """
        asked = time.monotonic()
        if not accepted:
            self.check(owner)
        if self._may_start(owner):
            self._running[owner] += 1
        else:
            await self._wait(owner)
        start = time.monotonic()
        self.observe(start - asked)
        try:
            yield
        finally:
            spent = time.monotonic() - start
            before = spent if self.typical is None else self.typical
            self.typical = before + _SMOOTHING * (spent - before)
            self._hand_over(owner)

    def _may_start(self, owner: str) -> bool:
        if self.running < self.capacity:
            return True
        one_holds_all = len(self._running) == 1 and owner not in self._running
        return one_holds_all and self.running < self.capacity + self.reserve

    async def _wait(self, owner: str) -> None:
        turn: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiting.setdefault(owner, deque()).append(turn)
        try:
            await turn
        except asyncio.CancelledError:
            if turn.done() and not turn.cancelled():  # got the slot and gave up at once
                self._hand_over(owner)
            else:
                self._leave(owner, turn)
            raise

    def _leave(self, owner: str, turn: asyncio.Future[None]) -> None:
        line = self._waiting.get(owner)
        if line is not None and turn in line:
            line.remove(turn)
            if not line:
                del self._waiting[owner]

    def _hand_over(self, owner: str) -> None:
        """Give up this owner's slot, to whoever may start now: those who have least, in turn."""
        self._running[owner] -= 1
        if not self._running[owner]:
            del self._running[owner]
        self._let_in()

    def resize(self, capacity: int) -> None:
        """There are more slots now, or fewer; what runs goes on."""
        self.capacity = capacity
        self._let_in()

    def _let_in(self) -> None:
        """Whoever may start now."""
        while following := self._next():
            line = self._waiting.pop(following)
            turn = line.popleft()
            if line:
                self._waiting[following] = line  # to the end: the others come first
            if not turn.done():
                self._running[following] += 1
                turn.set_result(None)

    def _next(self) -> str | None:
        able = [owner for owner in self._waiting if self._may_start(owner)]
        return min(able, key=self._running.__getitem__, default=None)


def _ignore(_: float) -> None:
    """Nobody wants to know."""
