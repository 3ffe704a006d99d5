"""Starts: what is asked early waits, ready means that a plan is answered, and it says why not."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.conftest import free_port

STAIR = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
WALL = {"points": [[-1.2, 0], [0, 0], [0, 0.85], [1.2, 0.85]]}
PATIENCE = 900.0  # s
# Every Python imports this first: there is no planner as long as a file lies there.
BROKEN = """
import pathlib, sys
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "stairwright.planning.planner" and pathlib.Path({!r}).exists():
            raise ImportError("out of order")
sys.meta_path.insert(0, Finder())
"""


@contextlib.contextmanager
def starting(folder: Path, **variables: str) -> Iterator[str]:
    """The address of a server that has just begun to start."""
    port = free_port()
    env = os.environ | variables
    env |= {"STAIRWRIGHT_DATA": str(folder / "data"), "STAIRWRIGHT_PORT": str(port)}
    command = [sys.executable, "-m", "stairwright", "serve"]
    with (folder / "log").open("wb") as log:
        process = subprocess.Popen(
            command, env=env, stdout=log, stderr=subprocess.STDOUT, start_new_session=True
        )
    try:
        yield f"http://127.0.0.1:{port}/api/v1"
    finally:
        process.terminate()
        process.wait(15)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)


@pytest.fixture
def cold(tmp_path: Path) -> Iterator[str]:
    """The same; a plan may take 3 s."""
    with starting(tmp_path, STAIRWRIGHT_PLAN_DEADLINE="3") as api:
        yield api


def asked(api: str, body: dict[str, Any], answers: list[httpx.Response]) -> threading.Thread:
    """Ask for a plan as soon as anybody listens."""

    def ask() -> None:
        give_up = time.monotonic() + PATIENCE
        while time.monotonic() < give_up:
            with contextlib.suppress(httpx.ConnectError):
                answers.append(httpx.post(f"{api}/plans", json=body, timeout=PATIENCE))
                return
            time.sleep(0.1)

    thread = threading.Thread(target=ask)
    thread.start()
    return thread


@pytest.mark.slow
def test_the_web_process_computes_nothing() -> None:
    heavy = ("mujoco", "casadi", "scipy", "trimesh", "viser", "xarray", "distributed")
    ours = ("stairwright.planning.planner", "stairwright.simulation.rollout")
    code = (
        "import sys, stairwright.api.app; "
        f"print([name for name in {(*heavy, *ours)} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.slow
def test_nothing_fails_because_it_is_cold(cold: str, tmp_path: Path) -> None:
    early: list[httpx.Response] = []
    thread = asked(cold, {"terrain": STAIR}, early)
    told: list[str] = []
    give_up = time.monotonic() + PATIENCE
    while True:
        assert time.monotonic() < give_up, (told[-1:], (tmp_path / "log").read_text()[-3000:])
        time.sleep(0.2)
        with contextlib.suppress(httpx.ConnectError):
            health = httpx.get(f"{cold}/healthz", timeout=60)
            if health.status_code == 200:
                break
            assert health.status_code == 503
            told.append(health.json()["detail"])
    # Ready means that any plan answers, an impossible one by the other method too.
    for body in ({"terrain": STAIR, "friction": 0.5}, {"terrain": WALL, "method": "critical"}):
        answer = httpx.post(f"{cold}/plans", json=body, timeout=60)
        assert answer.status_code == 200, answer.text
    thread.join(PATIENCE)
    assert [answer.status_code for answer in early] == [200], early[0].text
    assert all(text.startswith("starting for ") for text in told)
    # An import waits for its worker too, rather than fail.
    file = {"file": ("stairs.csv", b"x,z\n0,0\n1,0\n1,0.1\n2,0.1\n", "text/csv")}
    assert httpx.post(f"{cold}/terrains/import", files=file, timeout=PATIENCE).status_code == 200


def wait_for_health(api: str, status: int, text: str) -> None:
    give_up = time.monotonic() + 120
    seen = ""
    while True:
        assert time.monotonic() < give_up, seen
        time.sleep(0.2)
        with contextlib.suppress(httpx.ConnectError):
            health = httpx.get(f"{api}/healthz", timeout=60)
            seen = health.text
            assert health.status_code in (status, 503)
            if health.status_code == status and text in seen:
                return


@pytest.mark.slow
def test_a_service_that_cannot_plan_is_not_ready(tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    broken.touch()
    (tmp_path / "sitecustomize.py").write_text(BROKEN.format(str(broken)))
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    with starting(tmp_path, PYTHONPATH=path) as api:
        wait_for_health(api, 503, "a trial plan failed (out of order)")
        assert httpx.get(f"{api}/terrains/flat").status_code == 200  # the rest goes on
        broken.unlink()
        wait_for_health(api, 200, "ok")
        assert httpx.post(f"{api}/plans", json={"terrain": STAIR}, timeout=60).is_success
