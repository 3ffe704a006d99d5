"""What is a tolerance worth? Plans with one and without, on terrains at the corners of its set.

    python benchmarks/tolerance.py [--robots NAME ...] [--height 0.01] [--place 0.01]
        [--friction 0.1] [--runs 4] [--workers N] [--json FILE]

Flights and single stairs are planned for each robot, with the tolerance and without. Where both
give a plan, each is rolled out on the same terrains: every step taller or lower by the whole
tolerance, every face moved by all of it, with signs at random, friction lower by all of it. The
controller has the simulator's state, or the robot's own sensors.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from typing import Any, get_args

import numpy as np
from report import Row, publish

import stairwright as sw
from stairwright.control.settings import Sensing
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.trials import wilson

ROBOTS = ("a1_wheeled", "a1_wheeled_x", "go2w")
FRICTION = 0.6
Points = list[tuple[float, float]]
TERRAINS: dict[str, Points] = {  # rise, tread of each step [m]
    "one step of 0.20": [(0.20, 1.0)],
    "five steps of 0.15 on 0.30": [(0.15, 0.30)] * 5,
    "five steps of 0.18 on 0.28": [(0.18, 0.28)] * 5,
    "three up and three down": [(0.125, 0.30)] * 3 + [(-0.125, 0.30)] * 3,
}


@dataclass(frozen=True)
class Result:
    """One rollout; without an outcome where there is no plan."""

    robot: str
    terrain: str
    tolerant: bool
    sensing: str
    outcome: str
    reason: str


def terrain_of(name: str) -> dict[str, Any]:
    """A terrain document."""
    points = profile(TERRAINS[name], approach=1.5, platform=1.5)
    return {"name": name, "points": points, "friction": FRICTION}


def profile(steps: Points, approach: float, platform: float) -> Points:
    """Corners [m] of steps (rise, tread), with so much level ground before and after them."""
    points, x, z = [(-approach, 0.0)], 0.0, 0.0
    for rise, tread in steps:
        points += [(x, z), (x, z + rise)]
        x, z = x + tread, z + rise
    return [*points, (x + platform, z)]


def corner(tolerance: Mapping[str, float], random: np.random.Generator) -> Disturbance:
    """A world in which all is off by the whole tolerance, with signs at random."""
    signs = random.choice([-1.0, 1.0], (2, 20))
    return Disturbance(
        step_height_error=(tolerance.get("height", 0.0) * signs[0]).tolist(),
        face_place_error=(tolerance.get("place", 0.0) * signs[1]).tolist(),
        friction=-tolerance.get("friction", 0.0),
    )


def run_case(case: tuple[str, str], tolerance: dict[str, float], runs: int) -> list[Result]:
    """All rollouts of one robot on one terrain."""
    robot, name = case
    plans = {
        tolerant: sw.plan(
            terrain_of(name), robot, FRICTION, tolerance=tolerance if tolerant else None
        )
        for tolerant in (True, False)
    }
    if not all(plan.feasible for plan in plans.values()):
        problems = [plan.problem.message for plan in plans.values() if plan.problem]
        return [Result(robot, name, True, "", "", problems[0])]
    out = []
    for seed in range(runs):
        world = corner(tolerance, np.random.default_rng(seed))
        for sensing in get_args(Sensing):
            for tolerant, plan in plans.items():
                run = sw.rollout(
                    plan, disturbance=world, seed=seed, controller={"sensing": sensing},
                    record_hz=5.0, keep_plan=False,
                )  # fmt: skip
                out.append(Result(robot, name, tolerant, sensing, run.outcome, run.reason))
    return out


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    parser.add_argument("--height", type=float, default=0.01)
    parser.add_argument("--place", type=float, default=0.01)
    parser.add_argument("--friction", type=float, default=0.1)
    parser.add_argument("--runs", type=int, default=4)
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--json")
    given = parser.parse_args()
    tolerance = {name: getattr(given, name) for name in ("height", "place", "friction")}
    cases = [(robot, terrain) for robot in given.robots for terrain in TERRAINS]
    found: list[Result] = []
    with ProcessPoolExecutor(given.workers, mp_context=get_context("spawn")) as pool:
        futures = [pool.submit(run_case, case, tolerance, given.runs) for case in cases]
        for future in futures:
            found += future.result()
    for one in found:
        if not one.outcome:
            print(f"not planned: {one.robot}, {one.terrain}: {one.reason}")
    rows = []
    for sensing in get_args(Sensing):
        for tolerant in (True, False):
            mine = [r for r in found if r.sensing == sensing and r.tolerant == tolerant]
            good = sum(r.outcome == "success" for r in mine)
            if not mine:
                continue
            low, high = wilson(good, len(mine))
            rest = [r for r in mine if r.outcome != "success"]
            kinds = {
                kind: sum(r.outcome == kind for r in rest) for kind in {r.outcome for r in rest}
            }
            words = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
            rate = f"{good} of {len(mine)} ({low:.1%} to {high:.1%})"
            name = "with tolerance" if tolerant else "without"
            rows.append(Row(f"sensing {sensing}", name, solved=rate, note=words))
    publish(rows, given.json)


if __name__ == "__main__":
    main()
