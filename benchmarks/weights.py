"""What the weights of the path planner do: each to its own quantity, and two against each other.

    python benchmarks/weights.py [--terrains 50] [--draw]

Prints, over drawn profiles, how far each weight moves its quantity from 0.01 over 1 to 100 and how
often it worsens it. With `--draw` the front of CoM margin and clearance (docs/method.md) is drawn
to docs/images/weights.svg.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))  # tests.planning.drawn

import stairwright as sw  # noqa: E402
from stairwright.planning.attempt import Solved  # noqa: E402
from stairwright.planning.path_planner import path_planner  # noqa: E402
from stairwright.planning.standing import NoStandingPose  # noqa: E402
from stairwright.planning.strategy import solve  # noqa: E402
from stairwright.planning.threads import search_threads  # noqa: E402
from stairwright.planning.weights import PathWeights  # noqa: E402
from stairwright.terrain.profile import Terrain  # noqa: E402
from tests.planning.drawn import random_profile  # noqa: E402

STEPS = (0.01, 1.0, 100.0)
FIRST = 400  # seed; the slow test of the weights draws the same
# A quantity's least value that leaves room to make it smaller, and how it is written.
TERMS = {
    "com_margin": (1e-3, 1e3, "mm"),
    "clearance": (2e-3, 1e3, "mm"),
    "torque": (0.02, 1e2, "%"),
    "smoothness": (1.1, 1.0, "1"),
    "pitch": (0.02, 1e3, "mrad"),
}
ROUGH = 1.05  # the lattice's tolerance
IMAGE = HERE.parent / "docs" / "images" / "weights.svg"
FRONT = {"stairs-building": "#2E86D1", "single-stair-036": "#D55E00", "curb-015": "#009E73"}
INK = "#7d8590"  # reads on white and on dark


def quantities(terrain: Terrain, robot: str, **weights: float) -> dict[str, float] | None:
    """The quantity of each weight along the path; None without one."""
    try:
        planner = path_planner(terrain, sw.load_robot(robot), 0.6, PathWeights(**weights))
    except NoStandingPose:
        return None
    found = solve(planner, search_threads())
    return planner.cost_terms(found.nodes) if isinstance(found, Solved) else None


def line(term: str, count: int) -> str:
    """One weight over `count` drawn profiles."""
    room, scale, unit = TERMS[term]
    rows: list[list[float]] = []
    for seed in range(FIRST, FIRST + count):
        robot = ("a1_wheeled", "a1_wheeled_x")[seed % 2]
        found = [quantities(random_profile(seed), robot, **{term: w}) for w in STEPS]
        if all(found):
            rows.append([one[term] for one in found if one])
    worse = sum(any(b > ROUGH * a + 0.1 * room for a, b in pairwise(row)) for row in rows)
    roomy = [row for row in rows if row[0] > room]
    moved = sum(row[2] < 0.9 * row[0] for row in roomy)
    middle = [statistics.median(column) * scale for column in zip(*rows, strict=True)]
    cells = (f"`{term}`", *(f"{value:.3g} {unit}" for value in middle))
    return f"| {' | '.join(cells)} | {worse} of {len(rows)} | {moved} of {len(roomy)} |"


def front(terrain: Terrain) -> list[tuple[float, float]]:
    """What CoM margin and clearance lack [mm], the weights' ratio from 1e-4 to 1e4."""
    found = []
    for k in range(-8, 9):
        ratio = 10.0 ** (k / 4)
        one = quantities(terrain, "a1_wheeled", com_margin=ratio, clearance=1.0 / ratio)
        if one:
            found.append((1e3 * one["com_margin"], 1e3 * one["clearance"]))
    return found


def draw(fronts: dict[str, Sequence[tuple[float, float]]]) -> None:
    """The fronts, one line a terrain; hollow where another path of it is better in both."""
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams.update({
        "svg.hashsalt": "stairwright", "font.size": 9, "text.color": INK, "axes.labelcolor": INK,
        "axes.edgecolor": INK, "xtick.color": INK, "ytick.color": INK,
    })  # fmt: skip
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6, 3.6), layout="constrained")
    for (name, points), marker in zip(fronts.items(), "osD", strict=False):
        x, z = zip(*points, strict=True)
        best = [not any(a < p[0] - 1e-9 and b < p[1] - 1e-9 for a, b in points) for p in points]
        colour = FRONT[name]
        axes.plot(x, z, color=colour, ls="", marker=marker, ms=4, mfc="none", alpha=0.6)
        on = sorted({p for p, good in zip(points, best, strict=True) if good})
        axes.plot(*zip(*on, strict=True), color=colour, lw=1.2, marker=marker, ms=5, label=name)
    axes.set_xlabel("CoM margin lacks, mm rms")
    axes.set_ylabel("clearance lacks, mm rms")
    axes.grid(color=INK, alpha=0.25, lw=0.6)
    axes.legend(frameon=False)
    figure.savefig(IMAGE, transparent=True, metadata={"Date": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--terrains", type=int, default=50)
    parser.add_argument("--draw", action="store_true", help=f"write {IMAGE.name}")
    given = parser.parse_args()
    print("| weight | quantity at 0.01 | at 1 | at 100 | worse | 10 % less where there is room |")
    print("|---|---|---|---|---|---|")
    for term in TERMS:
        print(line(term, given.terrains), flush=True)
    if given.draw:
        draw({name: front(sw.load_terrain(name)) for name in FRONT})
        print(f"wrote {IMAGE}", file=sys.stderr)


if __name__ == "__main__":
    main()
