"""What every benchmark has in common: rows of figures, one table, one JSON file."""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path


@dataclass(frozen=True)
class Row:
    """One line of a table.

    Attributes:
        work: What was done, e.g. "two poses, 0.36 m stair".
        name: Who did it, e.g. "stairwright" or "SciPy SLSQP, exact".
        median: Of the repeats, None for a peer that is missing or a figure without repeats.
        p95: 95th percentile of the repeats.
        unit: Of both.
        ratio: Median over Stairwright's in the same run; 1 for Stairwright itself.
        solved: Share of the tasks that were solved, as text.
        note: Whatever else matters, e.g. that a peer is not installed.
    """

    work: str
    name: str
    median: float | None = None
    p95: float | None = None
    unit: str = "ms"
    ratio: float | None = None
    solved: str = ""
    note: str = ""


def percentile(values: Sequence[float], share: float) -> float:
    """The value that `share` of all do not exceed (nearest rank); NaN for none."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)] if ordered else math.nan


def times(task: Callable[[], object], repeat: int) -> list[float]:
    """Wall-clock times of `task` [ms]."""
    out = []
    for _ in range(repeat):
        begun = time.perf_counter()
        task()
        out.append(1e3 * (time.perf_counter() - begun))
    return out


def row(work: str, name: str, measured: Sequence[float], ours: float | None = None) -> Row:
    """A row from repeats [ms]; `ours` is Stairwright's median for the ratio."""
    median = statistics.median(measured)
    return Row(work, name, median, percentile(measured, 0.95), ratio=median / (ours or median))


def machine() -> dict[str, str | int]:
    """The machine that measured."""
    return {
        "processor": _processor(),
        "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 0,
        "system": platform.system(),
        "python": platform.python_version(),
        "load": f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown",
    }


def _processor() -> str:
    facts = Path("/proc/cpuinfo")
    if facts.is_file():
        for line in facts.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def table(rows: Iterable[Row]) -> str:
    """The rows as a Markdown table."""
    lines = [
        "| work | by | median | p95 | ratio | solved | note |",
        "|---|---|---|---|---|---|---|",
    ]
    for r in rows:
        cells = (r.work, r.name, _figure(r.median, r.unit), _figure(r.p95, r.unit))
        ratio = "" if r.ratio is None else f"{r.ratio:.3g}"
        lines.append("| " + " | ".join((*cells, ratio, r.solved, r.note)) + " |")
    return "\n".join(lines)


def _figure(value: float | None, unit: str) -> str:
    if value is None:
        return ""
    return f"{value:.0f} {unit}" if abs(value) >= 100 else f"{value:.3g} {unit}"


def publish(rows: Sequence[Row], path: str | None = None) -> None:
    """Print the table; with `path` also write JSON."""
    print(table(rows))
    if path is not None:
        content = {"machine": machine(), "rows": [asdict(r) for r in rows]}
        Path(path).write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
        print(f"wrote {path}", file=sys.stderr)


def command(about: str | None, run: Callable[[bool], list[Row]]) -> None:
    """The command line of a benchmark without options of its own; `about` is its docstring."""
    parser = argparse.ArgumentParser(description=(about or "").splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few repeats")
    parser.add_argument("--json", help="write machine and rows to this file too")
    given = parser.parse_args()
    publish(run(given.quick), given.json)
