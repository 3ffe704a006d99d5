"""Does what is planned succeed when it is carried out? Random profiles, rolled out four ways.

    python benchmarks/robustness.py [--count 300] [--first 0] [--friction 0.6] [--workers N]
        [--cache FOLDER] [--quick] [--json FILE]

Every profile of `profiles.py` is planned for both robots at one friction. Plans called feasible are
rolled out at that friction, with the true friction 0.1 lower, at 0.2 m/s (planned for it), and at
0.2 m/s asked of the controller. A profile with places that no wheel can stand on at the lower
friction, a slope steeper than its cone, cannot succeed there; such failures are marked.

The table shows shares with Wilson's 95 % intervals; failures follow with outcome and place. With
`--cache`, plans are kept between runs: empty the folder when the planner has changed.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from profiles import random_profile
from report import Row, publish

import stairwright as sw
from stairwright.planning.plan import Plan, plan_id
from stairwright.planning.weights import parse_weights
from stairwright.simulation.intervals import wilson

ROBOTS = ("a1_wheeled", "a1_wheeled_x")
FRICTION = 0.6


@dataclass(frozen=True)
class Way:
    """One way of carrying plans out.

    Attributes:
        name: What the table calls it.
        friction: True friction.
        speed: Planned for [m/s].
        controller: Settings by name.
    """

    name: str
    friction: float
    speed: float
    controller: tuple[tuple[str, float], ...] = ()


def ways_at(friction: float) -> tuple[Way, ...]:
    """All ways of plans made for `friction`."""
    return (
        Way("friction as planned", friction, 0.12),
        Way("true friction 0.1 lower", friction - 0.1, 0.12),
        Way("planned for 0.2 m/s", friction, 0.2),
        Way("driven at 0.2 m/s", friction, 0.12, (("speed", 0.2),)),
    )


@dataclass(frozen=True)
class Result:
    """One rollout, or a profile without a plan (`way` is empty then)."""

    seed: int
    kind: str
    robot: str
    way: str
    outcome: str
    reason: str
    contacts: int = 0
    pitch_error: float = 0.0
    stands: bool = True  # whether the plan's poses have equilibrium at the true friction


def planned(seed: int, robot: str, friction: float, speed: float, cache: str | None) -> Plan:
    """The plan of a profile, from the cache if it is there."""
    _, terrain = random_profile(seed)
    if cache is None:
        return sw.plan(terrain, robot, friction, weights={"speed": speed})
    weights = parse_weights("path", {"speed": speed}).model_dump()
    name = plan_id(terrain, sw.load_robot(robot), friction, "path", weights)
    file = Path(cache) / f"{name}.json"
    if file.is_file():
        return Plan.model_validate_json(file.read_text(encoding="utf-8"))
    plan = sw.plan(terrain, robot, friction, weights={"speed": speed})
    file.write_text(plan.model_dump_json(by_alias=True), encoding="utf-8")
    return plan


def judge(seed: int, robot: str, friction: float, cache: str | None) -> list[Result]:
    """Plan one profile for one robot at `friction` and roll it out in all ways."""
    kind, _ = random_profile(seed)
    results = []
    for way in ways_at(friction):
        plan = planned(seed, robot, friction, way.speed, cache)
        if not plan.feasible:
            reason = plan.problem.message if plan.problem else ""
            return [Result(seed, kind, robot, "", plan.status, reason)]
        run = sw.rollout(plan, friction=way.friction, controller=dict(way.controller))
        spare = min(pose.margins.friction for pose in plan.poses)
        results.append(
            Result(
                seed, kind, robot, way.name, run.outcome, run.reason, run.metrics.link_contacts,
                run.metrics.pitch_error_max, spare >= plan.friction - way.friction,
            )
        )  # fmt: skip
    return results


def _job(job: tuple[int, str], friction: float, cache: str | None) -> list[Result]:
    return judge(*job, friction, cache)


def judge_all(
    seeds: Iterable[int], workers: int, cache: str | None = None, friction: float = FRICTION
) -> Iterator[Result]:
    """Results of many profiles, in order."""
    jobs = [(seed, robot) for seed in seeds for robot in ROBOTS]
    work = partial(_job, friction=friction, cache=cache)
    if workers == 1:
        for job in jobs:
            yield from work(job)
        return
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        for found in pool.map(work, jobs):
            yield from found


def rows(results: list[Result]) -> list[Row]:
    """The table: a row for each way and robot."""
    out = []
    for robot in ROBOTS:
        mine = [r for r in results if r.robot == robot]
        profiles, plans = len({r.seed for r in mine}), len({r.seed for r in mine if r.way})
        out.append(Row(f"{profiles} random profiles", robot, solved=f"{plans} planned"))
        for way in dict.fromkeys(r.way for r in mine if r.way):
            part = [r for r in mine if r.way == way]
            good = sum(r.outcome == "success" for r in part)
            low, high = wilson(good, len(part))
            standing = [r for r in part if r.stands]
            stood = sum(r.outcome == "success" for r in standing)
            note = f"{100 * good / len(part):.1f} %, interval {100 * low:.1f}-{100 * high:.1f} %"
            if len(standing) < len(part):
                note += f"; where poses hold statically {stood} of {len(standing)}"
            share = f"{good} of {len(part)}"
            degrees = np.degrees([r.pitch_error for r in part])
            middle, worst = np.percentile(degrees, [50, 95])
            out.append(Row(way, robot, float(middle), float(worst), "deg pitch error",
                           solved=share, note=note))  # fmt: skip
    return out


def failure(result: Result) -> str:
    """One line on what did not succeed, where and why."""
    mark = "" if result.stands else " (no equilibrium at this friction)"
    return (
        f"{result.kind} {result.seed}, {result.robot}, {result.way or 'plan'}: "
        f"{result.outcome}{mark}. {result.reason}"
    )


def run(quick: bool = False, **options: Any) -> list[Row]:
    """All rows; prints the failures."""
    count = options.get("count", 9 if quick else 300)
    first = options.get("first", 0)
    workers = options.get("workers") or len(os.sched_getaffinity(0))
    results = []
    seeds, friction = range(first, first + count), options.get("friction", FRICTION)
    for result in judge_all(seeds, workers, options.get("cache"), friction):
        results.append(result)
        if result.outcome != "success":
            print(failure(result), flush=True)
    return rows(results)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int)
    parser.add_argument("--friction", type=float, help="planned for; more than 0.1")
    parser.add_argument("--workers", type=int, help="processes; all cores by default")
    parser.add_argument("--cache", help="keep plans in this folder")
    parser.add_argument("--quick", action="store_true", help="9 profiles")
    parser.add_argument("--json")
    given = parser.parse_args()
    options = {k: v for k, v in vars(given).items() if k not in ("quick", "json") and v is not None}
    if given.cache:
        Path(given.cache).mkdir(parents=True, exist_ok=True)
    publish(run(given.quick, **options), given.json)


if __name__ == "__main__":
    main()
