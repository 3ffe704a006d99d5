"""`kill -9` at random moments of a study: of a worker, the scheduler, the client, the server.

    python benchmarks/kills.py [--times 20] [--seed 0] [worker scheduler client server]

A round counts where the study ends by itself, or the same command goes on with it; where nothing
that was stored when the victim died is lost; and where all values are those of a study in one
process.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import psutil

import stairwright as sw
from stairwright.studies.store import ResultStore

STUDY: dict[str, Any] = {
    "schema": "stairwright/study/1",
    "robot": "a1_wheeled",
    "axes": [
        {"name": "step.height", "from": 0.03, "to": 0.4, "count": 50},
        {"name": "friction", "values": [0.4, 0.5, 0.6, 0.7]},
    ],
}
PATIENCE = 300.0  # s for a study to end


def known(path: Path) -> int:
    """Cells that are stored."""
    return int((ResultStore(path).states != 0).sum()) if path.exists() else 0


def same(path: Path, truth: Path) -> bool:
    """Whether two stores hold the same states and values."""
    a, b = ResultStore(path), ResultStore(truth)
    cells = list(range(a.states.size))
    return bool(np.array_equal(a.states, b.states)) and repr(a.records(cells)) == repr(
        b.records(cells)
    )


def part(root: int, which: str) -> int | None:
    """The process below `root` that plays a part; None where there is none yet."""
    try:
        below = psutil.Process(root).children(recursive=True)
        clusters = [p for p in below if "stairwright.studies.local_cluster" in p.cmdline()]
        if which == "scheduler":
            return clusters[0].pid if clusters else None
        workers = [
            p.pid
            for each in clusters
            for p in each.children(recursive=True)
            if any("spawn_main" in word for word in p.cmdline())
        ]
        return random.choice(workers) if workers else None
    except psutil.NoSuchProcess:
        return None


def strike(process: subprocess.Popen[bytes], whom: str, path: Path, at: int) -> int:
    """Kill once `at` cells are stored; the number that is stored then, or -1 if it was too late."""
    while process.poll() is None:
        stored = known(path)
        if stored >= at:
            victim = process.pid if whom in ("client", "server") else part(process.pid, whom)
            if victim is not None:
                os.kill(victim, signal.SIGKILL)
                return stored
        time.sleep(0.05)
    return -1


def by_command(whom: str, folder: Path, truth: Path, at: int) -> str:
    """A round with `stairwright study`."""
    document, path = folder / "study.json", folder / "out.zarr"
    document.write_text(json.dumps(STUDY))
    command = [sys.executable, "-m", "stairwright", "study", str(document), "-o", str(path)]
    command += ["--workers", "2"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    stored = strike(process, whom, path, at)
    if stored < 0:
        return "too late"
    code = process.wait(PATIENCE)
    left = known(path)
    if left < stored:
        return f"LOST {stored - left} of {stored} stored cells"
    if whom == "client":
        code = subprocess.run(command, stdout=subprocess.DEVNULL, timeout=PATIENCE).returncode
    if code != 0:
        return f"ENDED with {code}"
    return f"ok, {stored} cells stored" if same(path, truth) else "OTHER DATASET"


@contextmanager
def served(data: Path, port: int) -> Iterator[subprocess.Popen[bytes]]:
    """A server on `data`, until the end of the block."""
    env = os.environ | {"STAIRWRIGHT_DATA": str(data), "STAIRWRIGHT_STUDY_WORKERS": "2"}
    command = [sys.executable, "-m", "stairwright", "serve", "--port", str(port)]
    process = subprocess.Popen(
        command, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        yield process
    finally:
        process.terminate()
        process.wait(30)


def asked(port: int, method: str, link: str, **options: Any) -> Any:
    """What the server answers, once it does."""
    end = time.monotonic() + PATIENCE
    while True:
        try:
            answer = httpx.request(
                method, f"http://127.0.0.1:{port}/api/v1{link}", timeout=60, **options
            )
            return answer.raise_for_status().json()
        except httpx.TransportError:
            if time.monotonic() > end:
                raise
            time.sleep(0.2)


def by_server(folder: Path, truth: Path, at: int) -> str:
    """A round with a server that is killed and started again."""
    data = folder / "data"
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with served(data, port) as process:
        name = asked(port, "POST", "/studies", json=STUDY)["id"]
        path = next(iter(data.rglob(f"{name}*.zarr")), data / "studies" / f"{name}.zarr")
        stored = strike(process, "server", path, at)
    if stored < 0:
        return "too late"
    with served(data, port):
        end = time.monotonic() + PATIENCE
        while (state := asked(port, "GET", f"/studies/{name}"))["state"] != "done":
            if time.monotonic() > end or state["state"] in ("failed", "cancelled"):
                return f"ENDED as {state['state']}"
            time.sleep(0.2)
        if known(path) < stored:
            return f"LOST {stored - known(path)} of {stored} stored cells"
    return f"ok, {stored} cells stored" if same(path, truth) else "OTHER DATASET"


def main() -> None:
    """Kill, and tell what came of it."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("whom", nargs="*", help="worker, scheduler, client, server")
    given = parser.parse_args()
    random.seed(given.seed)
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        truth = Path(name) / "truth.zarr"
        sw.study(STUDY, workers=1, store=truth)
        cells = known(truth)
        for whom in given.whom or ["worker", "scheduler", "client", "server"]:
            for k in range(given.times):
                at = random.randrange(1, round(0.8 * cells))
                with tempfile.TemporaryDirectory() as place:
                    folder = Path(place)
                    told = (
                        by_server(folder, truth, at)
                        if whom == "server"
                        else by_command(whom, folder, truth, at)
                    )
                bad += not told.startswith(("ok", "too late"))
                print(f"{whom} {k + 1}: {told}", flush=True)
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
