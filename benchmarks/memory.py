"""Memory of the server and its workers, before and after work: it must stay flat.

    python benchmarks/memory.py [--jobs 1000] [--quick] [--json FILE]

All processes together; what they share counts once (PSS). First 100 plans and 20 rollouts, each a
new question, twice: the first round also fills caches that have a limit, the second must add
nothing. Then `--jobs` short rollouts.
"""

from __future__ import annotations

import argparse
import time

import httpx
from report import Row, publish
from service import STAIR, Service, serve, wait_for

SETTLED = 3.0  # s after which results are compressed and nothing is under way


def work(api: httpx.Client, plans: int, rollouts: int, start: int) -> None:
    """New questions, one after the other."""
    for k in range(plans):
        body = {"terrain": "single-stair-030", "friction": 0.55 + 1e-5 * (start + k)}
        api.post("/plans", json=body).raise_for_status()
    for k in range(rollouts):
        body = {"terrain": STAIR, "method": "nominal", "seed": start + k}
        answer = api.post("/rollouts", json=body)
        answer.raise_for_status()
        wait_for(api, answer.json()["id"], "done")


def settled(service: Service) -> float:
    """Memory when nothing is under way [MiB]."""
    time.sleep(SETTLED)
    return service.memory()


def run(quick: bool = False, jobs: int | None = None) -> list[Row]:
    """All rows; the note is the change since the row above."""
    jobs = jobs or (50 if quick else 1000)
    plans, rollouts = (20, 4) if quick else (100, 20)
    steps = [
        ("server and workers, one plan and one rollout", 1, 1),
        (f"after {plans} plans and {rollouts} rollouts", plans, rollouts),
        (f"after {plans} plans and {rollouts} rollouts more", plans, rollouts),
        (f"after {jobs} rollouts more", 0, jobs),
    ]
    rows: list[Row] = []
    with (
        serve(plan_workers="1", rollout_workers="1") as service,
        httpx.Client(base_url=service.api, timeout=300) as api,
    ):
        for k, (what, some_plans, some_rollouts) in enumerate(steps):
            work(api, some_plans, some_rollouts, 10_000 * k)
            now = settled(service)
            before = rows[-1].median if rows else None
            change = "" if before is None else f"{100 * (now / before - 1):+.1f} %"
            rows.append(Row(what, "stairwright", now, unit="MiB", note=change))
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, help="short rollouts in the end (1000)")
    parser.add_argument("--quick", action="store_true", help="few of everything")
    parser.add_argument("--json")
    given = parser.parse_args()
    publish(run(given.quick, given.jobs), given.json)


if __name__ == "__main__":
    main()
