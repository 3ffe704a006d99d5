"""Studies of a service while its database is slow or fails; no process carries them out."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

import pytest

from stairwright.storage.store import Store
from stairwright.studies.document import Study
from stairwright.studies.following import Following
from stairwright.studies.process import RunnerProcess
from stairwright.studies.service import Studies

from .small import STEP


class Runner:
    """Does each study in no time."""

    def __init__(self) -> None:
        self._orders: asyncio.Queue[str] = asyncio.Queue()

    async def order(self, what: dict[str, Any]) -> None:
        if "run" in what:
            self._orders.put_nowait(what["run"])

    async def reports(self) -> AsyncIterator[dict[str, Any]]:
        while True:
            yield {"id": await self._orders.get(), "state": "done", "error": None}

    async def end(self) -> None: ...


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Store:
    async def start(workers: int, scheduler: str) -> Runner:
        return Runner()

    monkeypatch.setattr(RunnerProcess, "start", start)
    return Store(tmp_path)


async def until(true: Callable[[], bool]) -> None:
    async with asyncio.timeout(10):
        while not true():
            await asyncio.sleep(0.005)


async def submitted(studies: Studies, name: str = "a") -> Following:
    return await studies.submit(Study.model_validate(STEP | {"name": name}), "someone")


def test_what_is_removed_while_its_end_is_written_down_stays_removed(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    put = store.studies.put

    def slow(record: Any) -> None:
        time.sleep(0.3 if record.state == "done" else 0.0)
        put(record)

    monkeypatch.setattr(store.studies, "put", slow)

    async def removed() -> str:
        studies = Studies(store, 1, "", 10)
        study = await submitted(studies)
        await until(lambda: study.job.finished)
        await studies.delete(study)
        await studies.stop()
        return study.record.id

    assert store.studies.get(asyncio.run(removed())) is None


def test_where_an_end_cannot_be_written_down_the_next_one_has_its_turn(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    put = store.studies.put

    def full(record: Any) -> None:
        if record.state == "done" and record.name == "a":
            raise OSError(28, "No space left on device")
        put(record)

    monkeypatch.setattr(store.studies, "put", full)

    async def both() -> None:
        studies = Studies(store, 1, "", 10)
        first, second = [await submitted(studies, name) for name in ("a", "b")]
        await until(lambda: second.job.state == "done")
        await studies.delete(first)
        assert store.studies.get(first.record.id) is None
        await studies.stop()

    asyncio.run(both())
