"""Are refusals true, and how soon do they come? On random robots and profiles.

Every refusal names what is missing: "needs friction 0.71, has 0.6". Here the question is asked
again with 2 % more than the named amount, where a plan must come, and with 2 % less, where none
may. Questions are those of `random_robots.py`; the changed robots are made here, from documents,
and not by the code that named the amount.

python benchmarks/refusals.py [--first 0] [--count 200] [--processes 2] [--json FILE]
    --count: refusals that name an amount, not questions
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from copy import deepcopy
from itertools import count, islice
from pathlib import Path
from typing import Any

import numpy as np
from profiles import random_profile
from random_robots import random_robot

import stairwright as sw

STEP = 1.02
Question = tuple[list[tuple[float, float]], dict[str, Any], float]  # points, robot, friction


def question(seed: int) -> Question:
    """The one that `random_robots.py` asks with this seed."""
    robot = random_robot(seed)
    _, terrain = random_profile(seed)
    scale = min(leg.reach for leg in robot.legs) / 0.4
    return [(x * scale, z * scale) for x, z in terrain.points], robot.model_dump(), 0.6


def ask(asked: Question) -> tuple[sw.Plan, tuple[float, float]]:
    """The plan, and how long it took: by the clock, and of all processors [s]."""
    points, robot, friction = asked
    begun = time.perf_counter(), time.process_time()
    plan = sw.plan({"points": points}, sw.Robot.model_validate(robot), friction)
    return plan, (time.perf_counter() - begun[0], time.process_time() - begun[1])


def longer(robot: dict[str, Any], factor: float) -> None:
    for link in (robot["thigh"], robot["calf"]):
        link["length"] *= factor
        if not isinstance(link["com"], float):
            link["com"] = [link["com"][0], link["com"][1] * factor]
        for piece in link.get("shape", []):
            for end in ("start", "end"):
                piece[end] = [piece[end][0], piece[end][1] * factor]


def flatter(robot: dict[str, Any], factor: float) -> None:
    trunk = robot["trunk"]
    trunk["size"] = [*trunk["size"][:2], trunk["size"][2] * factor]
    for piece in trunk.get("outline", []):
        piece["points"] = [(x, z * factor) for x, z in piece["points"]]


def stronger(motors: tuple[str, ...]) -> Callable[[dict[str, Any], float], None]:
    def change(robot: dict[str, Any], factor: float) -> None:
        for name in motors:
            motor = robot["actuators"].get(name)
            if motor:
                motor["torque"] = min(motor["torque"] * factor, 1000.0)

    return change


def widened(joint: str) -> Callable[[dict[str, Any], float], None]:
    """Ranges wider by what the smallest lacks, half at each end; a knee keeps its side."""

    def change(robot: dict[str, Any], factor: float) -> None:
        legs = [robot["joints"][end] for end in ("front", "rear")]
        extra = (factor - 1.0) * min(leg[joint][1] - leg[joint][0] for leg in legs)
        for leg in legs:
            low, high = leg[joint]
            wide = [low - extra / 2, high + extra / 2]
            if joint == "calf":
                wide[0] = max(wide[0], 0.05 if low > 0 else -3.1)
                wide[1] = min(wide[1], 3.1 if low > 0 else -0.05)
            leg[joint] = tuple(wide)

    return change


CHANGES: dict[str, Callable[[dict[str, Any], float], None]] = {
    "leg length": longer,
    "trunk height": flatter,
    "leg torque": stronger(("leg", "thigh", "calf")),
    "wheel torque": stronger(("wheel",)),
    "calf range": widened("calf"),
    "thigh range": widened("thigh"),
}


def changed(asked: Question, plan: sw.Plan, factor: float) -> Question | None:
    """The question with `factor` of the missing quantity; None if it is none of those here."""
    points, robot, friction = asked
    assert plan.problem is not None
    assert plan.problem.limit is not None
    limit = plan.problem.limit
    name, friction = limit.quantity, limit.given.get("friction", friction)
    # A knee that bends both ways lacks the range on the side to which it was planned bent.
    told = plan.robot_description.model_dump() if name == "calf range" else robot
    robot = deepcopy(told)
    if name == "friction":
        return points, robot, friction * factor
    if name == "profile height":
        base = points[0][1]
        return [(x, base + (z - base) * factor) for x, z in points], robot, friction
    if name not in CHANGES:
        return None
    CHANGES[name](robot, factor)
    return points, robot, friction


def examine(seed: int) -> dict[str, Any] | None:
    """What became of one question; None if it was not refused."""
    asked = question(seed)
    plan, (seconds, cpu) = ask(asked)
    if plan.problem is None:
        return None
    row: dict[str, Any] = {
        "seed": seed, "seconds": seconds, "cpu": cpu, "message": plan.problem.message
    }  # fmt: skip
    limit = plan.problem.limit
    if limit is None or plan.problem.kind in ("start", "goal"):
        return row
    row["quantity"] = limit.quantity
    # As many digits as the message has.
    needed, there = limit.needed, limit.available
    way = STEP if needed > there else 1.0 / STEP
    more = changed(asked, plan, needed / there * way)
    less = changed(asked, plan, max(1.0, needed / there / way) if needed > there
                   else min(1.0, needed / there / way))  # fmt: skip
    if more is None or less is None:
        return row
    return row | {"more": ask(more)[0].feasible, "less": not ask(less)[0].feasible}


def refusals(first: int, processes: int) -> Iterator[dict[str, Any]]:
    """Refusals in the order of their seeds, without end."""
    with ProcessPoolExecutor(processes) as pool:
        batch = 4 * processes
        for begin in count(first, batch):
            for row in pool.map(examine, range(begin, begin + batch)):
                if row is not None:
                    yield row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    rows: list[dict[str, Any]] = []
    named = (row for row in refusals(options.first, options.processes) if not rows.append(row))
    for row in islice((row for row in named if "more" in row), options.count):
        if not (row["more"] and row["less"]):
            print(row, flush=True)
    told = [row for row in rows if "more" in row]
    print(f"{len(rows)} refusals, {len(told)} name an amount that can be asked about")
    print(f"2 % more has a plan: {sum(row['more'] for row in told)} of {len(told)}")
    print(f"2 % less has none: {sum(row['less'] for row in told)} of {len(told)}")
    for name in ("seconds", "cpu"):
        times = [row[name] for row in rows]
        print(f"{name}: p50 {np.median(times):.2f} s, p95 {np.percentile(times, 95):.2f} s")
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
