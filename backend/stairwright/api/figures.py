"""Figures that are looked up when somebody asks: memory, disk, what is stored, dead workers."""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from stairwright.jobs.pool import WorkerPool
from stairwright.storage.store import DATABASE, Store

_PREFIX = "stairwright_"


class Figures(Collector):
    """For a registry of Prometheus'. Reads the database and /proc: not for an event loop."""

    def __init__(
        self, store: Store, pools: Sequence[WorkerPool], is_ready: Callable[[], bool]
    ) -> None:
        self._store = store
        self._pools = pools
        self._is_ready = is_ready

    def describe(self) -> Iterable[Metric]:
        """Nothing is looked up only to be registered."""
        return []

    def collect(self) -> Iterator[Metric]:
        """All of them now."""
        deaths = CounterMetricFamily(
            f"{_PREFIX}worker_deaths", "Workers that ended by themselves", labels=("pool",)
        )
        for pool in self._pools:
            deaths.add_metric((pool.name,), pool.deaths)
        yield deaths
        yield _gauge("ready", "Whether a plan was answered", float(self._is_ready()))
        yield _gauge("read_only", "Whether nothing can be saved", self._store.read_only is not None)
        stored, results = self._store.documents.totals()
        count = GaugeMetricFamily(f"{_PREFIX}results", "Stored results", labels=("kind",))
        for kind, number in stored.items():
            count.add_metric((kind,), number)
        yield count
        used = GaugeMetricFamily(f"{_PREFIX}disk_bytes", "Space taken", labels=("by",))
        used.add_metric(("results",), results)
        used.add_metric(("database",), _database_size(self._store.folder / DATABASE))
        yield used
        with contextlib.suppress(OSError):
            free = shutil.disk_usage(self._store.folder).free
            yield _gauge("disk_free_bytes", "Space left for the data folder", free)
        memory = GaugeMetricFamily(
            f"{_PREFIX}memory_bytes", "Memory held, shared pages divided", labels=("by",)
        )
        memory.add_metric(("service",), _memory(os.getpid()))
        memory.add_metric(("workers",), sum(map(_memory, _descendants(os.getpid()))))
        yield memory


def _gauge(name: str, text: str, value: float) -> GaugeMetricFamily:
    return GaugeMetricFamily(f"{_PREFIX}{name}", text, value)


def _database_size(database: Path) -> int:
    files = (database, database.with_name(f"{database.name}-wal"))
    return sum(file.stat().st_size for file in files if file.is_file())


def _memory(process: int) -> int:
    """Bytes of a process, pages that it shares with n others counted as 1/n; 0 where unknown."""
    with contextlib.suppress(OSError):
        for line in Path(f"/proc/{process}/smaps_rollup").read_text("ascii").splitlines():
            name, _, rest = line.partition(":")
            if name == "Pss":
                return int(rest.split()[0]) * 1024
    return 0


def _descendants(process: int) -> set[int]:
    """Process ids below one, where the system tells (Linux)."""
    parents: dict[int, int] = {}
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):  # ended meanwhile
            fields = (entry / "stat").read_text("utf-8", "replace").rpartition(")")[2].split()
            parents[int(entry.name)] = int(fields[1])
    below: set[int] = set()
    layer = {process}
    while layer:
        layer = {each for each, parent in parents.items() if parent in layer}
        below |= layer
    return below
