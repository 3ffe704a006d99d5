"""What does a robot that has only its own sensors do where the world differs from its map?

    python benchmarks/deviations.py [--count 60] [--first 5000] [--rows NAME ...] [--robots NAME]
        [--terrains NAME ...] [--timing fast] [--sensing robot] [--salt 0] [--workers N] [--quick]
        [--show] [--spread] [--json FILE]

Every preset terrain and `--count` profiles of `profiles.py` are planned for each robot; every plan
is rolled out once for each row of the table, with deviations whose signs and draws differ from plan
to plan. `--spread` rolls each plan out in one row alone, the next row with each plan, so that many
profiles fit in an hour. A run succeeds, ends short of that with the robot standing (stopped by
itself, or at rest), or falls. Shares come with Wilson's 95 % intervals; the estimator's error is
judged against the truth (NEES: share of the time within the 95 % band of chi squared). `--show`
prints each run that did not succeed.
"""

from __future__ import annotations

import argparse
import math
import os
import zlib
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from typing import Any

import numpy as np
from profiles import random_profile
from report import Row, publish

import stairwright as sw
from stairwright.control.settings import parse_settings
from stairwright.errors import InputError
from stairwright.library import terrains
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.intervals import wilson
from stairwright.simulation.ranges import BUNDLES, draw
from stairwright.simulation.run import Run

ROBOTS = ("a1_wheeled", "a1_wheeled_x", "go2w", "b2w")
FRICTION = 0.6
FIRST = 5000
DEGREE = math.pi / 180
NEES_95 = 12.59  # chi squared, 6 degrees of freedom
STANDING = ("stopped", "stuck", "timeout")

Make = Callable[[float, int, float], dict[str, Any]]  # sign, seed and mass [kg] -> deviations


def _signs(size: float, seed: int) -> list[float]:
    """+-`size` for each of many steps."""
    return (size * np.random.default_rng(seed).choice([-1.0, 1.0], 100)).tolist()


def _bundle(name: str) -> Make:
    return lambda sign, seed, mass: draw(BUNDLES[name], 1, seed)[0].model_dump()


ROWS: dict[str, Make] = {
    "as drawn": lambda sign, seed, mass: {},
    "start off by 5 cm": lambda sign, seed, mass: {"x_offset": 0.05 * sign},
    "odometry scale 2 %": lambda sign, seed, mass: {"odometry_scale": 0.02 * sign},
    "each step 2 cm off": lambda sign, seed, mass: {"step_height_error": _signs(0.02, seed)},
    "each face 3 cm off": lambda sign, seed, mass: {"face_place_error": _signs(0.03, seed)},
    "laboratory": _bundle("laboratory"),
    "field": _bundle("field"),
    "rear wheels at friction 0.3": lambda sign, seed, mass: {"friction_rear": 0.3 - FRICTION},
    "heading off by 5 deg": lambda sign, seed, mass: {"heading": 5 * DEGREE * sign},
    "payload 3 kg": lambda sign, seed, mass: {"payload": 3.0},
    "delay 12 ms": lambda sign, seed, mass: {"delay": 0.012},
}


@dataclass(frozen=True)
class Result:
    """One rollout; `row` is empty where there is no plan."""

    terrain: str
    robot: str
    row: str
    outcome: str
    reason: str = ""
    honest: float = math.nan  # share of the time with NEES in its band
    place_error: float = math.nan  # of the estimate at the end, against the real terrain [m]


def terrain_of(name: str) -> sw.Terrain:
    """A preset, or profile number `name`."""
    return random_profile(int(name))[1] if name.isdigit() else sw.load_terrain(name)


def run_case(
    case: tuple[str, str], rows: tuple[str, ...], timing: str, sensing: str, salt: int
) -> list[Result]:
    """Plan one terrain for one robot and roll it out in all `rows`; `salt` draws anew."""
    terrain, robot = case
    try:
        plan = sw.plan(terrain_of(terrain), robot, FRICTION, timing=timing)
    except InputError as error:
        return [Result(terrain, robot, "", "refused", str(error))]
    if not plan.feasible:
        return [Result(terrain, robot, "", plan.status)]
    drawn = f"{terrain}/{robot}" + (f"/{salt}" if salt else "")
    seed = zlib.crc32(drawn.encode()) % 100_000
    mass = plan.robot_description.mass
    out = []
    for name in rows:
        sign = 1.0 if zlib.crc32(f"{drawn}/{name}".encode()) % 2 else -1.0
        deviation = Disturbance(**ROWS[name](sign, seed, mass))
        settings = parse_settings({"sensing": sensing})
        run = Run(plan, plan.friction, settings, deviation, seed, 20.0)
        result = run.result(run.simulate(None), keep_plan=False)
        judged = np.asarray(run.native.judged) if run.native is not None else np.zeros((0, 16))
        honest = float(np.mean(judged[:, 15] < NEES_95)) if len(judged) else math.nan
        last = judged[-1] if len(judged) else np.full(16, math.nan)
        error = float(np.hypot(last[7], last[8]))
        out.append(Result(terrain, robot, name, result.outcome, result.reason, honest, error))
    return out


