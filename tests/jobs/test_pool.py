"""Real worker processes: deadlines, deaths, cancelling, limits."""

from __future__ import annotations

import asyncio
import json
import os
import platform
import signal
import time
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

from stairwright.errors import InputError
from stairwright.jobs import launch
from stairwright.jobs import pool as pools
from stairwright.jobs.failures import DeadlineExceeded, WorkerDied
from stairwright.jobs.memory import keep_no_more_than
from stairwright.jobs.pool import WorkerPool
from stairwright.jobs.uploads import import_terrain
from stairwright.jobs.worker import RESTLESS, Limits

Story = Callable[[WorkerPool], Awaitable[None]]


@pytest.fixture(autouse=True)
def _light_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    """These functions need no kernels: workers start at once."""
    monkeypatch.setattr(launch, "PRELOAD", "json")


def tell(story: Story, workers: int = 1, limits: Limits | None = None) -> None:
    async def run() -> None:
        pool = WorkerPool("test", workers, limits or Limits())
        await pool.start()
        try:
            await story(pool)
        finally:
            await pool.stop()

    asyncio.run(run())


def gone(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    return False


async def until(condition: Callable[[], bool]) -> None:
    give_up = time.monotonic() + 30
    while not condition():
        assert time.monotonic() < give_up
        await asyncio.sleep(0.02)


def test_results_and_exceptions_come_back() -> None:
    async def story(pool: WorkerPool) -> None:
        assert await pool.run(json.loads, "[1]", deadline=10) == [1]
        with pytest.raises(json.JSONDecodeError):
            await pool.run(json.loads, "[", deadline=10)
        with pytest.raises(InputError) as refused:
            await pool.run(import_terrain, b"", "a.xyz", {}, deadline=20)
        assert refused.value.field == ("file",)  # the path survives the way back

    tell(story)


def test_the_worker_that_was_at_work_last_is_asked_first() -> None:
    async def story(pool: WorkerPool) -> None:
        both = await asyncio.gather(*(pool.run(time.sleep, 0.3, deadline=10) for _ in range(2)))
        assert both == [None, None]  # two workers are there
        last = await pool.run(os.getpid, deadline=10)
        assert [await pool.run(os.getpid, deadline=10) for _ in range(5)] == [last] * 5

    tell(story, workers=2)


@pytest.mark.slow
def test_answers_longer_than_a_socket_holds_come_back_whole() -> None:
    async def story(pool: WorkerPool) -> None:
        content = os.urandom(20 * 2**20)
        assert await pool.run(bytes, content, deadline=20) == content

    tell(story)


def test_what_cannot_travel_is_told_all_the_same() -> None:
    async def story(pool: WorkerPool) -> None:
        with pytest.raises(TypeError, match="pickle"):
            await pool.run(open, os.devnull, deadline=10)
        with pytest.raises(TypeError) as failed:
            await pool.run(json.loads, 1, deadline=10)
        assert "json/__init__.py" in "".join(failed.value.__notes__)  # the log needs the place

    tell(story)


def test_a_deadline_kills_the_worker_and_the_next_task_runs() -> None:
    async def story(pool: WorkerPool) -> None:
        before = await pool.run(os.getpid, deadline=10)
        with pytest.raises(DeadlineExceeded):
            await pool.run(time.sleep, 600, deadline=0.3)
        await until(lambda: gone(before))
        assert await pool.run(os.getpid, deadline=10) != before

    tell(story)


def test_a_crash_is_told_and_the_worker_replaced() -> None:
    async def story(pool: WorkerPool) -> None:
        for _ in range(3):
            with pytest.raises(WorkerDied):
                await pool.run(os._exit, 9, deadline=10)
            assert await pool.run(json.loads, "1", deadline=10) == 1
        assert pool.deaths == 3

    tell(story)


def test_a_worker_killed_at_work() -> None:
    async def story(pool: WorkerPool) -> None:
        pid = await pool.run(os.getpid, deadline=10)
        task = asyncio.create_task(pool.run(time.sleep, 600, deadline=600))
        await asyncio.sleep(0.3)
        os.kill(pid, signal.SIGKILL)
        with pytest.raises(WorkerDied):
            await task

    tell(story)


@pytest.mark.slow
def test_a_worker_killed_while_idle_is_replaced() -> None:
    async def story(pool: WorkerPool) -> None:
        pid = await pool.run(os.getpid, deadline=10)
        os.kill(pid, signal.SIGKILL)
        await until(lambda: gone(pid))
        await asyncio.sleep(3 * pools.RESPITE)
        assert await pool.run(os.getpid, deadline=10) != pid

    tell(story)


@pytest.mark.parametrize("error", [EOFError, BrokenPipeError])
def test_failing_to_fork_costs_no_worker(
    error: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The process that workers are forked from died: before it was asked, or while it forked."""
    process = launch.context().Process
    begin, failures = process.start, [error()]

    def start(self: object) -> None:
        if failures:
            raise failures.pop()
        begin(self)

    monkeypatch.setattr(pools, "RETRY", 0.05)
    monkeypatch.setattr(process, "start", start)

    async def story(pool: WorkerPool) -> None:
        assert await pool.run(json.loads, "1", deadline=10) == 1
        assert not failures

    tell(story)


def test_cancelling_the_caller_kills_the_worker() -> None:
    async def story(pool: WorkerPool) -> None:
        pid = await pool.run(os.getpid, deadline=10)
        task = asyncio.create_task(pool.run(time.sleep, 600, deadline=600))
        await asyncio.sleep(0.3)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        await until(lambda: gone(pid))
        assert await pool.run(json.loads, "2", deadline=10) == 2

    tell(story)


@pytest.mark.slow
def test_cancelling_again_and_again_leaves_a_working_pool() -> None:
    async def story(pool: WorkerPool) -> None:
        for k in range(10):
            task = asyncio.create_task(pool.run(time.sleep, 600, deadline=600))
            await asyncio.sleep(0.02 * k)
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)
        assert await pool.run(json.loads, "3", deadline=20) == 3

    tell(story)


def test_memory_is_limited() -> None:
    async def story(pool: WorkerPool) -> None:
        assert len(await pool.run(bytes, 10 * 2**20, deadline=20)) == 10 * 2**20
        with pytest.raises(MemoryError):
            await pool.run(bytearray, 2 * 2**30, deadline=20)
        assert await pool.run(json.loads, "4", deadline=10) == 4

    tell(story, limits=Limits(memory=512))


@pytest.mark.slow
def test_a_sealed_worker_opens_nothing() -> None:
    async def story(pool: WorkerPool) -> None:
        with pytest.raises(OSError, match="Too many open files"):
            await pool.run(os.listdir, "/", deadline=30)
        with pytest.raises(OSError, match="Too many open files"):
            await pool.run(os.open, "/etc/passwd", os.O_RDONLY, deadline=30)
        table = b"x,z\n0,0\n1,0\n1,0.2\n3,0.2\n"
        for name, content in (("a.csv", table), ("a.json", b'{"points": [[0,0],[1,0]]}')):
            assert (await pool.run(import_terrain, content, name, {}, deadline=30))["points"]

    tell(story, limits=Limits(sealed=True))


@pytest.mark.slow
def test_no_task_is_lost_when_the_one_before_it_is_given_up() -> None:
    async def story(pool: WorkerPool) -> None:
        for k in range(40):
            given_up = asyncio.create_task(pool.run(time.sleep, 0.01, deadline=10))
            following = asyncio.create_task(pool.run(abs, -k, deadline=10))
            await asyncio.sleep(0.0005 * k)  # before, while and after the first one runs
            given_up.cancel()
            assert await following == k

    tell(story)


_KEPT: list[bytes] = []


def scatter() -> int:
    """Resident bytes after some were used and freed, the last of them not."""
    blocks = [bytes([k % 256]) * 2000 for k in range(50_000)]
    _KEPT.append(blocks.pop())
    del blocks
    return resident()


def resident() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")


@pytest.mark.slow
@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="others keep nothing")
def test_a_worker_without_work_gives_memory_back() -> None:
    async def story(pool: WorkerPool) -> None:
        before = await pool.run(resident, deadline=10)
        used = await pool.run(scatter, deadline=10)
        assert used > before + 80e6
        await asyncio.sleep(RESTLESS + 1.0)
        assert await pool.run(resident, deadline=10) < before + 20e6

    tell(story)


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="others keep nothing")
def test_a_process_that_keeps_memory_keeps_no_more_than_it_may() -> None:
    async def story(pool: WorkerPool) -> None:
        before = await pool.run(resident, deadline=10)
        used = await pool.run(scatter, deadline=10)
        await pool.run(keep_no_more_than, 2 * used, deadline=10)
        assert await pool.run(resident, deadline=10) > before + 80e6
        await pool.run(keep_no_more_than, before, deadline=10)
        assert await pool.run(resident, deadline=10) < before + 20e6

    tell(story)


def test_the_first_task_starts_the_workers() -> None:
    async def run() -> None:
        pool = WorkerPool("test", 1, Limits())
        try:
            assert await pool.run(json.loads, "[1]", deadline=10) == [1]
        finally:
            await pool.stop()

    asyncio.run(run())
