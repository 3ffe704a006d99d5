"""The service's process for studies: carries out one after the other, and tells how far it is.

Orders come as JSON lines: ``{"run": id, "study": {...}, "path": "...", "retry": false}``, with
"design" instead of "study" for a search, and ``{"cancel": id}``. Reports go out the same way, one a
line: ``{"id", "done", "total", "left", "partly", "cells": block or null}`` as `Progress` has them
(a total of 0: not known yet), and ``{"id", "state", "error"}`` at the end.
When the orders end, whoever gave them has gone: this process ends too, and what is written stays.
"""

from __future__ import annotations

import argparse
import os
import queue
import sys
import threading
from functools import partial
from pathlib import Path
from typing import IO, Any

import orjson

from stairwright.documents import parse
from stairwright.errors import StairwrightError
from stairwright.jobs.failures import Failure, WorkerDied, problem_of

from .blocks import Block, block_of, blocks_of
from .design_document import Design
from .design_search import search
from .document import Study, study_id
from .fill import fill
from .keeping import kept_store, relatives
from .progress import Progress
from .serial import Engine
from .store import ResultStore
from .study import choose_engine
from .version import engine_of

NICENESS = 5  # whoever drags a corner comes first; workers are nicer still


class Runner:
    """Orders in, reports out."""

    def __init__(self, engine: Engine, reports: IO[bytes]) -> None:
        self._engine = engine
        self._reports = reports
        self._cancelled: set[str] = set()
        self._orders: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()

    def listen(self, orders: IO[bytes]) -> None:
        """Take orders until there are no more; then end this process, whatever it is at."""
        for line in orders:
            order = orjson.loads(line)
            if "cancel" in order:
                self._cancelled.add(order["cancel"])
            else:
                self._cancelled.discard(order["run"])
                self._orders.put(order)
        os._exit(0)  # our cluster, if there is one, ends with us

    def serve(self) -> None:
        """Carry out orders as they come, for ever."""
        while True:
            order = self._orders.get()
            name = str(order["run"])
            try:
                if "design" in order:
                    self._search(name, order)
                else:
                    self._fill(name, order)
                state = "cancelled" if name in self._cancelled else "done"
                self._tell({"id": name, "state": state, "error": None})
            except StairwrightError as error:
                known = error if isinstance(error, Failure) else WorkerDied(str(error))
                self._tell({"id": name, "state": "failed", "error": problem_of(known)})
            except Exception as error:  # noqa: BLE001 - the next study must not suffer
                print(f"study {name}: {type(error).__name__}: {error}", file=sys.stderr, flush=True)
                self._tell({"id": name, "state": "failed", "error": problem_of(error)})

    def _search(self, name: str, order: dict[str, Any]) -> None:
        design = parse(Design, order["design"])
        report, stopped = partial(self._report, name), partial(self._cancelled.__contains__, name)
        search(design, self._engine, Path(order["path"]), report, stopped)

    def _fill(self, name: str, order: dict[str, Any]) -> None:
        study = parse(Study, order["study"])
        path = Path(order["path"])
        store = _store(study, path)
        if order.get("retry"):
            store.forget_failures()
        told = 0
        for block in blocks_of(store):  # what was known before
            told += len(block["cell"])
            self._report(name, Progress(told, 0), block)
        report, stopped = partial(self._report, name), partial(self._cancelled.__contains__, name)
        with store.writing():
            fill(store, self._engine, report, stopped)

    def _report(self, name: str, progress: Progress, block: Block | None = None) -> None:
        cells = block_of(progress.new) if progress.new else block
        self._tell({"id": name, "done": progress.done, "total": progress.total,
                    "left": progress.left, "partly": progress.partly, "cells": cells})  # fmt: skip

    def _tell(self, report: dict[str, Any]) -> None:
        self._reports.write(orjson.dumps(report) + b"\n")
        self._reports.flush()


def _store(study: Study, path: Path) -> ResultStore:
    engine = engine_of(study)
    if path.exists():
        return kept_store(study, study_id(study, engine), engine, path)
    store = ResultStore.create(path, study, engine)
    for other in relatives(path.parent, study, engine, path):
        store.adopt(other)
    return store


def main() -> None:
    """Serve whoever started this process."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--workers", type=int, required=True)
    parser.add_argument("--scheduler", default="")
    given = parser.parse_args()
    os.nice(NICENESS)
    reports = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # nobody else's words among the reports
    runner = Runner(choose_engine(given.scheduler or None, given.workers), reports)
    threading.Thread(target=runner.listen, args=(sys.stdin.buffer,), daemon=True).start()
    runner.serve()


if __name__ == "__main__":
    main()
