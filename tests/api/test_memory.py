"""What a service takes after a day's work: web process, workers, and what they are forked from."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from stairwright.jobs.worker import RESTLESS

MOST = 300.0  # MiB; measured 259 to 290
PLANS, ROLLOUTS = 20, 4
TERRAINS = ("curb-015", "ramp-1-8", "single-stair-036", "stairs-us-7-11", "three-stairs-up")


def _tree(pid: int) -> Iterator[int]:
    """A process and all that it started."""
    yield pid
    for children in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in children.read_text().split():
            yield from _tree(int(child))


def _proportional(pid: int) -> float:
    """MiB of a process; what several share counts in equal parts."""
    lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_a_service_stays_small(start_server: Any) -> None:
    workers = {"STAIRWRIGHT_PLAN_WORKERS": "2", "STAIRWRIGHT_ROLLOUT_WORKERS": "2"}
    with (
        start_server(cold=True, **workers) as server,
        httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as client,
    ):
        plans = []
        for k in range(PLANS):
            body = {"terrain": TERRAINS[k % 5], "friction": 0.5 + k / 500}
            body |= {"method": ("path", "path", "critical")[k % 3]}
            answer = client.post("/plans", json=body)
            assert answer.status_code == 200, answer.text
            plans.append(answer.json())
        feasible = [plan["id"] for plan in plans if plan["status"] == "feasible"]
        hurried = {"controller": {"speed": 1.0}}
        jobs = [
            client.post("/rollouts", json={"plan_id": plan} | hurried)
            for plan in feasible[:ROLLOUTS]
        ]
        assert len(jobs) == ROLLOUTS
        for job in jobs:
            while client.get(f"{server.url}{job.headers['location']}").json()["state"] != "done":
                time.sleep(0.1)
        time.sleep(RESTLESS + 1.0)
        used = {pid: _proportional(pid) for pid in _tree(server.process.pid)}
    print(f"{sum(used.values()):.0f} MiB in {len(used)} processes")
    assert sum(used.values()) < MOST, used
