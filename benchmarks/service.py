"""A real server for the benchmarks that measure the service: started, watched, killed."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx

START_LIMIT = 120.0  # s
STAIR = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
LONG = {"points": [[-1.0, 0], [40.0, 0]]}


@dataclass
class Service:
    """A running `stairwright serve`."""

    url: str
    process: subprocess.Popen[bytes]
    log: Path

    @property
    def api(self) -> str:
        """Where REST begins."""
        return f"{self.url}/api/v1"

    def figure(self, name: str) -> float:
        """One of the figures at /metrics, labels included as they stand there."""
        for line in httpx.get(f"{self.url}/metrics", timeout=60).text.splitlines():
            if line.startswith(f"stairwright_{name} "):
                return float(line.split()[1])
        raise KeyError(name)

    def processes(self, without: str = "") -> list[int]:
        """The server and everything below it, but for commands that name `without` and theirs."""
        parents = {}
        for entry in Path("/proc").iterdir():
            with contextlib.suppress(OSError, ValueError):
                if without and without in (entry / "cmdline").read_text():
                    continue
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
                parents[int(entry.name)] = int(fields[1])
        found = {self.process.pid}
        for _ in range(4):
            found |= {pid for pid, parent in parents.items() if parent in found}
        return sorted(found)

    def memory(self) -> float:
        """Memory of all processes [MiB]; what they share counts once (PSS)."""
        total = 0
        for pid in self.processes():
            with contextlib.suppress(OSError):
                for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
                    if line.startswith("Pss:"):
                        total += int(line.split()[1])
        return total / 1024

    def ticks(self) -> dict[int, int]:
        """Processor time of every process below the server [clock ticks]."""
        spent = {}
        for pid in self.processes():
            with contextlib.suppress(OSError):
                fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
                spent[pid] = int(fields[11]) + int(fields[12])
        return spent

    def busiest(self) -> int:
        """The worker that has used most processor time in the last 0.2 s."""
        before = self.ticks()
        time.sleep(0.2)
        after = self.ticks()
        below = [pid for pid in after if pid != self.process.pid]
        return max(below, key=lambda pid: after[pid] - before.get(pid, 0))


def command(port: int) -> list[str]:
    """How a server is started."""
    return [sys.executable, "-m", "stairwright", "serve", "--port", str(port)]


def free_port() -> int:
    """A port that nobody uses."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextlib.contextmanager
def serve(data: Path | None = None, **variables: str) -> Iterator[Service]:
    """A server with a data folder of its own, or with `data`; variables without STAIRWRIGHT_."""
    with tempfile.TemporaryDirectory(prefix="stairwright-bench-") as folder:
        port = free_port()
        named = {f"STAIRWRIGHT_{name.upper()}": value for name, value in variables.items()}
        env = os.environ | {"STAIRWRIGHT_DATA": str(data or Path(folder) / "data")} | named
        log = Path(folder) / "log"
        with log.open("wb") as output:
            process = subprocess.Popen(
                command(port), env=env, stderr=output, start_new_session=True
            )
        service = Service(f"http://127.0.0.1:{port}", process, log)
        try:
            wait_until_ready(service)
            yield service
        finally:
            process.terminate()
            try:
                process.wait(15)
            finally:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)


def wait_until_ready(service: Service) -> None:
    """Until plans are answered at once."""
    give_up = time.monotonic() + START_LIMIT
    while time.monotonic() < give_up:
        with contextlib.suppress(httpx.TransportError):
            if httpx.get(f"{service.api}/healthz", timeout=5).is_success:
                return
        if service.process.poll() is not None:
            break
        time.sleep(0.02)
    raise RuntimeError(f"the server did not start:\n{service.log.read_text()[-3000:]}")


def wait_for(api: httpx.Client, job: str, *states: str, limit: float = 300.0) -> dict[str, Any]:
    """A job's document once it is in one of `states`."""
    give_up = time.monotonic() + limit
    while time.monotonic() < give_up:
        document: dict[str, Any] = api.get(f"/jobs/{job}").json()
        if document["state"] in states:
            return document
        time.sleep(0.005)
    raise TimeoutError(f"{job} is not {' or '.join(states)} after {limit:g} s")


def long_rollout(api: httpx.Client, seed: int) -> str:
    """A job that takes minutes: a slow drive over 40 m of level ground."""
    body = {"terrain": LONG, "method": "nominal", "seed": seed, "weights": {"speed": 0.02}}
    answer = api.post("/rollouts", json=body)
    answer.raise_for_status()
    return str(answer.json()["id"])
