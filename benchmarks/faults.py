"""What happens when things break: workers and the server killed, the disk full, clients gone.

    python benchmarks/faults.py [--kills 100] [--quick] [--json FILE]

Prints how long a cancelled worker stays busy, how soon the death of a worker is answered, and what
is answered while the database is locked or the disk is full, and what of that which was
acknowledged is missing after the server was killed with SIGKILL in the middle of writing.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import os
import resource
import signal
import sqlite3
import statistics
import tempfile
import time
from pathlib import Path

import httpx
import viser
from report import Row, percentile, publish
from service import STAIR, Service, long_rollout, serve, wait_for
from websockets import Subprotocol
from websockets.sync.client import connect

HEAVY = {
    "points": [[-1.0, 0.0]]
    + [[0.3 * (k // 2), 0.15 * ((k + 1) // 2)] for k in range(400)]
    + [[62.0, 30.0]]
}  # seconds of planning: 200 steps


def rests(pid: int) -> bool:
    """Whether a process waits for something to do, or is gone."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] in "SZ"
    except OSError:
        return True


def until(condition, limit: float = 60.0) -> float:  # type: ignore[no-untyped-def]
    """Seconds until the condition holds."""
    begun = time.perf_counter()
    while not condition():
        if time.perf_counter() - begun > limit:
            raise TimeoutError("it does not come about")
        time.sleep(0.002)
    return time.perf_counter() - begun


def cancelling(service: Service, api: httpx.Client, repeat: int) -> Row:
    """From DELETE of a running rollout until its worker rests or is gone."""
    spent = []
    for k in range(repeat):
        job = long_rollout(api, 1000 + k)
        wait_for(api, job, "running")
        until(lambda job=job: api.get(f"/jobs/{job}").json()["progress"] > 0.1)
        worker = service.busiest()
        begun = time.perf_counter()
        api.delete(f"/jobs/{job}").raise_for_status()
        until(lambda worker=worker: rests(worker))
        spent.append(1e3 * (time.perf_counter() - begun))
    return Row("cancel a running rollout", "stairwright", statistics.median(spent),
               percentile(spent, 0.95), note="until its worker is free")  # fmt: skip


def giving_up(service: Service, repeat: int) -> Row:
    """From a client's leaving in mid-solve until no solve is under way."""
    spent = []
    for k in range(repeat):
        body = {"terrain": HEAVY, "friction": 0.9 + 1e-4 * k}
        try:
            httpx.post(f"{service.api}/plans", json=body, timeout=0.6)
        except httpx.ReadTimeout:
            spent.append(1e3 * until(lambda: service.figure("plans_running") == 0))
    return Row("a client leaves in mid-solve", "stairwright", statistics.median(spent),
               percentile(spent, 0.95), note="until its solve has ended")  # fmt: skip


def deaths(service: Service, api: httpx.Client, repeat: int) -> list[Row]:
    """From SIGKILL of a worker until the answer says so."""
    rollouts, plans = [], []
    for k in range(repeat):
        job = long_rollout(api, 3000 + k)
        wait_for(api, job, "running")
        until(lambda job=job: api.get(f"/jobs/{job}").json()["progress"] > 0.1)
        worker = service.busiest()
        begun = time.perf_counter()
        os.kill(worker, signal.SIGKILL)
        until(lambda job=job: api.get(f"/jobs/{job}").json()["progress"] < 0.1)  # it begins anew
        rollouts.append(1e3 * (time.perf_counter() - begun))
        wait_for(api, job, "running")
        api.delete(f"/jobs/{job}")
    with concurrent.futures.ThreadPoolExecutor(1) as other:
        for k in range(repeat):
            body = {"terrain": HEAVY, "friction": 0.8 + 1e-4 * k}
            asked = other.submit(httpx.post, f"{service.api}/plans", json=body, timeout=60)
            time.sleep(0.5)
            worker = service.busiest()
            begun = time.perf_counter()
            os.kill(worker, signal.SIGKILL)
            answer = asked.result()
            plans.append(1e3 * (time.perf_counter() - begun))
            assert answer.status_code == 503, answer.text
            assert answer.json()["type"].endswith("worker-died"), answer.text
    return [
        Row(f"worker killed in mid-{what}", "stairwright", statistics.median(spent),
            percentile(spent, 0.95), note=note)
        for what, spent, note in (
            ("rollout", rollouts, "until the job says that it begins anew"),
            ("solve", plans, "until the failure is answered"),
        )
    ]  # fmt: skip


def write_until_killed(service: Service, round_: int, moment: float) -> dict[str, object]:
    """Save things until the server dies; what was acknowledged, by path."""
    kept: dict[str, object] = {}
    with (
        httpx.Client(base_url=service.api, timeout=30) as api,
        concurrent.futures.ThreadPoolExecutor(1) as killer,
    ):
        killer.submit(lambda: (time.sleep(moment), os.kill(service.process.pid, signal.SIGKILL)))
        for k in range(10_000):
            try:
                name = f"t{round_}-{k}"
                points = [[-1.0, 0.0], [1.0 + 1e-3 * k, 0.0]]
                put = api.put(f"/terrains/{name}", json={"points": points})
                if put.is_success:
                    kept[f"/terrains/{name}"] = points
                body = {"terrain": {"points": points}, "method": "nominal",
                        "friction": 0.5 + 1e-3 * round_}  # fmt: skip
                plan = api.post("/plans", json=body)
                if plan.is_success:
                    kept[f"/plans/{plan.json()['id']}"] = plan.json()
            except httpx.TransportError:
                break
    service.process.wait()
    return kept


