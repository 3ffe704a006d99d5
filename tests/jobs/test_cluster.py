"""Rollouts and trials of the service on a Dask cluster: as if they were made here."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from pathlib import Path
from typing import Any

import dask
import httpx
import orjson
import pytest
from distributed import Client, LocalCluster

import stairwright as sw
from stairwright.errors import Cancelled, InputError
from stairwright.jobs.cluster import simulators, tasks
from stairwright.jobs.cluster.simulators import DaskSimulators
from stairwright.jobs.cluster.worker import OtherVersion
from stairwright.jobs.failures import GivenUp, Unreachable, WorkerDied
from stairwright.jobs.questions import (
    MarginsQuestion,
    PlanQuestion,
    RolloutQuestion,
    TrialsQuestion,
)
from stairwright.jobs.run import Run
from stairwright.simulation import robust_margins
from stairwright.simulation.rollout import rollout
from stairwright.storage.artefacts import Artefacts
from stairwright.studies.local_cluster import QUIET
from tests.conftest import Server, free_port

pytestmark = pytest.mark.slow  # a cluster of processes takes seconds to start

CURB = {"name": "curb", "points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
WALL = {"name": "wall", "points": [[-1.0, 0], [0, 0], [0, 1.3], [1, 1.3]]}


@pytest.fixture(scope="module")
def dask_cluster() -> Iterator[LocalCluster]:
    """Two workers in processes of their own, behind a scheduler on the loopback."""
    settings = QUIET | {"distributed.scheduler.allowed-failures": 0}
    with (
        dask.config.set(settings),
        LocalCluster(
            n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None,
            silence_logs=50,
        ) as cluster,
    ):  # fmt: skip
        yield cluster


def _in_process(port: int) -> LocalCluster:
    """One worker that is a thread of this process. No task is given up where a worker goes."""
    with dask.config.set({"distributed.scheduler.allowed-failures": 3}):
        return LocalCluster(
            n_workers=1, processes=False, threads_per_worker=1, host="127.0.0.1",
            scheduler_port=port, dashboard_address=None, silence_logs=50,
        )  # fmt: skip


def tell(address: str, folder: Path, story: Callable[[DaskSimulators], Awaitable[None]]) -> None:
    async def run() -> None:
        async with _connected(address, folder) as found:
            await story(found)

    asyncio.run(run())


@contextlib.asynccontextmanager
async def _connected(address: str, folder: Path) -> AsyncIterator[DaskSimulators]:
    found = DaskSimulators(address, Artefacts(folder), deadline=60.0)
    await found.start()
    try:
        await found.ready()
        yield found
    finally:
        await found.stop()


def _ask(terrain: dict[str, Any]) -> PlanQuestion:
    return PlanQuestion.of(sw.load_terrain(terrain), sw.load_robot("a1_wheeled"), 0.6, "path", {})


def test_documents_are_those_of_this_process(dask_cluster: LocalCluster, tmp_path: Path) -> None:
    plan = sw.plan(CURB)
    kept = Artefacts(tmp_path)
    digest = kept.put(plan.model_dump_json().encode())
    ranges = {"friction": [-0.05, 0.05]}

    async def story(found: DaskSimulators) -> None:
        assert found.workers == 2
        one = Run(RolloutQuestion(_ask(CURB), 0.6, {}, 3), "me")
        many = Run(TrialsQuestion(digest, 0.6, {}, 5, count=2, ranges=ranges), "me")
        product, several = await asyncio.gather(found.carry_out(one), found.carry_out(many))
        made = sw.Rollout.model_validate(orjson.loads(kept.content(product.digest)))
        expected_run = rollout(plan, 0.6, seed=3)
        assert made.id == product.id == expected_run.id
        assert made.series.model_dump_json() == expected_run.series.model_dump_json()
        assert product.plan is not None
        made_plan = sw.Plan.model_validate_json(kept.content(product.plan.digest))
        assert made_plan == plan.model_copy(update={"solve_time": made_plan.solve_time})
        expected = sw.trials(plan, 2, seed=5, ranges=ranges)
        assert kept.content(several.digest) == expected.model_dump_json().encode()
        assert product.summary["outcome"] == "success"
        assert several.summary["successes"] == expected.successes
        # The last news may come after the outcome, when nobody listens any more.
        assert one.gauge.progress >= 0.1
        assert many.gauge.progress > 0.1
        chunks, _ = one.live.after(0)
        assert orjson.loads(chunks[0])["from"] == 0

    tell(dask_cluster.scheduler_address, tmp_path, story)


def test_margins_are_found_there_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With fewer values to try than there are, which workers of this process share."""
    monkeypatch.setattr(robust_margins, "DELAYS", (0.004, 0.03))
    monkeypatch.setattr(robust_margins, "FRICTIONS", (0.1,))
    plan = sw.plan(CURB)
    kept = Artefacts(tmp_path)
    digest = kept.put(plan.model_dump_json().encode())

    async def story(found: DaskSimulators) -> None:
        run = Run(MarginsQuestion(digest, None, {}, 3), "me")
        product = await found.carry_out(run)
        expected = sw.robust_margins(plan, seed=3)
        assert product.id == expected.id
        assert sw.RobustMargins.model_validate_json(kept.content(product.digest)) == expected

    with _in_process(free_port()) as cluster:
        tell(cluster.scheduler_address, tmp_path, story)


