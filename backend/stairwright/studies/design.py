"""`design`: one door to all design studies, from Python and the command line.

Designs come in generations of a fixed size, each one study over its robots: the same document gives
the same designs whoever computes them, and one that was interrupted is replayed from its stores.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from stairwright.documents import load_document, parse
from stairwright.library import load_robot, load_terrain

from .design_document import Design, design_id
from .design_resolve import resolved_design
from .design_result import DesignResult
from .packages import check_packages
from .progress import Progress
from .serial import Stopped
from .study import BUDGET, choose_engine
from .version import engine_of


def design(
    document: str | Path | Mapping[str, Any] | Design,
    scheduler: str | None = None,
    workers: int | None = None,
    *,
    store: str | Path | None = None,
    budget: int = BUDGET,
    progress: Callable[[int, int], None] | None = None,
    stopped: Stopped = lambda: False,
) -> DesignResult:
    """Look for the best dimensions of a robot within bounds.

    Args:
        document: A file, a mapping or a `Design`.
        scheduler: Address of a Dask scheduler, see `study`.
        workers: How many processes, see `study`.
        store: Folder of what was tried; in the data folder by default.
        budget: Plans, rollouts or trials that it may take.
        progress: Called with the designs that were tried and that are to be.
        stopped: Asked now and then; what was tried until then is kept.

    Raises:
        InputError: If the document or an argument is bad, or packages are missing.
    """
    check_packages()
    from .design_search import search
    from .keeping import studies_folder

    chosen = prepared_design(document, budget)
    name = design_id(chosen, engine_of(chosen.ask))
    folder = studies_folder() / name if store is None else Path(store)
    engine = choose_engine(scheduler, workers)

    done = 0

    def report(now: Progress) -> None:
        nonlocal done
        if progress is not None and now.done > done:
            done = now.done
            progress(done, now.total)

    try:
        return search(chosen, engine, folder, report, stopped)
    finally:
        engine.close()


def prepared_design(
    document: str | Path | Mapping[str, Any] | Design, budget: int = BUDGET
) -> Design:
    """The design with names resolved, refused if it is too much or makes no question.

    Raises:
        InputError: With the field that is wrong.
    """
    if isinstance(document, Design):
        chosen = document
    elif isinstance(document, Mapping):
        chosen = parse(Design, dict(document))
    else:
        chosen = load_document(Design, Path(document))
    return resolved_design(chosen, load_terrain, load_robot, budget, "the budget")
