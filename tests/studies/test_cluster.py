"""Dask: the same datasets in every bit, whoever computes them, and an end whoever dies."""

from __future__ import annotations

import json
import os
import random
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from distributed import Future

import stairwright as sw
from stairwright.errors import InputError
from stairwright.jobs.cluster.worker import OtherVersion
from stairwright.studies import worker
from stairwright.studies.batches import FIRST, LONGEST, MOST, TARGET, BatchSizes
from stairwright.studies.cluster import ClusterEngine
from stairwright.studies.dataset import grid_dataset
from stairwright.studies.fill import fill_grid
from stairwright.studies.keys import dask_settings, write_keys
from stairwright.studies.progress import Progress
from stairwright.studies.serial import SerialEngine
from stairwright.studies.store import ResultStore
from stairwright.studies.study import prepared
from stairwright.studies.version import engine_of
from stairwright.studies.worker import evaluate_batch
from tests.conftest import free_port

from .small import STEP, identical, study


def _map(*friction: float) -> dict[str, object]:
    return study(
        {"name": "stairs.rise", "values": [0.1, 0.2, 0.7]},
        {"name": "stairs.run", "values": [0.25, 0.32]},
        {"name": "friction", "values": friction},
        terrain={"kind": "stair", "rise": 0.1, "run": 0.3, "count": 1},  # soon refused
    )


MAP = _map(0.3, 0.7)
QUICK = study({"name": "step.height", "values": [0.05]})
DEADLY = _map(0.31)  # no cell that another test may have asked


def _store(document: dict[str, object], path: Path) -> ResultStore:
    made = prepared(document)
    return ResultStore.create(path, made, engine_of(made))


@pytest.fixture(scope="module")
def serial(tmp_path_factory: pytest.TempPathFactory) -> ResultStore:
    store = _store(MAP, tmp_path_factory.mktemp("serial") / "s.zarr")
    fill_grid(store, SerialEngine(), None, lambda: False)
    return store


@pytest.mark.slow
def test_a_cluster_gives_the_same_dataset_bit_by_bit(
    serial: ResultStore, cluster: ClusterEngine, tmp_path: Path
) -> None:
    store = _store(MAP, tmp_path / "c.zarr")
    seen: list[int] = []
    fill_grid(store, cluster, lambda progress: seen.append(progress.done), lambda: False)
    assert identical(grid_dataset(serial), grid_dataset(store))
    assert seen == sorted(seen)
    assert seen[-1] == 12
    states = grid_dataset(store)
    assert 0 < int(states.feasible.sum()) < 12  # both kinds were compared


def test_workers_of_another_version_are_refused() -> None:
    document = prepared(STEP).model_dump_json().encode()
    with pytest.raises(OtherVersion, match="another version"):
        evaluate_batch(document, "0000", [0])


def test_a_scheduler_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot reach tcp://127\.0\.0\.1:9"):
        sw.study(STEP, scheduler="tcp://127.0.0.1:9", store=tmp_path / "n.zarr")


@pytest.mark.slow
def test_stopping_keeps_what_is_done(cluster: ClusterEngine, tmp_path: Path) -> None:
    store = _store(MAP, tmp_path / "c.zarr")
    seen: list[int] = []
    fill_grid(store, cluster, lambda p: seen.extend(p.new), lambda: len(seen) >= 4)
    done = store.counts()["done"]
    assert 4 <= done < 12
    asked: list[int] = []
    fill_grid(store, cluster, lambda p: asked.extend(p.new), lambda: False)
    assert len(asked) == 12 - done  # none twice
    assert store.counts()["done"] == 12


@pytest.mark.slow
def test_results_that_are_gone_are_asked_again(cluster: ClusterEngine, tmp_path: Path) -> None:
    """A worker may die with what it has done; the cluster is not started anew for that."""
    store, ready = _store(DEADLY, tmp_path / "g.zarr"), _store(QUICK, tmp_path / "r.zarr")
    fill_grid(ready, cluster, None, lambda: False)  # so that the cluster runs
    client, pid = cluster._client, cluster.scheduler_pid
    gone: set[str] = set()

    def lose_all_once(progress: Progress) -> None:
        keys = {key for key in client.futures if key.startswith("cells-")} - gone
        gone.update(keys)
        client.cancel([Future(key, client) for key in keys])

    fill_grid(store, cluster, lose_all_once, lambda: False)
    assert gone
    assert store.counts()["done"] == 6
    assert cluster.scheduler_pid == pid


def _children(pid: int) -> list[int]:
    import psutil

    return [child.pid for child in psutil.Process(pid).children(recursive=True)]


