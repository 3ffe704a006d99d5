"""Studies: what a cell costs beyond its plan, how far workers help, and what boundaries save.

    python benchmarks/studies.py [--cells 1000] [--robot a1_wheeled] [--rise 0.06 0.9]

Processor time says what work costs on a machine that others use too; wall time what one waits.
Every line can be run alone: overhead, workers, boundary, again.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import stairwright as sw
from stairwright.planning.planner import plan
from stairwright.studies import cell


def study_of(cells: int, robot: str, rise: Sequence[float]) -> dict[str, Any]:
    """Rise x tread x friction: about so many cells, the shape of 31 x 27 x 12."""
    scale = (cells / (31 * 27 * 12)) ** (1 / 3)
    counts = [max(2, round(n * scale)) for n in (31, 27, 12)]
    return {
        "schema": "stairwright/study/1",
        "robot": robot,
        "axes": [
            {"name": "stairs.rise", "from": rise[0], "to": rise[1], "count": counts[0]},
            {"name": "stairs.tread", "from": 0.2, "to": 0.46, "count": counts[1]},
            {"name": "friction", "from": 0.2, "to": 0.9, "count": counts[2]},
        ],
    }


def timed(work: Callable[[], Any]) -> tuple[float, float, Any]:
    """Wall time, processor time of this process and its children that ended [s], and the result."""

    def spent() -> float:
        both = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
        usages = [resource.getrusage(who) for who in both]
        return sum(usage.ru_utime + usage.ru_stime for usage in usages)

    wall, processor = time.perf_counter(), spent()
    result = work()
    return time.perf_counter() - wall, spent() - processor, result


def overhead(document: dict[str, Any], folder: Path) -> None:
    """Processor time of a study in one process, and how much of it its plans take."""
    first = [{"name": axis["name"], "values": [axis["from"]]} for axis in document["axes"]]
    one = sw.study(document | {"axes": first}, workers=1, store=folder / "first.zarr")
    one.counts(), one.dataset  # what is imported here is no cell's
    within = 0.0

    def timed_plan(*args: Any, **options: Any) -> Any:
        nonlocal within
        begun = time.process_time()
        made = plan(*args, **options)
        within += time.process_time() - begun
        return made

    cell.make_plan = timed_plan
    place = folder / "o.zarr"
    begun = time.process_time()
    wall, _, result = timed(lambda: sw.study(document, workers=1, store=place))
    whole = time.process_time() - begun
    cell.make_plan = plan
    cells = result.counts()["done"]
    feasible = int(result.dataset.feasible.sum())
    print(
        f"overhead: {cells} cells, {feasible} feasible: {within / cells * 1e3:.1f} ms of processor "
        f"a plan, {whole / cells * 1e3:.1f} ms a cell: {(whole / within - 1) * 100:+.2f} % "
        f"({wall:.1f} s wall)",
        flush=True,
    )


def workers(document: dict[str, Any], folder: Path, counts: Sequence[int]) -> None:
    """The same study by so many processes; rates without the first seconds, when they start."""
    for count in counts:
        marks: list[tuple[float, int]] = []

        def note(progress: Any, marks: list[tuple[float, int]] = marks) -> None:
            marks.append((time.perf_counter(), progress.done))

        place = folder / f"w{count}.zarr"
        wall, processor, _ = timed(
            lambda c=count, p=place, n=note: sw.study(document, workers=c, store=p, progress=n)
        )
        late = [each for each in marks if each[0] > marks[0][0] + 8.0]
        steady = (late[-1][1] - late[0][1]) / (late[-1][0] - late[0][0]) if len(late) > 1 else 0
        print(
            f"workers: {count}: {wall:.1f} s wall, {processor:.1f} s of processor, "
            f"{steady:.1f} cells/s once all are at work",
            flush=True,
        )


def boundary(document: dict[str, Any], folder: Path) -> None:
    """Rise as a boundary against the whole grid."""
    axes = document["axes"]
    rise = axes[0]
    step = (rise["to"] - rise["from"]) / (rise["count"] - 1)
    edge = {"name": rise["name"], "boundary": [rise["from"], rise["to"]], "tolerance": step}
    wall, processor, full = timed(lambda: sw.study(document, workers=1, store=folder / "g.zarr"))
    quick = document | {"axes": [edge, *axes[1:]]}
    less, saved, found = timed(lambda: sw.study(quick, workers=1, store=folder / "b.zarr"))
    feasible = full.dataset.feasible.values
    values = full.dataset[rise["name"]].values
    # from the low end, the last rise before the first that fails
    runs = np.where(feasible.all(axis=0), len(values), feasible.argmin(axis=0))
    truth = np.where(runs > 0, values[np.maximum(runs - 1, 0)], np.nan)
    own = found.dataset.boundary.values
    off = np.abs(np.nan_to_num(own, nan=rise["from"] - step) -
                 np.nan_to_num(truth, nan=rise["from"] - step))  # fmt: skip
    asked = int(found.dataset.asked.sum())
    print(
        f"boundary: {asked} of {feasible.size} cells (1/{feasible.size / asked:.1f}), "
        f"{saved:.1f} of {processor:.1f} s of processor, {less:.1f} of {wall:.1f} s wall; "
        f"{(off <= step * 1.001).mean():.1%} of {off.size} rows within one step, "
        f"{(off < step / 2).mean():.1%} the same; rows not monotone: "
        f"{int((~found.dataset.monotone).sum())} told, "
        f"{int((np.abs(np.diff(feasible.astype(int), axis=0)).sum(axis=0) > 1).sum())} in the grid"
    )


def again(document: dict[str, Any], folder: Path) -> None:
    """A finished study asked once more."""
    place = folder / "a.zarr"
    sw.study(document, workers=1, store=place)
    wall, _, result = timed(lambda: sw.study(document, store=place).dataset)
    print(f"again: {result.feasible.size} cells, {wall:.2f} s")


def main() -> None:
    """Measure."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cells", type=int, default=1000)
    parser.add_argument("--robot", default="a1_wheeled")
    parser.add_argument("--rise", type=float, nargs=2, default=(0.06, 0.9))
    parser.add_argument("--diagnose", default="all", help="all or none of the cells without a way")
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    parser.add_argument("what", nargs="*", help="overhead, workers, boundary, again")
    given = parser.parse_args()
    document = study_of(given.cells, given.robot, given.rise) | {"diagnose": given.diagnose}
    chosen = given.what or ["overhead", "workers", "boundary", "again"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for what in chosen:
            if what == "workers":
                workers(document, folder, given.workers)
            else:
                {"overhead": overhead, "boundary": boundary, "again": again}[what](document, folder)


if __name__ == "__main__":
    main()
