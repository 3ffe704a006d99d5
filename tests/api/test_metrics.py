"""What Prometheus is told: how long, how many, what became of it, and what it takes."""

from __future__ import annotations

import os
import re
import signal
import time

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families

from tests.api.test_damage import done
from tests.api.test_faults import busiest, long_rollout, wait_for
from tests.conftest import Server

STAIR = {"name": "measured", "points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
WALL = {"points": [[-1.2, 0], [0, 0], [0, 1.3], [1.2, 1.3]]}


def figures(server: Server) -> dict[str, float]:
    """By name with labels, as they stand in the answer."""
    text = httpx.get(f"{server.url}/metrics", timeout=60).text
    found = {}
    for family in text_string_to_metric_families(text):
        for sample in family.samples:
            labels = ",".join(f"{name}={value}" for name, value in sorted(sample.labels.items()))
            found[f"{sample.name}{{{labels}}}" if labels else sample.name] = sample.value
    return found


def cancelled_rollouts(server: Server) -> float:
    """How many are counted, once that no longer changes: earlier tests leave some to be killed."""
    name = "stairwright_work_total{outcome=cancelled,pool=rollouts}"
    counted = -1.0
    while counted != (now := figures(server).get(name, 0.0)):
        counted = now
        time.sleep(1.0)
    return counted


@pytest.mark.slow
def test_times_and_outcomes(server: Server) -> None:
    cancelled_before = cancelled_rollouts(server)
    before = figures(server)
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api:
        seed = time.time_ns() % 10**6
        api.post("/plans", json={"terrain": STAIR, "friction": 0.5 + seed * 1e-9})
        api.post("/plans", json={"terrain": WALL, "friction": 0.5 + seed * 1e-9})
        done(api, {"terrain": STAIR, "seed": seed})
        cancelled = long_rollout(api, seed)
        wait_for(api, cancelled, "running")
        api.delete(f"/jobs/{cancelled}")
    for _ in range(100):  # its worker is asked first, and then killed
        if cancelled_rollouts(server) > cancelled_before:
            break
    after = figures(server)

    def more(name: str) -> float:
        return after.get(f"stairwright_{name}", 0.0) - before.get(f"stairwright_{name}", 0.0)

    assert more("work_seconds_count{pool=plans}") == 2
    assert more("work_seconds_sum{pool=plans}") > 0.0
    assert more("waiting_seconds_count{queue=plans}") == 2
    assert more("waiting_seconds_count{queue=rollouts}") == 2
    assert more("work_total{outcome=done,pool=plans}") == 2
    assert more("work_total{outcome=cancelled,pool=rollouts}") == 1
    assert more("outcomes_total{kind=plan,outcome=feasible}") == 2  # the rollout's own too
    assert more("outcomes_total{kind=plan,outcome=infeasible}") == 1
    assert more("outcomes_total{kind=rollout,outcome=success}") == 1
    assert more("results{kind=plan}") == 3
    buckets = [name for name in after if re.match(r"stairwright_work_seconds_bucket.*plans", name)]
    assert len(buckets) > 10


def test_what_it_takes(server: Server) -> None:
    found = figures(server)
    assert found["stairwright_ready"] == 1
    assert found["stairwright_read_only"] == 0
    assert found["stairwright_memory_bytes{by=service}"] > 2**20
    assert found["stairwright_memory_bytes{by=workers}"] > 2**20
    assert found["stairwright_disk_bytes{by=database}"] > 4096
    assert found["stairwright_disk_free_bytes"] > 0
    assert found["process_open_fds"] > 0


@pytest.mark.slow
def test_a_dead_worker_is_counted(server: Server) -> None:
    name = "stairwright_worker_deaths_total{pool=rollouts}"
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api:
        before = figures(server)[name]
        job = long_rollout(api, 77)
        wait_for(api, job, "running")
        os.kill(busiest(server), signal.SIGKILL)
        give_up = time.monotonic() + 60
        while figures(server)[name] == before:
            assert time.monotonic() < give_up
            time.sleep(0.1)
        api.delete(f"/jobs/{job}")
    assert figures(server)[name] == before + 1
