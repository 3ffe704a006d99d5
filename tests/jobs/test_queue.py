"""Owners take turns; what is given up leaves no hole."""

from __future__ import annotations

import asyncio

import pytest

from stairwright.jobs.failures import QueueFull
from stairwright.jobs.queue import FairQueue


async def hold(queue: FairQueue, owner: str, log: list[str], done: asyncio.Event) -> None:
    async with queue.slot(owner):
        log.append(owner)
        await done.wait()


def test_owners_take_turns() -> None:
    async def story() -> list[str]:
        queue, log, done = FairQueue(1, 10, "tasks"), [], asyncio.Event()
        tasks = []
        for owner in ("a", "a", "a", "b", "c"):
            tasks.append(asyncio.create_task(hold(queue, owner, log, done)))
            await asyncio.sleep(0)
        done.set()
        await asyncio.gather(*tasks)
        assert queue.running == 0
        assert queue.length == 0
        return log

    assert asyncio.run(story()) == ["a", "a", "b", "c", "a"]


def test_beyond_the_limit_it_says_when_to_come_back() -> None:
    async def story() -> None:
        queue, log, done = FairQueue(1, 2, "tasks"), [], asyncio.Event()
        tasks = [asyncio.create_task(hold(queue, "a", log, done)) for _ in range(3)]
        await asyncio.sleep(0)
        with pytest.raises(QueueFull) as refused:
            await hold(queue, "a", log, done)
        assert refused.value.retry_after is not None
        assert refused.value.retry_after >= 1.0
        other = asyncio.create_task(hold(queue, "b", log, done))  # has nothing here yet
        await asyncio.sleep(0)
        with pytest.raises(QueueFull):
            await hold(queue, "b", log, done)
        done.set()
        await asyncio.gather(*tasks, other)
        await hold(queue, "a", log, done)

    asyncio.run(story())


def test_one_owner_cannot_hold_all_workers() -> None:
    async def story() -> None:
        queue, done = FairQueue(2, 10, "tasks", reserve=1), asyncio.Event()
        log: list[str] = []
        tasks = [asyncio.create_task(hold(queue, "a", log, done)) for _ in range(4)]
        await asyncio.sleep(0)
        assert queue.running == 2
        tasks.append(asyncio.create_task(hold(queue, "b", log, done)))
        await asyncio.sleep(0)
        assert queue.running == 3  # at once, on the spare
        tasks.append(asyncio.create_task(hold(queue, "c", log, done)))
        await asyncio.sleep(0)
        assert queue.running == 3  # there is only one
        done.set()
        await asyncio.gather(*tasks)
        assert (queue.running, queue.length) == (0, 0)

    asyncio.run(story())


def test_no_waiting_place_still_serves_when_idle() -> None:
    async def story() -> None:
        queue, done = FairQueue(1, 0, "tasks"), asyncio.Event()
        done.set()
        await hold(queue, "a", [], done)

    asyncio.run(story())


@pytest.mark.parametrize("given_up", [0, 1, 2])
def test_who_gives_up_waiting_frees_the_place(given_up: int) -> None:
    async def story() -> None:
        queue, log, done = FairQueue(1, 10, "tasks"), [], asyncio.Event()
        tasks = [asyncio.create_task(hold(queue, "abc"[k], log, done)) for k in range(3)]
        await asyncio.sleep(0)
        tasks[given_up].cancel()
        await asyncio.sleep(0)
        done.set()
        await asyncio.gather(*tasks, return_exceptions=True)
        assert set(log) >= set("abc") - {"abc"[given_up]}
        assert (queue.running, queue.length) == (0, 0)

    asyncio.run(story())


def test_cancelled_in_the_moment_of_its_turn() -> None:
    async def story() -> None:
        queue, log, done = FairQueue(1, 10, "tasks"), [], asyncio.Event()
        first = asyncio.create_task(hold(queue, "a", log, done))
        second = asyncio.create_task(hold(queue, "b", log, asyncio.Event()))
        await asyncio.sleep(0)
        first.cancel()
        await asyncio.sleep(0)
        second.cancel()
        await asyncio.gather(first, second, return_exceptions=True)
        assert queue.running == 0

    asyncio.run(story())


def test_more_slots_let_those_in_who_wait() -> None:
    async def story() -> None:
        queue, log, done = FairQueue(1, 10, "tasks"), [], asyncio.Event()
        tasks = [asyncio.create_task(hold(queue, "a", log, done)) for _ in range(4)]
        await asyncio.sleep(0)
        assert queue.running == 1
        queue.resize(3)
        await asyncio.sleep(0)
        assert len(log) == queue.running == 3
        queue.resize(1)  # what runs goes on
        assert queue.running == 3
        done.set()
        await asyncio.gather(*tasks)
        assert queue.running == 0

    asyncio.run(story())
