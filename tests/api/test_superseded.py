"""A client that goes away takes its question along, so that the next one need not wait."""

from __future__ import annotations

import time

import httpx
import pytest

from tests.conftest import Server

MANY = {"points": [[-1.0, 0.0]] + [
    corner
    for k in range(120)
    for corner in ([0.3 * k, 0.17 * k], [0.3 * k, 0.17 * (k + 1)])
] + [[38.0, 20.4]]}  # fmt: skip
STEP = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}


def running(server: Server) -> float:
    """Plans at work, as the figures tell."""
    text = httpx.get(f"{server.url}/metrics").text
    lines = (line for line in text.splitlines() if line.startswith("stairwright_plans_running"))
    return float(next(lines).split()[1])


@pytest.mark.slow
def test_a_client_that_goes_away_frees_its_worker(server: Server) -> None:
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api:
        api.post("/plans", json={"terrain": STEP, "method": "critical"})  # all is warm
        for k in range(6):  # more than there are workers
            body = {"terrain": MANY, "friction": 0.9 + 0.001 * k}
            with pytest.raises(httpx.ReadTimeout):
                httpx.post(f"{server.url}/api/v1/plans", json=body, timeout=0.3)
        answer = api.post("/plans", json={"terrain": STEP, "method": "critical", "friction": 0.77})
        assert answer.status_code == 200
    give_up = time.monotonic() + 30
    while running(server) > 0:
        assert time.monotonic() < give_up, "a solve goes on that nobody waits for"
        time.sleep(0.02)