def results(
    cases: list[tuple[str, str]], workers: int, rows: list[tuple[str, ...]], **asked: Any
) -> Iterator[Result]:
    """All results, in order; each case in its rows, as `run_case` is asked."""
    work = partial(run_case, **asked)
    if workers == 1:
        for case, mine in zip(cases, rows, strict=True):
            yield from work(case, mine)
        return
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        for found in pool.map(work, cases, rows):
            yield from found


def table(found: list[Result], rows: Iterable[str]) -> list[Row]:
    """A row of shares for each deviation, over all robots and for each."""
    out = []
    for name in rows:
        for robot in ["all robots", *dict.fromkeys(r.robot for r in found)]:
            mine = [r for r in found if r.row == name and robot in ("all robots", r.robot)]
            if not mine:
                continue
            counts = {
                k: sum(r.outcome == k for r in mine) for k in dict.fromkeys(r.outcome for r in mine)
            }
            good = counts.get("success", 0)
            low, high = wilson(good, len(mine))
            rest = ", ".join(f"{v} {k}" for k, v in counts.items() if k != "success")
            honest = float(np.nanmean([r.honest for r in mine]))
            note = f"{100 * good / len(mine):.1f} % ({100 * low:.1f}-{100 * high:.1f})"
            note += f"; {rest}" if rest else ""
            note += "" if math.isnan(honest) else f"; NEES in its band {100 * honest:.0f} %"
            out.append(Row(name, robot, unit="", solved=f"{good} of {len(mine)}", note=note))
    all_runs = [r for r in found if r.row]
    fell = sum(r.outcome == "fell" for r in all_runs)
    low, high = wilson(fell, len(all_runs))
    note = f"{100 * fell / len(all_runs):.2f} % ({100 * low:.2f}-{100 * high:.2f})"
    out.append(Row("falls", "all runs", unit="", solved=f"{fell} of {len(all_runs)}", note=note))
    return out


def run(quick: bool = False, **options: Any) -> list[Row]:
    """All rows of the table."""
    count = options.get("count", 6 if quick else 60)
    first = options.get("first", FIRST)
    rows = tuple(name for name in ROWS if name in options.get("rows", ROWS))
    robots = options.get("robots", ROBOTS)
    presets = options.get("terrains", terrains())
    cases = [(t, r) for t in [*presets, *map(str, range(first, first + count))] for r in robots]
    workers = options.get("workers") or len(os.sched_getaffinity(0))
    found = []
    asked = {"timing": "steady", "sensing": "robot", "salt": 0}
    asked |= {name: options[name] for name in asked if name in options}
    each = [(rows[k % len(rows)],) if options.get("spread") else rows for k in range(len(cases))]
    for result in results(cases, workers, each, **asked):
        found.append(result)
        if options.get("show") and result.row and result.outcome != "success":
            print(
                f"{result.terrain:22}{result.robot:14}{result.row:30}{result.outcome}: "
                f"{result.reason}",
                flush=True,
            )
    return table(found, rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--first", type=int)
    parser.add_argument("--count", type=int, help="random profiles")
    parser.add_argument("--rows", nargs="*", help=f"of: {', '.join(ROWS)}".replace("%", "%%"))
    parser.add_argument("--robots", nargs="*")
    parser.add_argument("--timing", choices=("steady", "fast"))
    parser.add_argument("--sensing", choices=("ideal", "robot"))
    parser.add_argument("--terrains", nargs="*", help="presets; all by default")
    parser.add_argument("--salt", type=int, help="for other draws: tune on some, report others")
    parser.add_argument("--workers", type=int, help="processes; all cores by default")
    parser.add_argument("--spread", action="store_true", help="one row for each plan, in turn")
    parser.add_argument("--quick", action="store_true", help="6 profiles")
    parser.add_argument("--show", action="store_true", help="print what did not succeed")
    parser.add_argument("--json")
    given = parser.parse_args()
    options = {k: v for k, v in vars(given).items() if k not in ("quick", "json") and v is not None}
    publish(run(given.quick, **options), given.json)


if __name__ == "__main__":
    main()
