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


@dataclass(frozen=True)
class Answer:
    """A plan: its entry, its gzipped JSON, and whether it was there already."""

    entry: Entry
    packed: bytes
    cached: bool


class Planning:
    """Solves questions; the same question twice at once is solved once."""

    def __init__(self, store: Store, pool: WorkerPool, queue_limit: int, deadline: float) -> None:
        self.queue = FairQueue(pool.workers, queue_limit, "plans")
        self._store = store
        self._pool = pool
        self._deadline = deadline
        self._flights: dict[str, asyncio.Task[Answer]] = {}

    async def solve(self, question: PlanQuestion, owner: str) -> Answer:
        """The plan, infeasible ones too.

        Raises:
            InputError: If the planner refuses the question.
            Failure: If it could not be solved now.
        """
        stored = await asyncio.to_thread(self._stored, question.key)
        if stored is not None:
            return stored
        flight = self._flights.get(question.key)
        if flight is None:
            self.queue.check()
            flight = asyncio.create_task(self._solve(question, owner))
            self._flights[question.key] = flight
            flight.add_done_callback(lambda _: self._flights.pop(question.key, None))
        return await asyncio.shield(flight)

    def _stored(self, key: str) -> Answer | None:
        entry = self._store.documents.answer("plan", key, planning_engine())
        if entry is None:
            return None
        try:
            return Answer(entry, self._store.artefacts.packed(entry.digest), cached=True)
        except FileNotFoundError:  # collected this very moment
            return None

    async def _solve(self, question: PlanQuestion, owner: str) -> Answer:
        folder = str(self._store.artefacts.folder)
        async with self.queue.slot(owner):
            product = await self._pool.run(
                work.solve, question.data, folder, deadline=self._deadline
            )
        entry = await asyncio.to_thread(shelve_plan, self._store, question, product)
        return Answer(entry, product.packed, cached=False)


def shelve_plan(store: Store, question: PlanQuestion, product: work.Product) -> Entry:
    """Write down a plan that a worker has left among the artefacts."""
    return store.documents.put(
        "plan",
        product.id,
        question=question.key,
        engine=planning_engine(),
        digest=product.digest,
        size=product.size,
        summary=product.summary,
    )
