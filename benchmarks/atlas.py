"""The atlas: how high, on what and how loaded every preset robot climbs, as boundary studies.

    python benchmarks/atlas.py [--workers 2] [--robots go2w b2w] [--draw] [--check 20]

Studies are kept in the data folder, so a run that was interrupted goes on. Writes docs/atlas.csv,
docs/images/atlas-*.svg and the tables between the marks in docs/atlas.md; `--draw` only draws what
docs/atlas.csv holds, and `--check` asks the planner of today about some borders of it.
"""

from __future__ import annotations

import argparse
import csv
import math
import random
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from atlas_pages import write
from atlas_studies import DOCS, studies_of

import stairwright as sw
from stairwright.library import robots
from stairwright.planning.planner import plan

TABLE = DOCS / "atlas.csv"
FIELDS = (
    "map", "robot", "x", "friction", "border", "beyond", "reason", "needs", "monotone", "asked",
)  # fmt: skip
Row = dict[str, Any]


def rows_of(map_name: str, robot: str, data: Any) -> Iterator[Row]:
    """A study's rows as they are kept; x is the tread [m] where there is one, else the friction."""
    stacked = data.stack(row=list(data.boundary.dims)) if data.boundary.ndim > 1 else data
    over = "row" if data.boundary.ndim > 1 else data.boundary.dims[0]
    for k in range(stacked.sizes[over]):
        here = stacked.isel({over: k})
        friction = float(here.friction)
        yield {
            "map": map_name,
            "robot": robot,
            "x": float(here["stairs.tread"]) if map_name == "stairs" else friction,
            "friction": friction,
            "border": float(here.boundary),
            "beyond": float(here.beyond),
            "reason": str(here.reason.values),
            "needs": str(here.quantity.values),
            "monotone": int(here.monotone),
            "asked": int(here.asked),
        }


def compute(names: Sequence[str], workers: int | None) -> list[Row]:
    """Every robot's studies."""
    out: list[Row] = []
    for name in names:
        for map_name, asked in studies_of(name):
            begun = time.perf_counter()
            document = {"schema": "stairwright/study/1", "robot": name, **asked}
            result = sw.study(document, workers=workers)
            rows = list(rows_of(map_name, name, result.dataset))
            out += rows
            cells = sum(row["asked"] for row in rows)
            print(
                f"{name} {map_name}: {cells} cells, {time.perf_counter() - begun:.0f} s", flush=True
            )
    return out


def save(rows: Sequence[Row], names: Sequence[str]) -> None:
    """Take these robots' rows into the table."""
    kept = [row for row in load() if row["robot"] not in names] if TABLE.exists() else []
    order = {name: k for k, name in enumerate(robots())}
    both = sorted([*kept, *rows], key=lambda row: order.get(str(row["robot"]), 99))
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        for row in both:
            short = {k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()}
            writer.writerow(short)


def load() -> list[Row]:
    """The table as it is kept."""
    with TABLE.open(newline="", encoding="utf-8") as file:
        return [
            {k: v if k in ("map", "robot", "reason", "needs") else float(v) for k, v in row.items()}
            for row in csv.DictReader(file)
        ]


def check(count: int) -> None:
    """Ask about both sides of `count` borders of the table, drawn at random but each time alike."""
    rows = [
        row for row in load() if not math.isnan(row["border"]) and not math.isnan(row["beyond"])
    ]
    moved = 0
    for row in random.Random(0).sample(rows, min(count, len(rows))):
        asked = dict(studies_of(row["robot"]))[row["map"]]
        axes = []
        for axis in asked["axes"]:
            at = [row["friction"]] if axis["name"] == "friction" else [row["x"]]
            axes.append({"name": axis["name"], "values": at})
            if "boundary" in axis:
                axes[-1]["values"] = [row["border"], row["beyond"]]
        document = {
            "schema": "stairwright/study/1", "robot": row["robot"], **asked, "axes": axes,
            "diagnose": "none",
        }  # fmt: skip
        with tempfile.TemporaryDirectory() as folder:
            found = sw.study(document, workers=1, store=Path(folder) / "c.zarr")
            passes = [bool(each) for each in found.dataset.feasible.values.ravel()]
        place = f"{row['map']} {row['robot']} at {row['x']:g}, friction {row['friction']:g}"
        if passes != [True, False]:
            moved += 1
            now = ["it passes" if each else "it fails" for each in passes]
            print(f"{place}: at {row['border']:g} {now[0]}, at {row['beyond']:g} {now[1]}",
                  flush=True)  # fmt: skip
    print(f"{moved} of {min(count, len(rows))} borders have moved")


def main() -> None:
    """Compute, draw, write."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--workers", type=int)
    parser.add_argument("--robots", nargs="+", default=robots())
    parser.add_argument("--draw", action="store_true", help="draw what is there")
    parser.add_argument("--check", type=int, metavar="N", help="try N borders of the table")
    given = parser.parse_args()
    if given.check:
        check(given.check)
        return
    if not given.draw:
        plan("flat")
        save(compute(given.robots, given.workers), given.robots)
    write([row for row in load() if not math.isnan(row["x"])])


if __name__ == "__main__":
    main()
