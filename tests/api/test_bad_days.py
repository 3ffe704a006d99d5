"""A start on a full disk, in a read-only folder, over a damaged database, with a wrong clock.

What can be read is.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import httpx
import pytest

from stairwright.api.app import create_app
from stairwright.api.settings import Settings
from tests.conftest import Server, serve
from tests.in_process import served

pytestmark = pytest.mark.slow  # servers of its own

Start = Callable[..., contextlib.AbstractContextManager[Server]]

STAIR = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
NAMESPACE = ("unshare", "--map-root-user", "--mount")  # may mount, seen by nobody else
# The data folder on a disk of 1 MiB, copied there and filled up.
FULL = """
data=$1; shift
cp -a "$data" "$data.whole" && mount -t tmpfs -o size=1m none "$data" || exit 1
cp -a "$data.whole/." "$data/" && cat /dev/zero > "$data/other"
exec "$@"
"""
# Root obeys permissions too without these.
MORTAL = ("setpriv", "--bounding-set=-dac_override,-dac_read_search")
# Imported by every Python process before anything else. No namespace of Linux shifts this clock.
AHEAD = "import time\nright = time.time\ntime.time = lambda: right() + {} * 86400.0\n"
JUMPING = """
import pathlib, time
right, later = time.time, pathlib.Path({!r})
time.time = lambda: right() + 5 * 86400.0 * later.exists()
"""


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """The folder that a server left, and the plan in it; it and its terrain are called `kept`."""
    folder = tmp_path_factory.mktemp("stored") / "data"
    with serve(folder) as server, httpx.Client(base_url=f"{server.url}/api/v1") as api:
        assert api.put("/terrains/kept", json=STAIR).status_code == 201
        made: dict[str, Any] = api.post("/plans", json={"terrain": "kept"}, timeout=120).json()
        assert api.patch(f"/plans/{made['id']}", json={"name": "kept"}).status_code == 200
    return folder, made


@pytest.fixture
def plan(stored: tuple[Path, dict[str, Any]], tmp_path: Path) -> dict[str, Any]:
    """A plan that lies in this test's data folder."""
    folder, made = stored
    shutil.copytree(folder, tmp_path / "data")
    return made


@contextlib.contextmanager
def read_only(server: Server) -> Iterator[httpx.Client]:
    """Checks what every server does that can write nothing, and then more."""
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api:
        health = api.get("/healthz").json()
        assert "nothing is saved" in health["read_only"]
        refused = [
            api.put("/terrains/new", json=STAIR),
            api.delete("/terrains/kept"),
            api.post("/rollouts", json={"terrain": "kept"}, headers={"idempotency-key": "k"}),
        ]
        for answer in refused:
            assert answer.status_code == 503
            assert answer.json()["type"].endswith("read-only")
            assert answer.json()["detail"] == health["read_only"]
        assert api.get("/terrains/kept").json()["points"] == STAIR["points"]
        made = api.post(
            "/plans", json={"terrain": "kept", "friction": 0.5}, headers={"idempotency-key": "k"}
        )
        assert made.status_code == 200, made.text
        assert made.json()["status"] == "feasible"
        yield api
    log = server.log.read_text()
    assert log.count("nothing is saved") == 1, log
    assert "Traceback" not in log


def namespaces() -> bool:
    return subprocess.run([*NAMESPACE, "true"], capture_output=True).returncode == 0


def test_a_start_on_a_full_disk(start_server: Start, plan: dict[str, Any], tmp_path: Path) -> None:
    if not namespaces():
        pytest.skip("this system lets nobody mount a small disk")
    prefix = [*NAMESPACE, "sh", "-c", FULL, "sh", str(tmp_path / "data")]
    with start_server(prefix=prefix) as server, read_only(server) as api:
        assert api.get(f"/plans/{plan['id']}").json() == plan
        assert "free some space" in api.get("/healthz").json()["read_only"]
        # The same question is answered from what is stored.
        assert api.post("/plans", json={"terrain": "kept"}).json() == plan


def permissions(folder: Path, mode: str) -> None:
    subprocess.run(["chmod", "-R", mode, str(folder)], check=True)


def mortal() -> Sequence[str]:
    return MORTAL if os.geteuid() == 0 else ()


