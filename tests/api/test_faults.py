"""Workers killed, servers killed, jobs cancelled, queues full: told honestly, nothing hangs."""

from __future__ import annotations

import contextlib
import os
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from stairwright.api.app import create_app
from stairwright.api.settings import Settings
from stairwright.errors import InputError
from stairwright.storage.lock import FolderLock
from tests.conftest import Server, serve

Start = Callable[..., contextlib.AbstractContextManager[Server]]

LONG = {"points": [[-1.0, 0], [15.0, 0]]}  # minutes of driving
STAIR = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}


@pytest.fixture
def api(server: Server) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as client:
        yield client


def wait_for(api: httpx.Client, job: str, *states: str) -> dict[str, Any]:
    give_up = time.monotonic() + 120
    while True:
        document: dict[str, Any] = api.get(f"/jobs/{job}").json()
        if document["state"] in states:
            return document
        assert time.monotonic() < give_up, document
        time.sleep(0.1)


def long_rollout(api: httpx.Client, seed: int) -> str:
    """A job that runs for a while: a slow drive."""
    body = {"terrain": LONG, "robot": "a1_wheeled", "method": "nominal", "seed": seed,
            "weights": {"speed": 0.02}}  # fmt: skip
    answer = api.post("/rollouts", json=body)
    assert answer.status_code == 202, answer.text
    return str(answer.json()["id"])


def workers(server: Server) -> dict[int, int]:
    """Processes below the server and the processor time [ticks] of each."""
    parents, spent = {}, {}
    for entry in Path("/proc").iterdir():
        with contextlib.suppress(OSError, ValueError):
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
            parents[int(entry.name)] = int(fields[1])
            spent[int(entry.name)] = int(fields[11]) + int(fields[12])
    below = {server.process.pid}
    for _ in range(4):
        below |= {pid for pid, parent in parents.items() if parent in below}
    return {pid: spent[pid] for pid in below - {server.process.pid}}


def busiest(server: Server) -> int:
    before = workers(server)
    time.sleep(0.5)
    after = workers(server)
    return max(after, key=lambda pid: after[pid] - before.get(pid, 0))


@pytest.mark.slow
def test_cancelling_a_running_rollout(api: httpx.Client) -> None:
    job = long_rollout(api, 1)
    wait_for(api, job, "running")
    cancelled = api.delete(f"/jobs/{job}")
    assert cancelled.json()["state"] == "cancelled"
    assert cancelled.json()["error"]["title"]
    assert api.get(f"/jobs/{job}").json()["state"] == "cancelled"
    assert api.delete(f"/jobs/{job}").status_code == 200  # nothing to do any more
    quick = api.post("/rollouts", json={"terrain": STAIR}).json()
    assert wait_for(api, quick["id"], "done", "failed")["state"] == "done"


def test_two_jobs_with_one_question_share_a_run(api: httpx.Client) -> None:
    one, two = long_rollout(api, 2), long_rollout(api, 2)
    assert one != two
    wait_for(api, two, "running")
    api.delete(f"/jobs/{one}")
    assert api.get(f"/jobs/{one}").json()["state"] == "cancelled"
    assert api.get(f"/jobs/{two}").json()["state"] == "running"  # the other user's goes on
    api.delete(f"/jobs/{two}")


@pytest.mark.slow
def test_a_worker_killed_in_mid_rollout(server: Server, api: httpx.Client) -> None:
    job = long_rollout(api, 3)
    give_up = time.monotonic() + 60
    while api.get(f"/jobs/{job}").json()["progress"] <= 0.11:
        assert time.monotonic() < give_up
        time.sleep(0.05)
    os.kill(busiest(server), signal.SIGKILL)
    give_up = time.monotonic() + 60
    while (again := api.get(f"/jobs/{job}").json())["progress"] > 0.1:
        assert again["state"] in ("queued", "running")
        assert time.monotonic() < give_up, "it does not begin anew"
        time.sleep(0.01)
    assert wait_for(api, job, "running", "failed")["state"] == "running"
    api.delete(f"/jobs/{job}")
    quick = api.post("/rollouts", json={"terrain": STAIR, "seed": 5}).json()
    assert wait_for(api, quick["id"], "done", "failed")["state"] == "done"


def test_plans_do_not_wait_behind_rollouts(api: httpx.Client) -> None:
    jobs = [long_rollout(api, 100 + k) for k in range(4)]
    wait_for(api, jobs[0], "running")
    answer = api.post("/plans", json={"terrain": STAIR, "friction": 0.71})
    assert answer.status_code == 200
    assert api.get(f"/jobs/{jobs[-1]}").json()["state"] == "queued"
    for job in reversed(jobs):
        api.delete(f"/jobs/{job}")


