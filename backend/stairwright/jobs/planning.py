"""Interactive plans: answered from what is stored, else by a worker of their own pool."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass

from stairwright.storage.documents import Entry
from stairwright.storage.store import Store

from . import work
from .engine import planning_engine
from .pool import WorkerPool
from .questions import PlanQuestion
from .queue import FairQueue

COURTESY = 0.1  # s that a solve may go on when nobody waits for it any more


@dataclass(frozen=True)
class Answer:
    """A plan: its entry and its JSON, gzipped if it was stored already."""

    entry: Entry
    content: bytes
    cached: bool


class Flight:
    """One solve and how many wait for it."""

    def __init__(self) -> None:
        self.task: asyncio.Task[Answer]
        self.waiting = 0
        self.started = False

    def leave(self) -> None:
        """One waits no longer. The last one takes the solve along.

        What is solved already is left a moment to finish, since a new worker is dearer.
        """
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
        self.queue = FairQueue(pool.workers, queue_limit, "plans")
        self._store = store
        self._pool = pool
        self._deadline = deadline
        self._flights: dict[str, Flight] = {}

    def stored(self, question: PlanQuestion) -> Answer | None:
        """The plan if it is known already. Reads the database: call it in a thread."""
        entry = self._store.documents.answer("plan", question.key, planning_engine())
        if entry is None:
            return None
        try:
            return Answer(entry, self._store.artefacts.packed(entry.digest), cached=True)
        except FileNotFoundError:  # collected this very moment
            return None

    async def solve(self, question: PlanQuestion, owner: str) -> Answer:
        """The plan, infeasible ones too. Cancelling the last caller cancels the solve.

        Raises:
            InputError: If the planner refuses the question.
            Failure: If it could not be solved now.
        """
        flight = self._flights.get(question.key)
        if flight is None or flight.task.cancelling():
            self.queue.check()
            flight = self._take_off(question, owner)
        flight.waiting += 1
        try:
            return await asyncio.shield(flight.task)
        finally:
            flight.leave()

    def _take_off(self, question: PlanQuestion, owner: str) -> Flight:
        flight = Flight()
        flight.task = asyncio.create_task(self._solve(question, owner, flight))
        self._flights[question.key] = flight

        def landed(task: asyncio.Task[Answer]) -> None:
            if self._flights.get(question.key) is flight:
                del self._flights[question.key]
            if not task.cancelled():
                task.exception()  # every caller may have gone

        flight.task.add_done_callback(landed)
        return flight

    async def _solve(self, question: PlanQuestion, owner: str, flight: Flight) -> Answer:
        folder = str(self._store.artefacts.folder)
        async with self.queue.slot(owner):
            flight.started = True
            product = await self._pool.run(
                work.solve, question.data, folder, deadline=self._deadline
            )
        entry = await asyncio.to_thread(shelve_plan, self._store, question, product)
        return Answer(entry, product.content, cached=False)


def shelve_plan(store: Store, question: PlanQuestion, product: work.Product) -> Entry:
    """Write down a plan that a worker has left among the artefacts."""
    return store.shelve(
        "plan",
        product.id,
        question=question.key,
        engine=planning_engine(),
        digest=product.digest,
        size=product.size,
        summary=product.summary,
    )
