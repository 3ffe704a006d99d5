"""docs/deploy.md: its files are accepted by the programs they are for, its commands work."""

from __future__ import annotations

import contextlib
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest

from tests.conftest import Server

Start = Callable[..., contextlib.AbstractContextManager[Server]]

DOCUMENT = Path(__file__).parents[1] / "docs" / "deploy.md"
STAIR = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}


def block(kind: str, containing: str) -> str:
    """A code block of the document."""
    blocks = re.findall(rf"^```{kind}\n(.*?)^```$", DOCUMENT.read_text(), re.DOTALL | re.MULTILINE)
    (found,) = [each for each in blocks if containing in each]
    return str(found)


def program(name: str) -> str:
    found = shutil.which(name) or shutil.which(name, path="/usr/sbin:/sbin")
    if found is None:
        pytest.skip(f"{name} is not installed here")
    return found


def test_the_unit_is_accepted_by_systemd(tmp_path: Path) -> None:
    environment = tmp_path / "environment"
    environment.touch()
    unit = tmp_path / "stairwright.service"
    text = block("ini", "[Service]").replace("/opt/stairwright/bin/stairwright", sys.executable)
    unit.write_text(text.replace("/etc/stairwright/environment", str(environment)))
    command = [program("systemd-analyze"), "verify", "--man=no", str(unit)]
    done = subprocess.run(command, capture_output=True, text=True)
    ours = [line for line in done.stderr.splitlines() if "stairwright" in line]
    assert done.returncode == 0, done.stderr
    assert not ours, ours


def test_nginx_accepts_its_part(tmp_path: Path) -> None:
    nginx = program("nginx")
    for name in ("pem", "key"):
        assert f"/etc/ssl/stairs.example.{name}" in block("nginx", "upstream")
    subject = ["-subj", "/CN=stairs.example", "-days", "1", "-nodes"]
    files = ["-keyout", str(tmp_path / "x.key"), "-out", str(tmp_path / "x.pem")]
    command = [program("openssl"), "req", "-x509", "-newkey", "rsa:2048", *subject, *files]
    subprocess.run(command, check=True, capture_output=True)
    inside = block("nginx", "upstream").replace("/etc/ssl/stairs.example.", f"{tmp_path}/x.")
    whole = tmp_path / "nginx.conf"
    kinds = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    folders = "\n".join(f"{kind}_temp_path {tmp_path}/{kind};" for kind in kinds)
    http = f"access_log off;\n{folders}\n{inside}"
    whole.write_text(f"pid {tmp_path}/pid;\nevents {{}}\nhttp {{\n{http}\n}}\n")
    checked = [nginx, "-t", "-q", "-p", str(tmp_path), "-e", "stderr", "-c", str(whole)]
    done = subprocess.run(checked, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_caddy_accepts_its_part(tmp_path: Path) -> None:
    file = tmp_path / "Caddyfile"
    file.write_text(block("caddy", "reverse_proxy"))
    command = [program("caddy"), "adapt", "--config", str(file), "--validate"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def shell(script: str, data: Path, backup: Path) -> None:
    """A block of the document, with other folders and this Python."""
    script = script.replace("/var/lib/stairwright", str(data))
    script = script.replace("/var/backups/stairwright", str(backup))
    script = script.replace("/opt/stairwright/bin/python", sys.executable)
    subprocess.run(["sh", "-eu", "-c", script], check=True, capture_output=True, text=True)


@pytest.mark.slow
def test_a_backup_of_a_running_service_is_restored(start_server: Start, tmp_path: Path) -> None:
    data, backup = tmp_path / "data", tmp_path / "backup"
    with (
        start_server() as server,
        httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api,
    ):
        api.put("/terrains/kept", json=STAIR)
        plan = api.post("/plans", json={"terrain": "kept"}).json()
        shell(block("sh", "# backup"), data, backup)
        api.put("/terrains/later", json=STAIR)
        shell(block("sh", "# backup"), data, backup)  # again, over the first one
        assert api.delete("/terrains/kept").status_code == 204
    for file in data.glob("artefacts/??/*"):
        file.unlink()
    shell(block("sh", "# restore"), data, backup)
    with start_server() as server, httpx.Client(base_url=f"{server.url}/api/v1") as api:
        assert api.get("/terrains/kept").status_code == 200
        assert api.get("/terrains/later").status_code == 200
        assert api.get(f"/plans/{plan['id']}").json() == plan
    assert list((data / "before-restore").iterdir())
