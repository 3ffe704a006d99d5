"""What every worker of a cluster is given: the core, a watch over what it is at, and ears."""

from __future__ import annotations

import contextlib
import ctypes
import gc
import os
import threading
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from stairwright.jobs.failures import Failure

if TYPE_CHECKING:
    from distributed import Worker

NICENESS = 10  # whoever drags a corner comes first
_LOOK = 1.0  # s between looks at what the worker is at


class OtherVersion(Failure):
    """The worker runs other code: its answers would not be those that were asked for."""

    status = 503
    kind = "other-version"


def check_version(mine: str, asked: str) -> None:
    """Whether this is the code with the fingerprint that was asked for.

    Raises:
        OtherVersion: If not.
    """
    if mine != asked:
        raise OtherVersion(
            f"a worker runs another version of Stairwright ({mine}, not {asked}): "
            "install the same one everywhere"
        )


class Watch:
    """Ends this process where something takes too long: it is tried elsewhere."""

    def __init__(self) -> None:
        self._until: dict[int, float] = {}  # by thread
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin to look; only in processes that somebody restarts."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._look, daemon=True, name="task-watch")
            self._thread.start()

    @contextlib.contextmanager
    def over(self, limit: float) -> Iterator[None]:
        """What this thread does meanwhile may take `limit` [s]."""
        me = threading.get_ident()
        self._until[me] = time.monotonic() + limit
        try:
            yield
        finally:
            del self._until[me]

    def _look(self) -> None:
        while True:
            time.sleep(_LOOK)
            if time.monotonic() > min(self._until.copy().values(), default=float("inf")):
                os._exit(3)


_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3  # of glibc's mallopt

watch = Watch()
_cancelled: set[str] = set()  # keys of tasks at work here that nobody wants any more


def is_cancelled(key: str) -> bool:
    """Whether nobody waits any more for the task that runs here under this key."""
    return key in _cancelled


def _keep_memory() -> None:
    """Keep up to 64 MB between plans, where the C library can be told so (glibc).

    Dask starts workers with MALLOC_TRIM_THRESHOLD_=65536: whatever a plan frees goes back to the
    system, and the next plan faults it in again, page by page, for 4 to 7 % of its time.
    """
    tell = getattr(ctypes.CDLL(None), "mallopt", None)
    if tell is not None:
        tell(_TRIM_THRESHOLD, 64 << 20)
        tell(_MMAP_THRESHOLD, 32 << 20)


class CorePlugin:
    """Loads the core before the first task, and keeps the worker out of the way of others.

    A Dask `WorkerPlugin` by its methods: this module needs no Dask.
    """

    name = "stairwright-core"
    idempotent = True

    def setup(self, worker: Worker) -> None:
        """Called once on every worker, new ones included."""
        from stairwright.jobs.warming import GENTLE
        from stairwright.planning.planner import plan

        with contextlib.suppress(OSError, AttributeError):
            os.nice(max(0, NICENESS - os.nice(0)))
        _keep_memory()
        plan(GENTLE)  # brings everything into memory
        gc.freeze()  # a collector that looks at all of that takes 7 % of what a plan does
        if worker.nanny is not None:
            watch.start()

    def transition(self, key: Any, start: str, finish: str, **_: Any) -> None:
        """Called by Dask whenever a task changes its state.

        A task that runs cannot be stopped from outside; it is told, and stops by itself.
        """
        if start == "executing" and finish == "released":
            _cancelled.add(str(key))
        elif start == "cancelled":
            _cancelled.discard(str(key))