@pytest.mark.slow
@pytest.mark.parametrize("whom", ["worker", "scheduler"])
def test_whoever_dies_the_study_ends_by_itself(
    whom: str, truth: ResultStore, cluster: ClusterEngine, tmp_path: Path
) -> None:
    store = ResultStore.create(tmp_path / "k.zarr", truth.study, truth.engine)
    ready = _store(QUICK, tmp_path / "r.zarr")
    fill_grid(ready, cluster, None, lambda: False)  # so that the cluster runs
    killed = threading.Event()

    def kill(progress: Any) -> None:
        pid = cluster.scheduler_pid
        if not killed.is_set() and progress.done > 40 and pid is not None:
            workers = [each for each in _children(pid) if _is_worker(each)]
            if whom == "worker" and not workers:
                return
            os.kill(pid if whom == "scheduler" else random.choice(workers), signal.SIGKILL)
            killed.set()

    fill_grid(store, cluster, kill, lambda: False)
    assert killed.is_set()
    assert identical(grid_dataset(truth), grid_dataset(store))


def _is_worker(pid: int) -> bool:
    import psutil

    return any("spawn_main" in part for part in psutil.Process(pid).cmdline())


def test_a_client_that_cannot_be_closed_is_not_closed_again() -> None:
    """Dask's does it in its destructor, where what goes wrong is printed."""

    class Client:
        status = "running"

        def close(self, timeout: float) -> None:
            raise ValueError("IOStream is not idle; cannot convert to SSL")

    engine, client = ClusterEngine(None, 1), Client()
    engine._client = client
    engine.close()
    assert client.status == "closed"


@pytest.mark.slow
def test_a_cell_that_kills_its_worker_is_found_and_recorded(
    cluster: ClusterEngine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A worker dies at one cell: that cell fails, with a reason, and all others are done."""
    monkeypatch.setattr("stairwright.studies.cluster.evaluate_batch", _deadly)
    store = _store(DEADLY, tmp_path / "d.zarr")
    ready = _store(QUICK, tmp_path / "r.zarr")
    fill_grid(ready, cluster, None, lambda: False)  # so that nothing is computed in this process
    fill_grid(store, cluster, None, lambda: False)
    assert store.counts() == {"pending": 0, "done": 5, "refused": 0, "failed": 1}
    record = store.records([3])[3]
    assert record["reason"] == "lost"
    assert "died" in record["message"]
    assert store.forget_failures() == 1
    assert store.counts()["pending"] == 1


def _deadly(document: bytes, engine: str, cells: list[int]) -> worker.Batch:
    if 3 in cells and b"stairs.rise" in document:
        os.kill(os.getpid(), signal.SIGKILL)
    return evaluate_batch(document, engine, cells)


@pytest.mark.slow
def test_a_cluster_of_ones_own_with_keys(
    serial: ResultStore, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Dask's own programs, as docs/scale.md starts them; whoever has no keys stays out."""
    write_keys(tmp_path)
    settings = dask_settings(tmp_path)
    port = str(free_port())
    address = f"tls://127.0.0.1:{port}"
    dask = [sys.executable, "-m", "dask"]
    listening = ["--protocol", "tls", "--host", "127.0.0.1", "--port", port, "--no-dashboard"]
    working = [address, "--nthreads", "1", "--nworkers", "1", "--no-dashboard"]
    options: dict[str, Any] = {"env": os.environ | settings, "stderr": subprocess.DEVNULL}
    commands = ([*dask, "scheduler", *listening], [*dask, "worker", *working])
    programs = [subprocess.Popen(each, **options) for each in commands]
    try:
        give_up = time.monotonic() + 60
        while _refused(int(port)) and time.monotonic() < give_up:
            time.sleep(0.2)
        with pytest.raises(InputError, match="cannot reach"):
            sw.study(MAP, scheduler=address, store=tmp_path / "n.zarr")
        code = (
            "import json, sys, stairwright as sw\n"
            "sw.study(json.loads(sys.argv[1]), scheduler=sys.argv[2], store=sys.argv[3])"
        )
        place = tmp_path / "k.zarr"
        command = [sys.executable, "-c", code, json.dumps(MAP), address, str(place)]
        subprocess.run(command, env=os.environ | settings, check=True, timeout=120)
        assert identical(grid_dataset(serial), grid_dataset(ResultStore(place)))
    finally:
        for program in reversed(programs):  # workers whose scheduler is gone wait for it
            program.terminate()
            try:
                program.wait(20)
            except subprocess.TimeoutExpired:
                program.kill()


def _refused(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) != 0


def test_batches_take_about_two_seconds() -> None:
    sizes = BatchSizes()
    assert sizes.next(1000, 2) == 1  # nothing is known yet
    sizes.learn(1, 0.05)
    assert sizes.next(10_000, 2) == round(FIRST / 0.05)
    sizes._begun -= 100
    assert sizes.next(10_000, 1) == round(TARGET / 0.05)
    assert sizes.next(10**6, 1000) == round(LONGEST / 0.05)
    assert sizes.next(20, 2) == 5  # all end together
    sizes.typical = 1e-9
    assert sizes.next(10**6, 2) == MOST
