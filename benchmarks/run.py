"""Every benchmark in one go, each in a process of its own.

    python benchmarks/run.py [NAME ...] [--quick] [--keep FOLDER]

Prints each table, writes the figures as JSON and a plot of the ratios, and renews the tables in
docs/performance.md. When only some are named, the others keep the figures that they have. With
`--quick`, a smoke test of minutes, the document is left alone.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from report import Row, table

HERE = Path(__file__).parent
DOCUMENT = HERE.parent / "docs" / "performance.md"
PLOT = HERE.parent / "docs" / "images" / "performance.svg"
FIGURES = HERE / "performance.json"
TITLES = {
    "poses": "One pose",
    "paths": "Certified paths",
    "rollouts": "Rollouts",
    "qp": "The balance controller's QP",
    "page": "The page for somebody who opens it first",
    "drag": "The page while a corner is dragged",
    "start": "From start to first plan",
    "memory": "Memory",
    "engines": "The same plans in other physics engines",
}


def measure(name: str, folder: Path, quick: bool) -> dict[str, Any] | None:
    """What one benchmark wrote, None if it failed."""
    target = folder / f"{name}.json"
    command = [sys.executable, str(HERE / f"{name}.py"), "--json", str(target)]
    print(f"\n## {TITLES[name]}\n", flush=True)
    ended = subprocess.run([*command, "--quick"] if quick else command, check=False)
    if ended.returncode != 0 or not target.is_file():
        print(f"{name}: failed with status {ended.returncode}", file=sys.stderr)
        return None
    found: dict[str, Any] = json.loads(target.read_text(encoding="utf-8"))
    return found


def renew(document: str, results: Mapping[str, Mapping[str, Any]]) -> str:
    """The document with the tables between its `figures` marks replaced."""
    facts = next(iter(results.values()))["machine"]
    lines = [f"Measured on {facts['cores']} cores of {facts['processor']}, {facts['system']}."]
    for name, result in results.items():
        lines += ["", f"### {TITLES[name]}", "", table(Row(**row) for row in result["rows"])]
    body = "\n".join(["<!-- figures -->", *lines, "<!-- end of figures -->"])
    return re.sub(
        "<!-- figures -->.*<!-- end of figures -->", lambda _: body, document, flags=re.DOTALL
    )


def draw(results: Mapping[str, Mapping[str, Any]], path: Path) -> None:
    """Ratios to Stairwright in the same run, one bar a peer, on a logarithmic axis."""
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams["svg.hashsalt"] = "stairwright"
    from matplotlib import pyplot

    bars = [
        (f"{row['work']}: {row['name']}", row["ratio"])
        for result in results.values()
        for row in result["rows"]
        if row["ratio"] not in (None, 0) and row["name"] and not 0.999 < row["ratio"] < 1.001
    ]
    figure, axes = pyplot.subplots(figsize=(9, 0.8 + 0.24 * len(bars)), layout="constrained")
    labels, ratios = [bar[0] for bar in bars], [bar[1] for bar in bars]
    axes.barh(labels, ratios, color=["#0072B2" if r > 1 else "#D55E00" for r in ratios])
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.axvline(1.0, color="0.3", linewidth=1)
    axes.set_xlabel("time over Stairwright's in the same run")
    axes.tick_params(labelsize=7)
    axes.grid(axis="x", alpha=0.3)
    figure.savefig(path, metadata={"Date": None})


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", metavar="NAME", nargs="*", help=f"of {', '.join(TITLES)}")
    parser.add_argument("--quick", action="store_true", help="few repeats")
    parser.add_argument("--keep", type=Path, help="keep each benchmark's JSON here")
    given = parser.parse_args()
    if unknown := set(given.names) - set(TITLES):
        parser.error(f"no such benchmark: {', '.join(sorted(unknown))}")
    names = given.names or list(TITLES)
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        results = {name: measure(name, folder, given.quick) for name in names}
    done = {name: result for name, result in results.items() if result is not None}
    if done and not given.quick:
        before = json.loads(FIGURES.read_text(encoding="utf-8")) if FIGURES.is_file() else {}
        known = before | done
        figures = {name: known[name] for name in TITLES if name in known}
        FIGURES.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
        DOCUMENT.write_text(renew(DOCUMENT.read_text(encoding="utf-8"), figures), encoding="utf-8")
        draw(figures, PLOT)
        print(f"\nwrote {DOCUMENT}, {PLOT} and {FIGURES}", file=sys.stderr)
    return 0 if len(done) == len(names) else 1


if __name__ == "__main__":
    sys.exit(main())
