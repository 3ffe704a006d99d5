"""What it climbs: plans and rolls out every case of the results table.

    python benchmarks/results.py [--quick] [--write docs/results.md]

Each case runs with every robot and method at the stated friction; the 0.36 m stair also at a lower
friction and in randomised trials; random profiles in four ways. Prints Markdown; ten minutes.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import robustness
from report import table

import stairwright as sw
from stairwright.planning.plan import Plan
from stairwright.simulation.trials import trials
from stairwright.terrain.stairs import stair

ROBOTS = ("a1_wheeled", "a1_wheeled_x")
METHODS = ("path", "critical", "nominal")
PAPER = (
    "ramp-30deg-025",
    "single-stair-030",
    "single-stair-036",
    "three-stairs-up",
    "three-stairs-up-down",
)
FLIGHTS = ((0.18, 0.28, 5), (0.20, 0.25, 4), (0.25, 0.30, 3))
WALLS = {"a1_wheeled": (0.50, 0.60, 0.70), "a1_wheeled_x": (0.60, 0.80, 0.85)}


@dataclass(frozen=True)
class Case:
    """One row of the table."""

    name: str
    terrain: sw.Terrain
    robot: str
    method: str
    friction: float = 0.6


def paper_cases() -> Iterator[Case]:
    """The paper's terrains, every method; 0.36 m also at friction 0.5."""
    for name in PAPER:
        for robot in ROBOTS:
            for method in METHODS:
                yield Case(name, sw.load_terrain(name), robot, method)
    for robot in ROBOTS:
        yield Case("single-stair-036", sw.load_terrain("single-stair-036"), robot, "path", 0.5)


def other_presets() -> Iterator[Case]:
    """Every preset that is not the paper's."""
    for name in sorted(set(sw.terrains()) - set(PAPER)):
        for robot in ROBOTS:
            yield Case(name, sw.load_terrain(name), robot, "path")


def flights_and_walls() -> Iterator[Case]:
    """Flights of stairs and high vertical steps, up and down."""
    for direction in ("up", "down"):
        for rise, run, count in FLIGHTS:
            ground = stair(rise, run, count, direction=direction)
            for robot in ROBOTS:
                yield Case(f"{rise:.2f}/{run:.2f} x {count} {direction}", ground, robot, "path")
        for robot, heights in WALLS.items():
            for height in heights:
                wall = stair(height, direction=direction)
                yield Case(f"vertical {height:.2f} m {direction}", wall, robot, "path")


HEADER = (
    "| case | robot | method | friction | plan | planned in | outcome | duration | pitch error "
    "max | link contacts | peak torque | thinnest CoM margin |\n"
    "|---|---|---|---|---|---|---|---|---|---|---|---|"
)


def row(case: Case) -> str:
    """One Markdown row: plan and rollout of a case."""
    plan = sw.plan(case.terrain, case.robot, case.friction, case.method)
    head = f"| {case.name} | {case.robot} | {case.method} | {case.friction:g} "
    planned = f"| {plan.status} | {1e3 * plan.solve_time:.0f} ms "
    if not plan.poses or (case.method == "path" and not plan.feasible):
        reason = plan.problem.message if plan.problem else ""
        return f"{head}{planned}| {reason} | | | | | |"
    run = sw.rollout(plan, friction=case.friction)
    m = run.metrics
    return (
        f"{head}{planned}| {run.outcome} | {m.duration:.1f} s "
        f"| {math.degrees(m.pitch_error_max):.1f} deg | {m.link_contacts} "
        f"| {m.torque_peak:.1f} Nm | {margin(plan)} |"
    )


def margin(plan: Plan) -> str:
    """Thinnest CoM margin of a plan."""
    thinnest = min(pose.margins.com for pose in plan.poses)
    return f"{1e3 * thinnest:.0f} mm" if thinnest > -1.0 else "no equilibrium"


def trial_rows(n: int) -> Iterator[str]:
    """Randomised trials of the 0.36 m stair at nominal friction 0.7."""
    for robot in ROBOTS:
        plan = sw.plan("single-stair-036", robot, 0.7)
        result = trials(plan, n=n, friction=0.7, workers=2)
        low, high = result.wilson
        yield (
            f"| single-stair-036 | {robot} | {result.successes} of {result.count} "
            f"| {100 * low:.0f}-{100 * high:.0f} % |"
        )


def report(quick: bool) -> Iterator[str]:
    """The whole document, line by line."""
    for method in METHODS:  # the first plan of a process loads what the others find loaded
        sw.plan("curb-015", method=method)
    yield "# What it climbs\n"
    yield "Made by `python benchmarks/results.py --write docs/results.md`.\n"
    sections = {
        "The paper's terrains, method against method": paper_cases,
        "Other presets": other_presets,
        "Flights and walls": flights_and_walls,
    }
    for title, cases in sections.items():
        yield f"## {title}\n"
        yield HEADER
        for case in cases():
            yield row(case)
            if quick:
                break
        yield ""
    yield "## Randomised trials\n"
    yield "| case | robot | succeeded | 95 % interval |\n|---|---|---|---|"
    yield from trial_rows(4 if quick else 100)
    yield "\n## Random profiles\n"
    yield "Stairs, ramps, curbs, ditches, drawn and mixed ones of `benchmarks/profiles.py`, planned"
    yield "at friction 0.6 and rolled out four ways (`benchmarks/robustness.py`).\n"
    results = list(robustness.judge_all(range(9 if quick else 300), os.cpu_count() or 1))
    yield table(robustness.rows(results))
    yield "\nWithout a plan, or without success:\n"
    yield from (f"- {robustness.failure(r)}" for r in results if r.outcome != "success")


def main() -> None:
    """Print the tables, and write them where asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="one case a table, 4 trials")
    parser.add_argument("--write", type=Path, help="also write the Markdown to this file")
    arguments = parser.parse_args()
    lines = []
    for line in report(arguments.quick):
        lines.append(line)
        print(line, flush=True)
    if arguments.write:
        arguments.write.write_text("\n".join(lines) + "\n", encoding="utf-8")
        print(f"wrote {arguments.write}", file=sys.stderr)


if __name__ == "__main__":
    main()