def test_who_cancels_stops_the_workers(dask_cluster: LocalCluster, tmp_path: Path) -> None:
    async def story(found: DaskSimulators) -> None:
        run = Run(TrialsQuestion(_ask(CURB), 0.6, {}, 5, count=1000), "me")
        work = asyncio.create_task(found.carry_out(run))
        async with asyncio.timeout(240):
            while run.gauge.progress < 0.1005:  # parts are at work
                await asyncio.sleep(0.05)
            work.cancel()
            with pytest.raises(asyncio.CancelledError):
                await work
            with Client(dask_cluster, set_as_default=False) as client:
                while any((await asyncio.to_thread(client.run, _at_work)).values()):
                    await asyncio.sleep(0.05)

    tell(dask_cluster.scheduler_address, tmp_path, story)


def test_trials_stop_while_one_is_at_work(monkeypatch: pytest.MonkeyPatch) -> None:
    shares: list[float] = []

    class Unwanted:
        def __init__(self, order: tasks.Order) -> None: ...

        def progress(self, share: float) -> None:
            shares.append(share)
            raise Cancelled("nobody waits")

    monkeypatch.setattr(tasks, "News", Unwanted)
    question = {"count": 2, "seed": 0, "ranges": {}, "friction": 0.6, "controller": {}}
    order = tasks.Order("run", "topic", "key", tasks.rollout_engine(), deadline=60.0)
    with pytest.raises(Cancelled):
        tasks.try_part(sw.plan(CURB).model_dump_json().encode(), question, 0, 2, order)
    assert len(shares) == 1
    assert shares[0] < 0.4  # not after the first of the two


def _at_work(dask_worker: Any) -> bool:
    return bool(dask_worker.state.executing_count or dask_worker.state.tasks)


def test_refusals_come_back(
    dask_cluster: LocalCluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def story(found: DaskSimulators) -> None:
        with pytest.raises(InputError, match="nothing can be rolled out"):
            await found.carry_out(Run(RolloutQuestion(_ask(WALL), 0.6, {}, 0), "me"))
        with pytest.raises(InputError, match="not stored"):
            await found.carry_out(Run(RolloutQuestion("0" * 64, 0.6, {}, 0), "me"))
        monkeypatch.setattr(simulators, "rollout_engine", lambda: "0000")
        with pytest.raises(OtherVersion, match="another version"):
            await found.carry_out(Run(RolloutQuestion(_ask(CURB), 0.6, {}, 0), "me"))

    tell(dask_cluster.scheduler_address, tmp_path, story)


def test_a_rollout_that_kills_workers_is_given_up(
    dask_cluster: LocalCluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tasks, "roll_out", _deadly)

    async def story(found: DaskSimulators) -> None:
        with pytest.raises(GivenUp, match="workers of the cluster have died"):
            await found.carry_out(Run(RolloutQuestion(_ask(CURB), 0.6, {}, 0), "me"))

    tell(dask_cluster.scheduler_address, tmp_path, story)


def _deadly(*_: object) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def test_a_scheduler_that_is_not_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simulators, "PATIENCE", 0.5)
    with pytest.raises(Unreachable, match=r"tcp://127\.0\.0\.1:9: .*refused"):
        tell("tcp://127.0.0.1:9", tmp_path, _nothing)


async def _nothing(_: DaskSimulators) -> None:
    pytest.fail("there is nobody")


def test_a_scheduler_that_goes_away(tmp_path: Path) -> None:
    """Who was waiting may ask again; the next scheduler at the address is used."""
    port = free_port()

    async def story(found: DaskSimulators) -> None:
        run = Run(TrialsQuestion(_ask(CURB), 0.6, {}, 5, count=500), "me")
        work = asyncio.create_task(found.carry_out(run))
        async with asyncio.timeout(240):
            while run.gauge.progress < 0.1005:
                await asyncio.sleep(0.05)
            await asyncio.to_thread(first.close)
            with pytest.raises(WorkerDied):
                await work
            with await asyncio.to_thread(_in_process, port):
                await found.ready()
                product = await found.carry_out(Run(RolloutQuestion(_ask(CURB), 0.6, {}, 0), "me"))
        assert product.summary["outcome"] == "success"

    first = _in_process(port)
    tell(first.scheduler_address, tmp_path, story)


class _Leaving:
    """A client whose scheduler is gone; while it closes it swallows who cancels it, as Dask's."""

    status = "closed"

    def __init__(self) -> None:
        self.closing = asyncio.Event()

    async def close(self, timeout: float) -> None:
        self.closing.set()
        with contextlib.suppress(asyncio.CancelledError):
            await asyncio.sleep(timeout)


def test_who_leaves_while_the_scheduler_goes_away(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def story() -> None:
        client = _Leaving()

        async def connect(_: DaskSimulators) -> _Leaving:
            return client

        monkeypatch.setattr(DaskSimulators, "_connect", connect)
        found = DaskSimulators("tcp://127.0.0.1:9", Artefacts(tmp_path), deadline=60.0)
        await found.start()
        await client.closing.wait()
        async with asyncio.timeout(20):
            await found.stop()

    asyncio.run(story())


def test_the_service_uses_the_cluster(
    dask_cluster: LocalCluster,
    start_server: Callable[..., contextlib.AbstractContextManager[Server]],
) -> None:
    address = dask_cluster.scheduler_address
    told: list[float] = []
    with start_server(STAIRWRIGHT_SCHEDULER=address) as server, sw.Client(server.url) as service:
        plan = service.plan(CURB)
        found = service.trials(plan.id, 2, "laboratory", seed=3, progress=told.append)
        figures = httpx.get(f"{server.url}/metrics").text
    assert found == sw.trials(plan, 2, bundle="laboratory", seed=3)
    assert told[-1] == 1.0
    assert "stairwright_simulators 2.0" in figures
    assert 'worker_deaths_total{pool="rollouts"}' not in figures  # no processes of its own
