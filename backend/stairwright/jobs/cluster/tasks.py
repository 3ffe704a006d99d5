"""What a cluster's workers do for jobs. Pure functions of plain data; news goes to who asked.

A rollout is two tasks, its plan and the rollout; a set of trials is its plan, parts of a second or
two, and their summary. Dask carries what one needs of the other, between workers where it must.
"""

from __future__ import annotations

import time
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from stairwright.errors import Cancelled
from stairwright.jobs import work
from stairwright.jobs.engine import rollout_engine
from stairwright.jobs.live import Broadcast

from .worker import check_version, is_cancelled, watch

if TYPE_CHECKING:
    from stairwright.planning.plan import Plan
    from stairwright.simulation.trials import TrialSet
    from stairwright.simulation.trials_result import Trial

_EVERY = 0.25  # s between two pieces of news of one task


@dataclass(frozen=True)
class Order:
    """What every task is told besides its question.

    Attributes:
        run: Who waits for it, in the news of it.
        topic: Of Dask's events, where the news goes.
        key: The task's own.
        engine: Fingerprint of the code that is to do it.
        deadline: Longest time for one rollout, or the plan [s].
    """

    run: str
    topic: str
    key: str
    engine: str
    deadline: float


class News:
    """How far a task is, told to who waits for it."""

    def __init__(self, order: Order) -> None:
        from distributed import get_worker

        self._order = order
        self._worker = get_worker()
        self._told = float("-inf")

    def progress(self, share: float) -> None:
        """Tell how much is done, 0..1, if it is time to.

        Raises:
            Cancelled: If nobody waits for it any more.
        """
        if is_cancelled(self._order.key):
            raise Cancelled("cancelled")
        now = time.monotonic()
        if share >= 1.0 or now - self._told >= _EVERY:
            self._told = now
            self._tell(share=float(share))

    def series(self, line: bytes) -> None:
        """Tell a chunk of a rollout's series."""
        self._tell(series=zlib.compress(line, 1))

    def _tell(self, **what: Any) -> None:
        order = self._order
        self._worker.log_event(order.topic, {"run": order.run, "task": order.key, **what})


def make_plan(source: Mapping[str, Any], order: Order) -> bytes:
    """JSON of the plan that `source` asks for (``ask``) or holds (``plan``, ``content``).

    Raises:
        InputError: If the planner refuses the question.
        Cancelled: If nobody waits for it any more.
        OtherVersion: If a worker runs other code.
    """
    check_version(rollout_engine(), order.engine)
    if "content" in source:
        return bytes(source["content"])
    with watch.over(order.deadline):
        content = work.plan_of(source).model_dump_json().encode()
    News(order).progress(1.0)
    return content


def roll_out(content: bytes, question: work.Question, order: Order) -> work.Product:
    """The rollout of a plan, its JSON in `content`.

    Raises:
        InputError: If a value is bad or the plan has nothing that could be carried out.
        Cancelled: If nobody waits for it any more.
        OtherVersion: If a worker runs other code.
    """
    check_version(rollout_engine(), order.engine)
    news = News(order)
    with watch.over(order.deadline):
        observe = Broadcast(news.series, _EVERY)
        return work.rolled_out(_plan(content), question, news.progress, observe)


def find_margins(content: bytes, question: work.Question, order: Order) -> work.Product:
    """Delay and friction margin of a plan, its JSON in `content`.

    Raises:
        InputError, Cancelled, OtherVersion: As `roll_out`.
    """
    check_version(rollout_engine(), order.engine)
    with watch.over(order.deadline):
        return work.margins_found(_plan(content), question, News(order).progress)


def try_part(
    content: bytes, question: work.Question, first: int, last: int, order: Order
) -> list[Trial]:
    """Trials `first` to `last` (excluded) of the set.

    Raises:
        InputError, Cancelled, OtherVersion: As `roll_out`.
    """
    check_version(rollout_engine(), order.engine)
    asked, news = _trials(content, question), News(order)
    found: list[Trial] = []

    def progress(share: float) -> None:
        news.progress((len(found) + share) / (last - first))

    for i in range(first, last):
        with watch.over(order.deadline):
            found.append(asked.carry_out(asked.jobs[i], progress))
        progress(0.0)
    return found


def sum_up(
    content: bytes, question: work.Question, parts: Sequence[Sequence[Trial]], order: Order
) -> work.Product:
    """The whole set of trials from its parts, in order.

    Raises:
        OtherVersion: If a worker runs other code.
    """
    check_version(rollout_engine(), order.engine)
    found = _trials(content, question).summary([trial for part in parts for trial in part])
    return work.tried(found, _plan(content), question)


@lru_cache(maxsize=4)
def _plan(content: bytes) -> Plan:
    """The same object for the same plan: parts of trials follow one another."""
    from stairwright.planning.plan import Plan

    return Plan.model_validate_json(content)


def _trials(content: bytes, question: work.Question) -> TrialSet:
    from stairwright.simulation.trials import TrialSet

    return TrialSet.of(
        _plan(content),
        question["count"],
        question["seed"],
        question["ranges"],
        question["friction"],
        question["controller"] or None,
    )