def test_a_read_only_folder_of_a_server_that_was_killed(
    start_server: Start, plan: dict[str, Any], tmp_path: Path
) -> None:
    with start_server() as server, httpx.Client(base_url=f"{server.url}/api/v1") as api:
        api.put("/terrains/late", json=STAIR)
        server.process.kill()  # what was saved last is in SQLite's log only
    assert (tmp_path / "data" / "stairwright.sqlite-wal").stat().st_size > 0
    permissions(tmp_path / "data", "a-w")
    try:
        with start_server(prefix=mortal()) as server, read_only(server) as api:
            assert api.get("/terrains/late").status_code == 200
            assert api.get(f"/plans/{plan['id']}").json() == plan
            assert "make it writable" in api.get("/healthz").json()["read_only"]
    finally:
        permissions(tmp_path / "data", "u+w")
    with start_server() as server, httpx.Client(base_url=f"{server.url}/api/v1") as api:
        assert api.get("/healthz").json()["read_only"] is None
        # Names survive restarts and the same question.
        assert api.post("/plans", json={"terrain": "kept"}, timeout=120).json() == plan
        assert [each["name"] for each in api.get("/plans").json()] == ["kept"]


def test_a_damaged_database_on_a_full_disk(
    start_server: Start, plan: dict[str, Any], tmp_path: Path
) -> None:
    if not namespaces():
        pytest.skip("this system lets nobody mount a small disk")
    assert plan
    harm(tmp_path / "data" / "stairwright.sqlite", "end")
    prefix = [*NAMESPACE, "sh", "-c", FULL, "sh", str(tmp_path / "data")]
    with start_server(prefix=prefix) as server, read_only(server):
        assert "damaged database, which stays where it is" in server.log.read_text()


def test_a_folder_that_cannot_be_made(start_server: Start, tmp_path: Path) -> None:
    closed = tmp_path / "closed"
    closed.mkdir()
    permissions(closed, "a-w")
    variables = {"STAIRWRIGHT_DATA": str(closed / "data")}
    with start_server(prefix=mortal(), **variables) as server:
        answer = httpx.post(f"{server.url}/api/v1/plans", json={"terrain": STAIR}, timeout=120)
        assert answer.json()["status"] == "feasible"
        assert "Permission denied" in server.log.read_text()


def harm(database: Path, how: str) -> bytes:
    """Damage a database; what is in it now."""
    content = bytearray(database.read_bytes())
    if how == "head":
        content[:4096] = os.urandom(4096)
    else:  # all but the table of terrains, which lies in the front
        half = len(content) * 3 // 4
        content[half:] = os.urandom(len(content) - half)
    database.write_bytes(content)
    return bytes(content)


def set_aside(data: Path, harmed: bytes, url: str, log: str) -> None:
    """A server answers at `url` that found `harmed` as its database."""
    with httpx.Client(base_url=f"{url}/api/v1", timeout=120) as api:
        assert api.put("/terrains/new", json=STAIR).status_code == 201
    assert "stairwright.sqlite.damaged-1" in log
    assert "restore a backup" in log
    assert (data / "stairwright.sqlite.damaged-1").read_bytes() == harmed
    assert list(data.glob("artefacts/??/*"))  # results of the old one stay for it


def test_a_damaged_database_is_set_aside(
    plan: dict[str, Any], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    assert plan
    data = tmp_path / "data"
    harmed = harm(data / "stairwright.sqlite", "head")
    with served(create_app(Settings(data=data))) as (_, port):
        set_aside(data, harmed, f"http://127.0.0.1:{port}", caplog.text)


def test_what_can_be_read_of_a_damaged_database_is(
    start_server: Start, plan: dict[str, Any], tmp_path: Path
) -> None:
    assert plan
    data = tmp_path / "data"
    harmed = harm(data / "stairwright.sqlite", "end")
    with start_server() as server:
        set_aside(data, harmed, server.url, server.log.read_text())
        assert httpx.get(f"{server.url}/api/v1/healthz").json()["read_only"] is None
        assert httpx.get(f"{server.url}/api/v1/terrains/kept").status_code == 200
    with start_server() as server:
        assert httpx.get(f"{server.url}/api/v1/terrains/new").status_code == 200
    assert len(list(data.glob("*.damaged-*"))) == 1


def with_clock(folder: Path, module: str) -> dict[str, str]:
    """Variables with which every Python process has the clock of `module`."""
    (folder / "sitecustomize.py").write_text(module)
    return {"PYTHONPATH": os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])}


def test_a_clock_100_days_ahead_deletes_nothing(
    start_server: Start, plan: dict[str, Any], tmp_path: Path
) -> None:
    with start_server(**with_clock(tmp_path, AHEAD.format(100))) as server:
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
    with start_server(**with_clock(tmp_path, JUMPING.format(str(later)))) as server:
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
