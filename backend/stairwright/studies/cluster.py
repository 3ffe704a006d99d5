"""Cells on Dask's workers: those of this machine, started on demand, or a cluster elsewhere."""

from __future__ import annotations

import contextlib
import queue
import time
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from typing import Any

from stairwright.documents import content_hash
from stairwright.errors import InputError, StairwrightError
from stairwright.jobs.cluster.connection import (
    CONNECT_LIMIT,
    configured_security,
    dask_plugin,
    knock,
)
from stairwright.jobs.cluster.worker import OtherVersion

from .batches import IN_FLIGHT, BatchSizes
from .cell import evaluate
from .document import Study
from .grid import point
from .local_cluster import LocalCluster
from .question import Questions
from .serial import Finished, Stopped
from .variables import FAILED, Record, complete
from .version import engine_of
from .worker import Batch, evaluate_batch

MOST_RESTARTS = 3  # of this machine's cluster in one study
_LOOK = 0.25  # s between looks whether it was stopped
_COUNT_EVERY = 2.0  # s between counts of workers
_EACH = 0.5  # s between reports while the cluster starts
_MOST_LOST = 20  # batches whose results went with a worker, in one pass
_GONE = "the scheduler is gone: what was done is kept, ask again to go on"


class ClusterLost(StairwrightError):
    """The scheduler is gone; what was done is kept."""


class ClusterEngine:
    """An `Engine` over Dask. One thread uses it at a time."""

    def __init__(self, scheduler: str | None, workers: int) -> None:
        """`scheduler` is the address of one that runs, None for `workers` of this machine."""
        self._address = scheduler
        self._workers = workers
        self._local: LocalCluster | None = None
        self._client: Any = None
        self._sizes: dict[str, BatchSizes] = {}  # by family: boundaries come in many waves

    @property
    def scheduler_pid(self) -> int | None:
        """Of this machine's scheduler, while there is one."""
        return None if self._local is None else self._local.pid

    def evaluate(self, study: Study, cells: Sequence[int], stopped: Stopped) -> Iterator[Finished]:
        """See `Engine`. While this machine's workers first start, cells are evaluated here.

        Not when they start again: one of the cells may be what ended them.

        Raises:
            ClusterLost: If the scheduler is gone, and cannot be replaced.
            OtherVersion: If a worker runs other code.
        """
        left = dict.fromkeys(cells)
        for restarts in range(MOST_RESTARTS + 1):
            try:
                for finished in self._evaluate(study, list(left), stopped, here=restarts == 0):
                    for cell in finished:
                        left.pop(cell, None)
                    yield finished
            except ClusterLost:
                self.close()
                if self._address is not None or restarts == MOST_RESTARTS:
                    raise
            else:
                return

    def close(self) -> None:
        """Leave the cluster; this machine's ends."""
        if self._client is not None:
            with contextlib.suppress(Exception):
                self._client.close(timeout=2)
            # Where its scheduler went while it connected anew it is not, and would say so once more
            # in its destructor.
            self._client.status = "closed"
        self._client = None
        if self._local is not None:
            self._local.close()
        self._local = None

    def _evaluate(
        self, study: Study, cells: list[int], stopped: Stopped, here: bool
    ) -> Iterator[Finished]:
        if self._client is None:
            with ThreadPoolExecutor(1, "connect") as aside:
                connected = aside.submit(self._connect)
                if here and self._address is None:
                    for finished in _meanwhile(study, cells, stopped, connected):
                        cells = cells[len(finished) :]
                        yield finished
                connected.result()
        if cells and not stopped():
            sizes = self._sizes.setdefault(study.family, BatchSizes())
            yield from _Run(self._client, study, cells, sizes).finished(stopped)

    def _connect(self) -> None:
        try:
            from distributed import Client

            if self._address is None:
                self._local = LocalCluster(self._workers)
                where, how = self._local.address, self._local.security
            else:
                knock(self._address)
                where, how = self._address, configured_security()
            self._client = Client(where, security=how, timeout=CONNECT_LIMIT, set_as_default=False)
            self._client.register_plugin(dask_plugin())
        except (OSError, RuntimeError, TypeError, ValueError) as error:
            why = str(error).split("\n")[0] or "no answer"
            if self._address is not None:
                raise InputError(f"cannot reach {self._address}: {why}", ("scheduler",)) from error
            raise ClusterLost(f"this machine's workers did not start: {why}") from error