@pytest.fixture(scope="module")
def narrow(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server that carries out one job at a time and lets two wait."""
    variables = {"STAIRWRIGHT_QUEUE_LIMIT": "2", "STAIRWRIGHT_ROLLOUT_WORKERS": "1"}
    with serve(tmp_path_factory.mktemp("narrow") / "data", **variables) as server:
        yield server


@pytest.mark.slow
def test_a_full_queue_says_when_to_come_back(narrow: Server) -> None:
    with httpx.Client(base_url=f"{narrow.url}/api/v1", timeout=120) as api:
        jobs = [long_rollout(api, k) for k in range(3)]
        body = {"terrain": LONG, "method": "nominal", "seed": 99}
        refused = api.post("/rollouts", json=body)
        assert refused.status_code == 429
        assert int(refused.headers["retry-after"]) >= 1
        assert refused.json()["type"].endswith("queue-full")
        api.delete(f"/jobs/{jobs[1]}")
        taken = api.post("/rollouts", json=body)
        assert taken.status_code == 202
        for job in (jobs[0], jobs[2], taken.json()["id"]):
            api.delete(f"/jobs/{job}")


@pytest.mark.slow
def test_a_second_server_on_the_same_folder_is_refused(
    narrow: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(FolderLock.__init__, "__defaults__", (0.1,))  # its patience
    with httpx.Client(base_url=f"{narrow.url}/api/v1", timeout=120) as api:
        job = long_rollout(api, 1)
        wait_for(api, job, "running")
        with pytest.raises(InputError, match="uses the data folder"):
            create_app(Settings(data=narrow.data))
        assert api.get(f"/jobs/{job}").json()["state"] == "running"
        api.delete(f"/jobs/{job}")


@pytest.mark.slow
def test_a_deadline_fails_the_job(start_server: Start) -> None:
    with (
        start_server(STAIRWRIGHT_ROLLOUT_DEADLINE="0.5") as server,
        httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api,
    ):
        failed = wait_for(api, long_rollout(api, 1), "failed", "done")
        assert failed["error"]["type"].endswith("deadline")


@pytest.mark.slow
def test_a_server_killed_outright_keeps_what_it_acknowledged(start_server: Start) -> None:
    """What is stored, and what is accepted: queued and running. A repeated key finds its job."""

    def ask(api: httpx.Client, seed: int) -> str:
        body, key = {"terrain": STAIR, "seed": seed}, {"idempotency-key": f"k{seed}"}
        answer = api.post("/rollouts", json=body, headers=key)
        assert answer.status_code == 202
        return str(answer.json()["id"])

    with start_server(STAIRWRIGHT_ROLLOUT_WORKERS="1") as server:
        with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api:
            api.put("/terrains/kept", json=STAIR)
            plan = api.post("/plans", json={"terrain": "kept"}).json()
            quick = api.post("/rollouts", json={"plan_id": plan["id"]}).json()
            result = wait_for(api, quick["id"], "done", "failed")["result"]
            run = api.get(result.removeprefix("/api/v1")).json()
            lost = long_rollout(api, 1)
            wait_for(api, lost, "running")
            jobs = [ask(api, seed) for seed in range(1, 4)]
        children = set(workers(server))
        server.process.kill()
        server.process.wait()
        give_up = time.monotonic() + 30
        while any(Path(f"/proc/{pid}").exists() for pid in children):
            assert time.monotonic() < give_up, "workers outlive the server"
            time.sleep(0.05)
    with (
        start_server(STAIRWRIGHT_ROLLOUT_WORKERS="1") as server,
        httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api,
    ):
        assert api.get("/terrains/kept").json()["points"] == STAIR["points"]
        assert api.get(f"/plans/{plan['id']}").json() == plan
        assert api.get(result.removeprefix("/api/v1")).json() == run
        assert api.get(f"/jobs/{quick['id']}").json()["state"] == "done"
        assert wait_for(api, lost, "running", "failed")["state"] == "running"  # it goes on
        assert [ask(api, seed) for seed in range(1, 4)] == jobs
        api.delete(f"/jobs/{lost}")
        for job in jobs:
            assert wait_for(api, job, "done", "failed")["state"] == "done"
        assert [ask(api, seed) for seed in range(1, 4)] == jobs
        listed = api.get("/jobs", params={"state": "done", "limit": 3})
        assert len(listed.json()) == 3
        rollout = api.get(f"/jobs/{jobs[0]}").json()["result"].rpartition("/")[2]
        assert api.delete(f"/rollouts/{rollout}").status_code == 204
        assert api.get(f"/rollouts/{rollout}").status_code == 404
        # The key of a job whose result is gone starts it anew.
        anew = ask(api, 1)
        assert wait_for(api, anew, "done", "failed")["state"] == "done"
        assert anew != jobs[0]
