"""`study`: one door to all studies, from Python and the command line."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stairwright.arguments import as_whole
from stairwright.resources import all_cores

from .document import Study, check_budget, study_id
from .packages import check_packages
from .question import Questions, check_axes
from .resolve import load_study
from .serial import Engine, SerialEngine, Stopped
from .version import engine_of

if TYPE_CHECKING:
    import xarray as xr

    from .progress import Report
    from .store import ResultStore

BUDGET = 1_000_000
MOST_WORKERS = 1024


class StudyResult:
    """What came of a study.

    Attributes:
        id: Content hash of the study and of the planner's version.
        document: The study, its names resolved.
        path: The Zarr group that holds it.
    """

    def __init__(self, store: ResultStore) -> None:
        self._store = store
        self.id = store.id
        self.document = store.study
        self.path = store.path

    @cached_property
    def dataset(self) -> xr.Dataset:
        """All variables over the axes, in memory; those of a border where there is a boundary."""
        from .dataset import dataset_of

        return dataset_of(self._store)

    @property
    def complete(self) -> bool:
        """Whether everything that was asked for is known."""
        from .fill import is_complete

        return is_complete(self._store)

    def counts(self) -> dict[str, int]:
        """How many cells are pending, done, refused and failed."""
        return self._store.counts()

    def save(self, path: str | Path) -> None:
        """Write the dataset; the ending picks the format (zarr, nc, csv).

        Raises:
            InputError: If the ending is unknown or the place cannot be written.
        """
        from .dataset import save

        save(self.dataset, path)


def study(
    document: str | Path | Mapping[str, Any] | Study,
    scheduler: str | None = None,
    workers: int | None = None,
    *,
    store: str | Path | None = None,
    budget: int = BUDGET,
    retry: bool = False,
    progress: Report | None = None,
    stopped: Stopped = lambda: False,
) -> StudyResult:
    """Carry out a study, or go on with it where an earlier call ended.

    Args:
        document: A file, a mapping or a `Study`.
        scheduler: Address of a Dask scheduler; STAIRWRIGHT_SCHEDULER by default, else processes
            of this machine.
        workers: How many processes; 1 computes in this one, all cores by default.
        store: Where results are kept (a folder that ends in .zarr); in the data folder by default.
        budget: Plans, rollouts or trials that it may take.
        retry: Try failed cells again.
        progress: Called with a `Progress` as cells are done.
        stopped: Asked between batches; what was computed until then is kept.

    Raises:
        InputError: If the document or an argument is bad, or packages are missing.
    """
    check_packages()
    from .fill import fill, is_complete

    chosen = prepared(document, budget)
    if workers is not None:
        workers = as_whole(workers, 1, MOST_WORKERS, "workers")
    kept = open_store(chosen, None if store is None else Path(store))
    if retry:
        kept.forget_failures()
    if not is_complete(kept):
        engine = choose_engine(scheduler, workers)
        try:
            with kept.writing():
                fill(kept, engine, progress, stopped)
        finally:
            engine.close()
    return StudyResult(kept)


def prepared(document: str | Path | Mapping[str, Any] | Study, budget: int = BUDGET) -> Study:
    """The study with names resolved, refused if it is too much or an axis makes no question.

    Raises:
        InputError: With the field that is wrong.
    """
    chosen = load_study(document)
    check_budget(chosen, budget, "the budget")
    check_axes(Questions(chosen))
    return chosen


def open_store(study: Study, path: Path | None) -> ResultStore:
    """The store of a study: as it was left, or a new one that takes over what others know.

    Raises:
        InputError: If `path` holds something else.
    """
    from .keeping import kept_store

    return kept_store(study, study_id(study, engine_of(study)), engine_of(study), path)


def choose_engine(scheduler: str | None, workers: int | None) -> Engine:
    """Who evaluates the cells: Dask's workers, or this process where one worker was asked for.

    Raises:
        InputError: If packages are missing.
    """
    address = scheduler or os.environ.get("STAIRWRIGHT_SCHEDULER") or None
    count = all_cores() if workers is None else workers
    if address is None and count == 1:
        return SerialEngine()
    check_packages()
    from .cluster import ClusterEngine

    return ClusterEngine(address, count)