def _meanwhile(
    study: Study, cells: list[int], stopped: Stopped, connected: Future[None]
) -> Iterator[Finished]:
    """The first cells, in order, until the workers can be asked."""
    questions = Questions(study)
    done: dict[int, Record] = {}
    since = time.monotonic()
    for cell in cells:
        if connected.done() or stopped():
            break
        done[cell] = evaluate(questions, point(study, cell))
        if time.monotonic() - since > _EACH:
            yield done
            done, since = {}, time.monotonic()
    if done:
        yield done


class _Run:
    """One pass over cells: a few batches in flight, the next one when one is done."""

    def __init__(self, client: Any, study: Study, cells: Sequence[int], sizes: BatchSizes) -> None:
        self._client = client
        self._document = study.model_dump_json().encode()
        self._family, self._engine = study.family, engine_of(study)
        self._study = study
        self._todo = deque(cells)
        self._split: deque[list[int]] = deque()  # batches that killed their workers, in halves
        self._suspects: deque[int] = deque()  # cells that may have, or were only beside one
        self._lost = 0  # batches whose results were no longer there when they were fetched
        self._alone: int | None = None  # the suspect that is tried with nothing beside it
        self._sizes = sizes
        self._flying: dict[Any, list[int]] = {}
        self._landed: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._counted, self._count = float("-inf"), 1

    def finished(self, stopped: Stopped) -> Iterator[Finished]:
        """Batches as they are done."""
        try:
            while self._flying or self._todo or self._split or self._suspects:
                if stopped():
                    return
                self._refill()
                done: dict[int, Record] = {}
                for future in self._arrivals():
                    done.update(self._taken(future))
                if done:
                    yield done
        finally:
            if self._flying:
                with contextlib.suppress(Exception):  # nobody may be there any more
                    self._client.cancel(list(self._flying), force=True)

    def _refill(self) -> None:
        if self._alone is not None:
            return
        room = IN_FLIGHT * self._workers() - len(self._flying)
        for _ in range(room):
            if self._split:
                cells = self._split.popleft()
            elif self._todo:
                size = self._sizes.next(len(self._todo), self._count)
                cells = [self._todo.popleft() for _ in range(min(size, len(self._todo)))]
            else:
                break
            self._submit(cells)
        if self._suspects and not self._flying:
            self._alone = self._suspects.popleft()
            self._submit([self._alone], "alone-")

    def _submit(self, cells: list[int], kind: str = "cells-") -> None:
        places = [point(self._study, cell) for cell in cells]
        key = kind + content_hash([self._family, self._engine, places])[7:]
        future = self._client.submit(
            evaluate_batch, self._document, self._engine, cells, key=key, retries=0
        )
        self._flying[future] = cells
        future.add_done_callback(self._landed.put)

    def _arrivals(self) -> list[Any]:
        """Futures that are done; waits a moment for the first."""
        arrived = []
        with contextlib.suppress(queue.Empty):
            arrived.append(self._landed.get(timeout=_LOOK))
            while True:
                arrived.append(self._landed.get_nowait())
        if self._client.status not in ("running", "connecting"):
            raise ClusterLost(_GONE)
        return arrived

    def _taken(self, future: Any) -> Finished:
        cells = self._flying.pop(future, None)
        if cells is None:
            return {}
        try:
            batch: Batch = future.result(timeout=CONNECT_LIMIT)
        except OtherVersion:
            raise
        except (Exception, CancelledError) as error:
            if future.status == "error":
                return self._failed(cells, f"{type(error).__name__}: {error}")
            # It was done, and what it gave is gone.
            if self._client.status != "running" or self._lost == _MOST_LOST:
                raise ClusterLost(_GONE) from error
            self._lost += 1
            self._submit(cells, f"again-{self._lost}-")
            return {}
        self._alone = None
        self._sizes.learn(len(cells), batch.seconds)
        return batch.records

    def _failed(self, cells: list[int], why: str) -> Finished:
        """A batch that killed its worker is tried in halves, until it is one cell.

        Dask blames all that a worker had when it died, so one cell is tried once more with nothing
        beside it.
        """
        if len(cells) > 1:
            half = len(cells) // 2
            self._split.extend((cells[:half], cells[half:]))
            return {}
        shown = " ".join(why.split())
        killed = shown.startswith("KilledWorker")
        if killed and cells[0] != self._alone:
            self._suspects.append(cells[0])
            return {}
        self._alone = None
        if killed:
            shown = "its worker died or took too long, more than once"
        return {cells[0]: complete({"state": FAILED, "reason": "lost", "message": shown})}

    def _workers(self) -> int:
        now = time.monotonic()
        if now - self._counted > _COUNT_EVERY:
            self._counted = now
            try:
                self._count = max(1, len(self._client.nthreads()))
            except (OSError, CancelledError) as error:
                raise ClusterLost("the scheduler is gone: ask again to go on") from error
        return self._count
