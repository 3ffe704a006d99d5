"""What happens on a worker, here or elsewhere: batches of cells."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import lru_cache

import orjson

from stairwright.documents import parse
from stairwright.jobs.cluster.worker import check_version, watch
from stairwright.jobs.memory import AMPLE, keep_no_more_than

from .cell import evaluate
from .document import Study
from .grid import point
from .question import Questions
from .variables import Record
from .version import engine_of

_DEADLINES = {"plan": 60.0, "rollout": 300.0, "trials": 300.0}  # s for a cell; of trials, for each


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
    check_version(engine_of(study), engine)
    limit = _DEADLINES[study.compute] * (study.trials.count if study.compute == "trials" else 1)
    records: dict[int, Record] = {}
    begun = time.monotonic()
    for cell in cells:
        with watch.over(limit):
            records[cell] = evaluate(questions, point(study, cell))
        keep_no_more_than(AMPLE)
    return Batch(records, time.monotonic() - begun)


@lru_cache(maxsize=4)
def _questions(document: bytes) -> Questions:
    """The same object for the same study: robots and what is derived from them stay."""
    return Questions(parse(Study, orjson.loads(document)))
