"""What happens on a worker, here or elsewhere: batches of cells, and a watch over each of them."""

from __future__ import annotations

import contextlib
import os
import threading
import time
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import orjson

from stairwright.documents import parse
from stairwright.errors import StairwrightError

from .cell import evaluate
from .document import Study
from .grid import point
from .question import Questions
from .variables import Record
from .version import engine_of

if TYPE_CHECKING:
    from distributed import Worker

NICENESS = 10  # whoever drags a corner comes first
_LOOK = 1.0  # s between looks at what the worker is at
_DEADLINES = {"plan": 60.0, "rollout": 300.0, "trials": 300.0}  # s for a cell; of trials, for each


class OtherVersion(StairwrightError):
    """The worker runs other code: its answers would not be those of the study."""


@dataclass(frozen=True)
class Batch:
    """Cells done on a worker, and how long they took [s]."""

    records: dict[int, Record]
    seconds: float


def evaluate_batch(document: bytes, engine: str, cells: list[int]) -> Batch:
    """Evaluate cells of the study in `document` (JSON).

    Raises:
        OtherVersion: If this is not the code whose fingerprint is `engine`.
    """
    questions = _questions(document)
    study = questions.study
    mine = engine_of(study)
    if mine != engine:
        raise OtherVersion(
            f"a worker runs another version of Stairwright ({mine}, not {engine}): "
            "install the same one everywhere"
        )
    limit = _DEADLINES[study.compute] * (study.trials.count if study.compute == "trials" else 1)
    records: dict[int, Record] = {}
    begun = time.monotonic()
    for cell in cells:
        with _watch.cell(limit):
            records[cell] = evaluate(questions, point(study, cell))
    return Batch(records, time.monotonic() - begun)


@lru_cache(maxsize=4)
def _questions(document: bytes) -> Questions:
    """The same object for the same study: robots and what is derived from them stay."""
    return Questions(parse(Study, orjson.loads(document)))


class _Watch:
    """Ends this process where a cell takes too long: its batch is tried elsewhere, then split."""

    def __init__(self) -> None:
        self._until = float("inf")
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin to look; only in processes that somebody restarts."""
        self._thread = threading.Thread(target=self._look, daemon=True, name="cell-watch")
        self._thread.start()

    @contextlib.contextmanager
    def cell(self, limit: float) -> Any:
        """A cell that may take `limit` [s]."""
        self._until = time.monotonic() + limit
        try:
            yield
        finally:
            self._until = float("inf")

    def _look(self) -> None:
        while True:
            time.sleep(_LOOK)
            if time.monotonic() > self._until:
                os._exit(3)


_watch = _Watch()


class CorePlugin:
    """Loads the core before the first batch, and keeps the worker out of the way of others.

    A Dask `WorkerPlugin` by its methods: this module needs no Dask.
    """

    name = "stairwright-core"
    idempotent = True

    def setup(self, worker: Worker) -> None:
        """Called once on every worker, new ones included."""
        from stairwright.jobs.work import GENTLE
        from stairwright.planning.planner import plan

        with contextlib.suppress(OSError, AttributeError):
            os.nice(max(0, NICENESS - os.nice(0)))
        plan(GENTLE)  # brings everything into memory
        if worker.nanny is not None:
            _watch.start()
