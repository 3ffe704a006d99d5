"""Time-optimal timing against direct collocation of the same path (CasADi, IPOPT).

    python benchmarks/time_optimal.py [--first 0] [--count 6] [--robot a1_wheeled]
                                      [--aggressiveness 0.75]

Both minimise the time along one path under the same rows and caps (`stairwright.planning.timing`).
Ours is one pass backward and one forward with the acceleration constant between samples; the peer
is trapezoidal collocation: squared speed x and acceleration u at every sample,
``x[i+1] - x[i] = step (u[i] + u[i+1])``, rows kept at samples, time integrated exactly between
them. Times are those of the whole solve, without CasADi's set-up.
"""

from __future__ import annotations

import argparse
import time as clock
from statistics import median

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from profiles import random_profile

import stairwright as sw
from stairwright.planning.timing.fast import TimingProblem, fastest
from stairwright.planning.timing.limits import Limits

Floats = NDArray[np.float64]

LEAST = 1e-4  # m^2/s^2; the peer starts and ends there, for its time is infinite at rest


def collocated(limits: Limits, step: float, guess: Floats) -> tuple[Floats, float]:
    """Squared speeds (n,) that IPOPT finds, and how long it takes [s]."""
    n = len(guess)
    x, u = ca.MX.sym("x", n), ca.MX.sym("u", n)
    a, b, c = np.moveaxis(limits.rows, -1, 0)
    speed = ca.sqrt(x)
    duration = ca.sum1(2.0 * step / (speed[:-1] + speed[1:]))
    dynamics = x[1:] - x[:-1] - step * (u[1:] + u[:-1])
    rows = [ca.DM(a[:, k]) * x + ca.DM(b[:, k]) * u + ca.DM(c[:, k]) for k in range(a.shape[1])]
    problem = {"x": ca.vertcat(x, u), "f": duration, "g": ca.vertcat(dynamics, *rows)}
    quiet = {"ipopt.print_level": 0, "print_time": False, "ipopt.sb": "yes"}
    solve = ca.nlpsol("collocation", "ipopt", problem, quiet)
    caps = np.minimum.reduce(list(limits.caps.values()))
    caps = np.maximum(caps, 2.0 * LEAST)
    caps[[0, -1]] = LEAST
    inside = np.clip(0.5 * guess, 1.1 * LEAST, 0.9 * caps)
    inside[[0, -1]] = LEAST
    free = np.full(n, np.inf)
    begun = clock.perf_counter()
    found = solve(
        x0=np.concatenate([inside, np.gradient(inside) / (2.0 * step)]),
        lbx=np.concatenate([np.full(n, LEAST), -free]), ubx=np.concatenate([caps, free]),
        lbg=0.0, ubg=np.concatenate([np.zeros(n - 1), np.full(a.size, np.inf)]),
    )  # fmt: skip
    took = clock.perf_counter() - begun
    if not solve.stats()["success"]:
        raise RuntimeError(f"IPOPT: {solve.stats()['return_status']}")
    return np.asarray(found["x"]).ravel()[:n], took


def duration(squares: Floats, step: float) -> float:
    """Time along the way [s], both ends as slow as the peer's."""
    speeds = np.sqrt(np.maximum(squares, LEAST))
    return float((2.0 * step / (speeds[:-1] + speeds[1:])).sum())


def timed(problem: TimingProblem) -> tuple[Floats, float]:
    """Squared speeds of ours, and how long they take [s], the least of five."""
    took = []
    for _ in range(5):
        begun = clock.perf_counter()
        squares = fastest(problem)
        took.append(clock.perf_counter() - begun)
    return squares, min(took)


def main() -> None:
    """Print the comparison."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=6)
    parser.add_argument("--robot", default="a1_wheeled")
    parser.add_argument("--aggressiveness", type=float, default=0.75)
    chosen = parser.parse_args()
    ratios, speedups = [], []
    for seed in range(chosen.first, chosen.first + chosen.count):
        kind, terrain = random_profile(seed)
        weights = {"aggressiveness": chosen.aggressiveness}
        plan = sw.plan(terrain, chosen.robot, 0.6, weights=weights, timing="fast", diagnose=False)
        if not plan.feasible:
            continue
        problem = TimingProblem.of(plan, chosen.aggressiveness)
        step = problem.motion.step
        squares, ours = timed(problem)
        peers, theirs = collocated(problem.limits, step, squares)
        mine, best = duration(squares, step), duration(peers, step)
        ratios.append(mine / best)
        speedups.append(theirs / ours)
        print(
            f"{kind:10} {seed:6}: {len(squares):5} samples, {problem.limits.rows.shape[1]} rows; "
            f"{mine:.3f} s against {best:.3f} s ({100 * (mine / best - 1):+.1f} %), "
            f"found in 1/{theirs / ours:.0f} of the time ({1e3 * ours:.1f} ms)",
            flush=True,
        )
    print(
        f"{len(ratios)} paths: time {100 * (max(ratios) - 1):+.1f} % at most, "
        f"{100 * (median(ratios) - 1):+.1f} % in the middle; found in 1/{min(speedups):.0f} of the "
        f"time at least, 1/{median(speedups):.0f} in the middle"
    )


if __name__ == "__main__":
    main()
