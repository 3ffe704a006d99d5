"""Solve times and outcomes on this machine, for `stairwright bench`."""

from __future__ import annotations

import statistics
import time
from dataclasses import dataclass

from stairwright.planning.plan import Method
from stairwright.planning.planner import plan
from stairwright.robot.description import Robot
from stairwright.simulation.rollout import rollout
from stairwright.terrain.profile import Terrain


@dataclass(frozen=True)
class Figures:
    """One terrain and robot; `quartiles` of the time from question to plan [s]."""

    terrain: str
    robot: str
    status: str
    quartiles: tuple[float, float, float]
    outcome: str | None
    real_time_factor: float | None


def measure(terrain: Terrain, robot: Robot, method: Method, repeat: int) -> Figures:
    """Plan `repeat` times after one unmeasured time, and roll the plan out once."""
    made = plan(terrain, robot, method=method)
    times: list[float] = []
    for _ in range(repeat):
        start = time.perf_counter()
        made = plan(terrain, robot, method=method)
        times.append(time.perf_counter() - start)
    q1, median, q3 = statistics.quantiles(times, n=4) if repeat > 1 else times * 3
    run = rollout(made) if made.feasible else None
    return Figures(
        terrain.name,
        robot.name,
        made.status,
        (q1, median, q3),
        None if run is None else run.outcome,
        None if run is None else run.metrics.real_time_factor,
    )
