"""Fast timing against steady timing: the same paths, how much sooner, and do they still succeed?

    python benchmarks/fast.py [--first 0] [--count 30] [--robots a1_wheeled,a1_wheeled_x,go2w]
                              [--aggressiveness 0.75] [--bundle laboratory] [--sensing ideal]
                              [--friction 0.6] [--facing backward] [--quick]

Five stairs of 0.18 m by 0.28 m up and down, and random profiles (`profiles.py`). Speeds are those
over the faces: from the first contact with the first one to all wheels on the landing. With
`--bundle` every rollout has deviations drawn from it.
"""

from __future__ import annotations

import argparse
from collections import Counter
from functools import partial
from statistics import median

from profiles import random_profile

import stairwright as sw
from stairwright.terrain.stairs import Direction, stair

ROBOTS = "a1_wheeled,a1_wheeled_x,go2w"


def flight(direction: Direction) -> sw.Terrain:
    """Five stairs, 0.18 m by 0.28 m."""
    level = (1.0, 1.18) if direction == "up" else (1.18, 1.0)  # before and after
    return stair(
        0.18, 0.28, 5, direction=direction, approach=level[0], platform=level[1],
        name=f"five stairs {direction}",
    )  # fmt: skip


def outcome(plan: sw.Plan, options: argparse.Namespace, seed: int) -> sw.Rollout:
    deviation = None
    if options.bundle:
        drawn = sw.trials(plan, 1, seed=seed, bundle=options.bundle, workers=1).trials[0]
        deviation = drawn.disturbance
    controller = {"sensing": options.sensing} if options.sensing else None
    return sw.rollout(plan, controller=controller, disturbance=deviation, seed=seed)


def compare(
    name: str, questions: list[sw.Terrain], robot: str, options: argparse.Namespace
) -> None:
    outcomes: Counter[str] = Counter()
    ratios, speeds, failures = [], [], []
    for seed, terrain in enumerate(questions):
        weights = {"aggressiveness": options.aggressiveness}
        make = partial(
            sw.plan, terrain, robot, options.friction, facing=options.facing, diagnose=False
        )
        fast = make(weights=weights, timing="fast")
        if not fast.feasible:
            outcomes["no plan"] += 1
            continue
        run = outcome(fast, options, seed)
        outcomes[run.outcome] += 1
        if run.outcome != "success":
            failures.append(f"{terrain.name}: {run.outcome}: {run.reason}")
            continue
        slow = make()
        if not slow.feasible:
            failures.append(f"{terrain.name}: no steady plan beside the fast one")
            continue
        steady = outcome(slow, options, seed)
        if steady.outcome == "success" and run.metrics.speed_stairs and steady.metrics.speed_stairs:
            speeds.append(run.metrics.speed_stairs)
            ratios.append(run.metrics.speed_stairs / steady.metrics.speed_stairs)
    plans = sum(outcomes.values()) - outcomes["no plan"]
    figures = f"{median(speeds):.3f} m/s, {median(ratios):.2f} x steady" if speeds else "-"
    print(f"| {name} | {robot} | {outcomes['success']} of {plans} | {figures} |", flush=True)
    for failure in failures:
        print(f"    {failure}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--robots", default=ROBOTS)
    parser.add_argument("--aggressiveness", type=float, default=0.75)
    parser.add_argument("--friction", type=float, default=0.6)
    parser.add_argument("--facing", choices=("forward", "backward", "either"))
    parser.add_argument("--bundle")
    parser.add_argument("--sensing", choices=("robot", "ideal"))
    parser.add_argument("--quick", action="store_true", help="one robot, three profiles")
    options = parser.parse_args()
    if options.quick:
        options.robots, options.count = "a1_wheeled_x", 3
    seeds = range(options.first, options.first + options.count)
    profiles = []
    for seed in seeds:
        kind, terrain = random_profile(seed)
        profiles.append(terrain.model_copy(update={"name": f"{kind} {seed}"}))
    print("| terrain | robot | succeed | median speed over faces |\n|---|---|---|---|")
    for robot in options.robots.split(","):
        for terrain in (flight("up"), flight("down")):
            compare(terrain.name, [terrain], robot, options)
        compare(f"{len(profiles)} random profiles", profiles, robot, options)


if __name__ == "__main__":
    main()
