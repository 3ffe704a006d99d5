"""Fill a store: what is pending is evaluated, written batch by batch, and told as it comes."""

from __future__ import annotations

import numpy as np

from .boundary import fill_boundary, searched_rows
from .grid import coarse_first
from .progress import Meter, Report
from .serial import Engine, Stopped
from .store import ResultStore
from .variables import PENDING
from .writer import Writer


def fill_grid(store: ResultStore, engine: Engine, report: Report | None, stopped: Stopped) -> None:
    """Evaluate all pending cells, coarse first."""
    pending = store.states.ravel() == PENDING
    order = coarse_first(store.study.axes)
    todo = order[pending[order]].tolist()
    meter = Meter(int((~pending).sum()), len(pending), report)
    meter.tell({})
    with Writer(store) as writer:
        for finished in engine.evaluate(store.study, todo, stopped) if todo else ():
            writer.add(finished)
            meter.tell(finished)


def fill(store: ResultStore, engine: Engine, report: Report | None, stopped: Stopped) -> None:
    """Evaluate what is pending and asked for: every cell, or those that a boundary takes."""
    if store.study.boundary_axis is None:
        fill_grid(store, engine, report, stopped)
    else:
        fill_boundary(store, engine, report, stopped)


def is_complete(store: ResultStore) -> bool:
    """Whether everything that was asked for is known."""
    if store.study.boundary_axis is None:
        return bool(np.all(store.states != PENDING))
    return searched_rows(store)[1]