def killing(kills: int) -> Row:
    """Kill the server with SIGKILL at odd moments while it writes; start it on the same data."""
    kept: dict[str, object] = {}
    missing, wrong, restarts = 0, 0, []
    with tempfile.TemporaryDirectory(prefix="stairwright-kill-") as folder:
        data = Path(folder) / "data"
        for round_ in range(kills):
            begun = time.perf_counter()
            with serve(data) as service:
                restarts.append(1e3 * (time.perf_counter() - begun))
                kept |= write_until_killed(service, round_, 0.2 + 0.0137 * (round_ % 60))
        with serve(data) as service, httpx.Client(base_url=service.api, timeout=30) as api:
            for path, document in kept.items():
                found = api.get(path)
                if not found.is_success:
                    missing += 1
                elif (found.json()["points"] if "terrains" in path else found.json()) != document:
                    wrong += 1
        with sqlite3.connect(data / "stairwright.sqlite") as database:
            (sound,) = database.execute("PRAGMA integrity_check").fetchone()
    return Row(f"server killed -9 while writing, {kills} times: restart", "stairwright",
               statistics.median(restarts), percentile(restarts, 0.95),
               solved=f"{len(kept) - missing - wrong} of {len(kept)} kept",
               note=f"database {sound}")  # fmt: skip


def locked_database() -> Row:
    """Somebody else holds the database's write lock: told so, and all is well afterwards."""
    with tempfile.TemporaryDirectory(prefix="stairwright-lock-") as folder:
        data = Path(folder) / "data"
        with serve(data) as service, httpx.Client(base_url=service.api, timeout=60) as api:
            other = sqlite3.connect(data / "stairwright.sqlite", isolation_level=None)
            other.execute("BEGIN IMMEDIATE")
            begun = time.perf_counter()
            refused = api.put("/terrains/x", json=STAIR)
            spent = 1e3 * (time.perf_counter() - begun)
            readable = api.get("/terrains").is_success
            other.execute("ROLLBACK")
            other.close()
            again = api.put("/terrains/x", json=STAIR)
    told = f"{refused.status_code}, then {again.status_code}; reading works: {readable}"
    return Row("database locked by another program", "stairwright", spent, note=told)


def full_disk() -> Row:
    """No byte more can be written (a limit on the size of files): told so, nothing breaks."""
    with serve() as service, httpx.Client(base_url=service.api, timeout=60) as api:
        saved = api.put("/terrains/before", json=STAIR).status_code
        for pid in service.processes():
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
        begun = time.perf_counter()
        codes = [api.put(f"/terrains/x{k}", json=STAIR).status_code for k in range(3)]
        codes.append(api.post("/plans", json={"terrain": STAIR, "friction": 0.61}).status_code)
        spent = 1e3 * (time.perf_counter() - begun) / len(codes)
        for pid in service.processes():
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY,) * 2)
        again = api.put("/terrains/x", json=STAIR).status_code
        kept = api.get("/terrains/before").is_success
    told = f"{saved}, full: {codes}, then {again}; kept: {kept}"
    return Row("disk full", "stairwright", spent, note=told)


def slow_viewer(seconds: float) -> Row:
    """A viewer that connects and reads nothing while the scene plays: memory, and other people."""
    with serve() as service, httpx.Client(base_url=service.api, timeout=60) as api:
        plan = api.post("/plans", json={"terrain": "single-stair-036", "method": "critical"}).json()
        session = api.post("/sessions").json()
        api.put(f"/sessions/{session['id']}/scene", json={"plan_id": plan["id"]})
        address = service.url.replace("http", "ws") + session["scene"]
        protocol = Subprotocol(f"viser-v{viser.__version__}")
        with connect(
            address,
            subprotocols=[protocol],
            max_queue=1,
            max_size=None,
            close_timeout=1,
            ping_interval=None,
        ):
            times, memory = [], []
            begun = time.perf_counter()
            while time.perf_counter() - begun < seconds:
                api.put(f"/sessions/{session['id']}/playback", json={"time": 0.0, "playing": True})
                asked = time.perf_counter()
                api.get("/terrains").raise_for_status()
                times.append(1e3 * (time.perf_counter() - asked))
                memory.append(service.memory())
                time.sleep(0.5)
    note = f"another's requests meanwhile; memory {memory[2]:.0f} MiB, then {memory[-1]:.0f} MiB"
    return Row(f"a viewer reads nothing for {seconds:g} s", "stairwright",
               statistics.median(times), percentile(times, 0.95), note=note)  # fmt: skip


def run(quick: bool = False, kills: int | None = None) -> list[Row]:
    """All rows."""
    repeat = 3 if quick else 20
    with (
        serve(rollout_workers="1") as service,
        httpx.Client(base_url=service.api, timeout=120) as api,
    ):
        wait_for(api, api.post("/rollouts", json={"terrain": STAIR}).json()["id"], "done")
        rows = [cancelling(service, api, repeat), giving_up(service, repeat)]
        rows += deaths(service, api, repeat)
    rows += [locked_database(), full_disk(), slow_viewer(5.0 if quick else 60.0)]
    return [*rows, killing(kills or (3 if quick else 100))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, help="of the server (100)")
    parser.add_argument("--quick", action="store_true", help="few of everything")
    parser.add_argument("--json")
    given = parser.parse_args()
    publish(run(given.quick, given.kills), given.json)


if __name__ == "__main__":
    main()
