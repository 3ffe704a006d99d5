"""A server that starts with a wrong clock keeps what is stored, and says that the clock is odd."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest

from tests.conftest import Server

pytestmark = pytest.mark.slow  # servers of its own

Start = Callable[..., contextlib.AbstractContextManager[Server]]

STAIR = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
# Imported by every Python process before anything else. No namespace of Linux shifts this clock.
AHEAD = "import time\nright = time.time\ntime.time = lambda: right() + {} * 86400.0\n"
JUMPING = """
import pathlib, time
right, later = time.time, pathlib.Path({!r})
time.time = lambda: right() + 5 * 86400.0 * later.exists()
"""


def test_a_clock_100_days_ahead_deletes_nothing(start_server: Start, tmp_path: Path) -> None:
    with start_server() as server, httpx.Client(base_url=f"{server.url}/api/v1") as api:
        plan = api.post("/plans", json={"terrain": STAIR}, timeout=120).json()
        api.put("/terrains/kept", json=STAIR)
    ahead = tmp_path / "ahead"
    ahead.mkdir()
    (ahead / "sitecustomize.py").write_text(AHEAD.format(100))
    path = os.pathsep.join([str(ahead), os.environ.get("PYTHONPATH", "")])
    with start_server(PYTHONPATH=path) as server:
        with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api:
            assert api.get(f"/plans/{plan['id']}").json() == plan
            assert api.get("/terrains/kept").status_code == 200
            later = api.post("/plans", json={"terrain": STAIR, "friction": 0.5}).json()["id"]
        log = server.log.read_text()
        assert "last used 100 days ago" in log
        assert "removed" not in log.replace("nothing is removed", "")
    with start_server() as server, httpx.Client(base_url=f"{server.url}/api/v1") as api:
        assert api.get(f"/plans/{plan['id']}").json() == plan
        assert api.get(f"/plans/{later}").status_code == 200


def test_a_clock_that_jumps_meanwhile_is_told(start_server: Start, tmp_path: Path) -> None:
    later = tmp_path / "later"
    (tmp_path / "sitecustomize.py").write_text(JUMPING.format(str(later)))
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    with start_server(PYTHONPATH=path) as server:
        for change in (later.touch, later.unlink):
            before = server.log.read_text().count("the clock was set")
            change()
            give_up = time.monotonic() + 60
            while server.log.read_text().count("the clock was set") == before:
                assert time.monotonic() < give_up
                time.sleep(0.2)
        log = server.log.read_text()
        assert "the clock was set forward by 5 days" in log
        assert "the clock was set back by 5 days" in log
