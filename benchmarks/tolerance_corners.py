"""Do plans stand the tolerance that they were asked for? Random ones, at corners of its set.

    python benchmarks/tolerance_corners.py [--first 0] [--count 100] [--timing fast] [--workers 2]

A robot's preset, a flight up, down or both, a wall or a curb, a friction and a tolerance are drawn.
Each plan is rolled out by the robot's own sensors in four worlds: every step taller or lower by the
whole tolerance, every face moved by all of it, with signs at random, friction lower by all of it.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from typing import get_args

import numpy as np
from random_robots import PRESETS
from tolerance import Points, corner, profile

import stairwright as sw
from stairwright.planning.plan import Plan, PlanTiming
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.trials import wilson

LARGE = 1.5  # times an A1's steps, for all others
WORLDS = 4


@dataclass(frozen=True)
class Case:
    """A question for the planner."""

    robot: str
    points: Points
    friction: float
    tolerance: dict[str, float]

    @classmethod
    def drawn(cls, seed: int) -> Case:
        """One of them; robots take turns."""
        random = np.random.default_rng([17, seed])
        robot = PRESETS[seed % len(PRESETS)]
        size = 1.0 if robot.startswith("a1") else LARGE
        points = profile(_steps(random, size), approach=2.0, platform=1.8)
        tolerance = {
            "height": float(random.choice([0.0, 0.005, 0.01, 0.02])),
            "place": float(random.choice([0.0, 0.005, 0.01, 0.02])),
            "friction": float(random.choice([0.0, 0.05, 0.1])),
        }
        friction = float(random.uniform(0.45, 0.9))
        return cls(robot, points, friction, tolerance)

    def plan(self, timing: PlanTiming) -> Plan:
        """With its tolerance."""
        return sw.plan(
            {"points": self.points}, self.robot, self.friction,
            timing=timing, tolerance=self.tolerance, diagnose=False,
        )  # fmt: skip

    def worlds(self, seed: int) -> Iterator[Disturbance]:
        """Corners of what the plan stands."""
        for world in range(WORLDS):
            yield corner(self.tolerance, np.random.default_rng([seed, world]))


def _steps(random: np.random.Generator, size: float) -> Points:
    """Rises and treads [m]."""
    kind = random.choice(["up", "down", "up and down", "wall", "curb"])
    rise, tread = random.uniform([0.08, 0.22], [0.22, 0.6]) * size
    count = int(random.integers(2, 5))
    if kind == "wall":
        return [(random.uniform(0.15, 0.6) * size * random.choice([-1.0, 1.0]), 1.5)]
    if kind == "curb":
        return [(rise, random.uniform(0.3, 1.0) * size), (-rise, 1.5)]
    up, down = [(rise, tread)] * count, [(-rise, tread)] * count
    return {"up": up, "down": down, "up and down": up + down}[str(kind)]


def failures(seed: int, timing: PlanTiming) -> list[str] | None:
    """What came of the rollouts that failed; None where there is no plan."""
    case = Case.drawn(seed)
    plan = case.plan(timing)
    if not plan.feasible:
        return None
    found = []
    for number, world in enumerate(case.worlds(seed)):
        run = sw.rollout(plan, disturbance=world, seed=number, record_hz=5.0, keep_plan=False)
        if not run.success:
            found.append(f"seed {seed}, {case.robot}, world {number}: {run.reason}")
    return found


def main() -> None:
    """Print what failed, and how much succeeds."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--timing", choices=get_args(PlanTiming), default="steady")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    given = parser.parse_args()
    seeds = range(given.first, given.first + given.count)
    plans = failed = 0
    with ProcessPoolExecutor(given.workers, mp_context=get_context("spawn")) as pool:
        for found in pool.map(partial(failures, timing=given.timing), seeds):
            if found is None:
                continue
            plans, failed = plans + 1, failed + len(found)
            for line in found:
                print(line, flush=True)
    runs = WORLDS * plans
    low, high = wilson(runs - failed, runs)
    print(f"{plans} plans: {runs - failed} of {runs} succeed ({low:.1%} to {high:.1%})")


if __name__ == "__main__":
    main()
