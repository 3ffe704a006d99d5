"""How many random profiles are planned, certified and rolled out.

python benchmarks/random_profiles.py [--first 0] [--count 60] [--friction 0.6]
    [--true-friction 0.6] [--speed 0.12] [--no-rollout] [--json FILE]
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
from profiles import random_profile

import stairwright as sw

ROBOTS = ("a1_wheeled", "a1_wheeled_x")


def one(seed: int, robot: str, options: argparse.Namespace) -> dict[str, object]:
    kind, terrain = random_profile(seed)
    begun = time.process_time()
    plan = sw.plan(terrain, robot, options.friction, weights={"speed": options.speed})
    row: dict[str, object] = {
        "seed": seed, "kind": kind, "robot": robot, "planned": plan.feasible,
        "cpu": time.process_time() - begun,
    }  # fmt: skip
    if not plan.feasible:
        assert plan.problem is not None
        return row | {"problem": plan.problem.message}
    row["certified"] = sw.certify(plan).passed
    margins = np.array([list(p.margins.model_dump().values()) for p in plan.poses]).min(axis=0)
    row["margins"] = [round(float(m), 4) for m in margins]
    if options.rollout:
        begun = time.process_time()
        run = sw.rollout(plan, friction=options.true_friction)
        row["outcome"] = run.outcome
        row["contacts"] = run.metrics.link_contacts
        row["rollout_cpu"] = time.process_time() - begun
    return row


def table(rows: list[dict[str, object]]) -> None:
    print(f"{'robot':14}{'kind':14}{'n':>4}{'plans':>6}{'cert':>6}{'ok':>5}{'clean':>6}  CPU ms")
    for robot in ROBOTS:
        mine = [r for r in rows if r["robot"] == robot]
        for kind in [*dict.fromkeys(str(r["kind"]) for r in mine), "ALL"]:
            part = [r for r in mine if kind in ("ALL", r["kind"])]
            plans = [r for r in part if r["planned"]]
            good = [r for r in plans if r.get("outcome") == "success"]
            ms = 1e3 * np.array([float(str(r["cpu"])) for r in part])
            print(
                f"{robot:14}{kind:14}{len(part):4}{len(plans):6}"
                f"{sum(bool(r['certified']) for r in plans):6}{len(good):5}"
                f"{sum(r['contacts'] == 0 for r in good):6}"
                f"  {np.median(ms):.0f} / p95 {np.percentile(ms, 95):.0f}"
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--friction", type=float, default=0.6)
    parser.add_argument("--true-friction", type=float, default=None)
    parser.add_argument("--speed", type=float, default=0.12)
    parser.add_argument("--no-rollout", dest="rollout", action="store_false")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    if options.true_friction is None:
        options.true_friction = options.friction
    rows = []
    for seed in range(options.first, options.first + options.count):
        for robot in ROBOTS:
            rows.append(one(seed, robot, options))
            r = rows[-1]
            odd = not r["planned"] or not r["certified"] or r.get("outcome") != "success"
            if odd or r.get("contacts"):
                print({k: v for k, v in r.items() if k not in ("planned", "certified")}, flush=True)
    table(rows)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
