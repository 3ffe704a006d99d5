"""What `stairwright study` does: progress on the terminal, results in a file."""

from __future__ import annotations

import argparse
import signal
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stairwright.errors import InputError
from stairwright.summary import columns

from .packages import check_packages
from .study import BUDGET, StudyResult, study

if TYPE_CHECKING:
    from .design_result import DesignResult
    from .progress import Progress


def run_study(given: argparse.Namespace) -> str | None:
    """Carry out the study in a file; returns why it is not complete, if it is not."""
    check_packages()
    output = None if given.output is None else Path(given.output)
    if output is not None:
        from .dataset import check_ending

        check_ending(output)
    kept_there = output is not None and output.suffix.lower() == ".zarr"
    with Interruption() as stop:
        result = study(
            given.file,
            scheduler=given.scheduler,
            workers=given.workers,
            store=output if kept_there else None,
            budget=_budget(given),
            retry=given.retry,
            progress=_show if sys.stderr.isatty() else None,
            stopped=lambda: stop.asked,
        )
    if sys.stderr.isatty():
        print(file=sys.stderr)
    print(summary(result))
    if output is not None and not kept_there:
        result.save(output)
    if not result.complete:
        return "interrupted: what is done is kept, and the same command goes on with it"
    return None


def run_design(given: argparse.Namespace) -> str | None:
    """Carry out the design study in a file; returns why there is no answer, if there is none."""
    check_packages()
    from .design import design

    output = None if given.output is None else Path(given.output)
    if output is not None and output.suffix.lower() != ".json":
        raise InputError("designs can be written as .json only", ("output",))

    def show(done: int, total: int) -> None:
        print(f"\r{done:,} of {total:,} designs", end="", file=sys.stderr, flush=True)

    with Interruption() as stop:
        result = design(
            given.file,
            scheduler=given.scheduler,
            workers=given.workers,
            budget=_budget(given),
            progress=show if sys.stderr.isatty() else None,
            stopped=lambda: stop.asked,
        )
    if sys.stderr.isatty():
        print(file=sys.stderr)
    print(design_summary(result))
    if output is not None:
        result.save(output)
    if not result.complete:
        return "interrupted: what was tried is kept, and the same command goes on with it"
    return None if result.front else "no design passes"


def design_summary(result: DesignResult) -> str:
    """How many were tried, and the best ones."""
    passed = sum(each.passed for each in result.candidates)
    rows = [
        ("design", result.design.name or result.id),
        ("tried", f"{len(result.candidates):,}, of which {passed:,} pass"),
    ]
    for each in result.front:
        aims = ", ".join(f"{name} {value:.4g}" for name, value in each.aims.items())
        values = ", ".join(f"{name} {value:.4g}" for name, value in each.values.items())
        rows.append(("best", f"{aims}  ({values})"))
    return columns(rows)


def _budget(given: argparse.Namespace) -> int:
    budget: int = BUDGET if given.budget is None else given.budget
    if budget < 1:
        raise InputError("must be at least 1", ("budget",))
    return budget


class Interruption:
    """Ctrl-C asks to end after what is at work now; a second one ends at once."""

    def __init__(self) -> None:
        self.asked = False

    def __enter__(self) -> Interruption:
        self._before = signal.signal(signal.SIGINT, self._ask)
        return self

    def __exit__(self, *_: object) -> None:
        signal.signal(signal.SIGINT, self._before)

    def _ask(self, *_: object) -> None:
        self.asked = True
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _show(progress: Progress) -> None:
    left = "" if progress.left is None else f", about {progress.left:.0f} s left"
    line = f"{progress.done:,} of {progress.total:,} cells{left}"
    print(f"\r{line:<60}", end="", file=sys.stderr, flush=True)


def summary(result: StudyResult) -> str:
    """What was asked and what came of it, in a few lines."""
    axes = [
        f"{axis.name} {axis.points[0]} to {axis.points[-1]} ({len(axis.points)} values)"
        for axis in result.document.axes
    ]
    counts = result.counts()
    rows = [("study", result.document.name or result.id)]
    rows += [("axis", line) for line in axes]
    rows.append(("cells", ", ".join(f"{n:,} {name}" for name, n in counts.items() if n)))
    data = result.dataset
    feasible = int(data["feasible"].sum())
    rows.append(("feasible", f"{feasible:,} of {counts['done']:,}"))
    reasons = Counter(np.asarray(data["reason"].values, object).ravel().tolist())
    reasons.pop("", None)
    rows += [("stopped by", f"{name} {n:,}") for name, n in reasons.most_common()]
    rows.append(("kept in", str(result.path)))
    return columns(rows)
