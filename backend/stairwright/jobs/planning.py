"""Interactive plans: answered from what is stored, else by a worker of their own pool."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine
from dataclasses import dataclass
from functools import partial
from typing import Any, Generic, TypeVar

from stairwright.storage.documents import Entry, Kind
from stairwright.storage.store import Store

from . import work
from .engine import planning_engine
from .pool import WorkerPool
from .questions import PlanQuestion
from .queue import FairQueue

T = TypeVar("T")
W = TypeVar("W")

COURTESY = 0.1  # s that a solve may go on when nobody waits for it any more


@dataclass(frozen=True)
class Answer:
    """A plan: its entry and its JSON, gzipped if it was stored already."""

    entry: Entry
    content: bytes
    cached: bool


class Flight(Generic[T]):
    """One solve and how many wait for it."""

    def __init__(self) -> None:
        self.task: asyncio.Task[T]
        self.waiting = 0
        self.started = False

    async def answer(self) -> T:
        """What comes of it. The last one who waits no longer takes the solve along.

        What is solved already is left a moment to finish, since a new worker is dearer.
        """
        self.waiting += 1
        try:
            return await asyncio.shield(self.task)
        finally:
            self._leave()

    def _leave(self) -> None:
        self.waiting -= 1
        if self.waiting == 0 and not self.task.done():
            delay = COURTESY if self.started else 0.0
            asyncio.get_running_loop().call_later(delay, self._give_up)

    def _give_up(self) -> None:
        if self.waiting == 0:
            self.task.cancel()


class Planning:
    """Solves questions; the same question twice at once is solved once."""

    def __init__(self, store: Store, pool: WorkerPool, queue_limit: int, deadline: float) -> None:
        self.queue = FairQueue(pool.workers, queue_limit, "plans", reserve=pool.spares)
        self._store = store
        self._pool = pool
        self._deadline = deadline
        self._answers: dict[str, Flight[Answer]] = {}

    def stored(self, question: PlanQuestion) -> Answer | None:
        """The plan if it is known already. Reads the database: call it in a thread."""
        found = self._store.documents.content("plan", question.key, planning_engine())
        return None if found is None else Answer(*found, cached=True)

    async def solve(self, question: PlanQuestion, owner: str) -> Answer:
        """The plan, infeasible ones too. Cancelling the last caller cancels the solve.

        Raises:
            InputError: If the planner refuses the question.
            Failure: If it could not be solved now.
        """
        key = question.key
        flight = self._answers.get(key)
        if flight is None or flight.task.cancelling():
            flight = self._answers[key] = self._take_off(self._solve, question, owner)
            flight.task.add_done_callback(partial(self._landed, key))
        return await flight.answer()

    async def preview(self, question: PlanQuestion, owner: str) -> bytes:
        """The plan's JSON, which is neither stored nor shared with who asks the same."""
        return await self._take_off(self._preview, question, owner).answer()

    def _take_off(
        self,
        work: Callable[[PlanQuestion, str, Flight[T]], Coroutine[Any, Any, T]],
        question: PlanQuestion,
        owner: str,
    ) -> Flight[T]:
        self.queue.check(owner)
        flight = Flight[T]()
        flight.task = asyncio.create_task(work(question, owner, flight))
        flight.task.add_done_callback(_heard)
        return flight

    def _landed(self, key: str, task: asyncio.Task[Answer]) -> None:
        flight = self._answers.get(key)
        if flight is not None and flight.task is task:
            del self._answers[key]

    async def _solve(self, question: PlanQuestion, owner: str, flight: Flight[Answer]) -> Answer:
        kept = self._store.read_only is None  # else it is answered all the same
        folder = str(self._store.artefacts.folder) if kept else None
        product = await self._work(owner, flight, work.solve, question.data, folder)
        if kept:
            entry = await asyncio.to_thread(shelve_plan, self._store, question, product)
        else:
            size, now = product.size, time.time()
            entry = Entry(product.id, "plan", product.digest, size, product.summary, now)
        return Answer(entry, product.content, cached=False)

    async def _preview(self, question: PlanQuestion, owner: str, flight: Flight[bytes]) -> bytes:
        return await self._work(owner, flight, work.preview, question.data)

    async def _work(
        self, owner: str, flight: Flight[Any], function: Callable[..., W], *args: Any
    ) -> W:
        async with self.queue.slot(owner):
            flight.started = True
            return await self._pool.run(function, *args, deadline=self._deadline)


def _heard(task: asyncio.Task[Any]) -> None:
    if not task.cancelled():
        task.exception()  # every caller may have gone


def shelve_plan(store: Store, question: PlanQuestion, product: work.Product) -> Entry:
    """Write down a plan that a worker has left among the artefacts."""
    return shelve(store, "plan", question.key, planning_engine(), product)


def shelve(store: Store, kind: Kind, question: str, engine: str, product: work.Product) -> Entry:
    """Write down what a worker has left among the artefacts, by the key of what was asked."""
    return store.shelve(
        kind,
        product.id,
        question=question,
        engine=engine,
        digest=product.digest,
        size=product.size,
        summary=product.summary,
    )
