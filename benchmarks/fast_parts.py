"""What each part of fast timing brings: plans and rollouts with one part left out.

    python benchmarks/fast_parts.py [--first 900] [--count 12] [--aggressiveness 0.75]

Five stairs up and down and random profiles, three robots; the median speed over the faces is of
those that succeed in every row.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from statistics import median
from typing import Any
from unittest.mock import patch

import numpy as np
from fast import ROBOTS, flight
from profiles import random_profile

import stairwright as sw
from stairwright.control.setpoint import ACCELERATIONS, RATES
from stairwright.planning.timing import fast
from stairwright.planning.timing.limits import Limits
from stairwright.planning.weights import PathWeights
from stairwright.simulation import governor

Patch = tuple[object, str, Any]
_track = governor.track


def _without(name: str) -> Callable[..., Limits]:
    """`limits_of` less the rows and the cap of one name."""
    whole = fast.limits_of

    def fewer(*args: Any) -> Limits:
        limits = whole(*args)
        kept = [k for k, each in enumerate(limits.names) if each != name]
        rows = np.ascontiguousarray(limits.rows[:, kept])
        caps = {each: cap for each, cap in limits.caps.items() if each != name}
        return Limits(rows, tuple(limits.names[k] for k in kept), caps)

    return fewer


def _without_acceleration(*args: Any, **kwargs: Any) -> governor.Track:
    """`track` whose controller is not told what accelerations are planned."""
    line = _track(*args, **kwargs)
    line.rows[:, ACCELERATIONS : ACCELERATIONS + RATES] = 0.0
    return line


PARTS: dict[str, list[Patch]] = {
    "everything": [],
    "path not searched for speed": [(PathWeights, "for_speed", lambda weights: weights)],
    "no rows of balance": [(fast, "limits_of", _without("balance"))],
    "no rows of torque": [(fast, "limits_of", _without("torque"))],
    "no bounds on accelerations": [(fast, "limits_of", _without("acceleration"))],
    "no bound on impacts": [(fast, "limits_of", _without("impact"))],
    "not slowed down for the certificate": [(fast, "_ROUNDS", 0)],
    "accelerations not fed forward": [(governor, "track", _without_acceleration)],
    "controller differentiates over 5 mm": [(governor, "reach_of", lambda _: governor.RATE_REACH)],
}


@contextmanager
def _patched(patches: list[Patch]) -> Iterator[None]:
    started = [patch.object(*each) for each in patches]
    for each in started:
        each.start()
    try:
        yield
    finally:
        for each in started:
            each.stop()


def speeds(options: argparse.Namespace) -> dict[tuple[str, str], float | None]:
    """Speed over the faces of each question [m/s]; None where it fails."""
    found: dict[tuple[str, str], float | None] = {}
    for robot in ROBOTS.split(","):
        questions = [("up", flight("up")), ("down", flight("down"))]
        seeds = range(options.first, options.first + options.count)
        questions += [(str(seed), random_profile(seed)[1]) for seed in seeds]
        for name, terrain in questions:
            weights = {"aggressiveness": options.aggressiveness}
            plan = sw.plan(terrain, robot, 0.6, weights=weights, timing="fast", diagnose=False)
            if plan.feasible:
                rollout = sw.rollout(plan)
                good = rollout.outcome == "success"
                found[robot, name] = rollout.metrics.speed_stairs if good else None
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--first", type=int, default=900)
    parser.add_argument("--count", type=int, default=12)
    parser.add_argument("--aggressiveness", type=float, default=0.75)
    options = parser.parse_args()
    rows = {}
    for name, patches in PARTS.items():
        with _patched(patches):
            rows[name] = speeds(options)
    common = [key for key in rows["everything"] if all(row.get(key) for row in rows.values())]
    print("| left out | succeed | median speed | five stairs, up and down by robot [m/s] |")
    print("|---|---|---|---|")
    for name, row in rows.items():
        flights = " ".join(
            f"{value:.2f}" if value else "-"
            for (_, kind), value in row.items()
            if kind in ("up", "down")
        )
        good = sum(value is not None for value in row.values())
        middle = median(row[key] or 0.0 for key in common)
        print(f"| {name} | {good} of {len(row)} | {middle:.3f} m/s | {flights} |", flush=True)


if __name__ == "__main__":
    main()
