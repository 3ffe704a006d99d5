"""Many people at once: 20 sessions drag a corner, each at 30 moves a second, while rollouts queue.

    python benchmarks/load.py [--sessions 20] [--seconds 20] [--method critical] [--quick]
                              [--json FILE]

Each session has one question in flight and asks for its newest move when the answer comes; moves
in between are passed over (latest wins). All the while the rollout queue is full. Stated: errors,
answers a second, and how evenly the sessions are served. The clients take their share of the same
cores.
"""

from __future__ import annotations

import argparse
import asyncio
import math
import statistics
import time
from dataclasses import dataclass, field

import httpx
from report import Row, percentile, publish
from service import long_rollout, serve

RATE = 30.0  # moves a second and session


@dataclass
class Session:
    """One person who drags."""

    name: str
    number: int
    times: list[float] = field(default_factory=list)  # of answers [ms]
    ages: list[float] = field(default_factory=list)  # of the moves that answers show [ms]
    errors: list[str] = field(default_factory=list)


def question(session: Session, move: int, method: str) -> dict[str, object]:
    """The stair with its corner where the hand is: a terrain that nobody has asked for."""
    angle = move / RATE * 2.0 + session.number
    x, z = 0.05 * math.sin(angle), 0.3 + 0.05 * math.cos(0.7 * angle) + 1e-5 * session.number
    points = [[-1.5, 0.0], [x, 0.0], [x, z], [2.0, z]]
    return {"terrain": {"points": points, "friction": 0.6}, "method": method}


async def drag(session: Session, url: str, seconds: float, method: str) -> None:
    """Ask for the newest move, again and again."""
    headers = {"stairwright-session": session.name}
    async with httpx.AsyncClient(base_url=url, headers=headers, timeout=120) as api:
        begun = time.perf_counter()
        last = -1
        while (now := time.perf_counter() - begun) < seconds:
            move = int(now * RATE)
            if move == last:
                await asyncio.sleep((move + 1) / RATE - now)
                continue
            last = move
            answer = await api.post("/plans", json=question(session, move, method))
            done = time.perf_counter() - begun
            session.times.append(1e3 * (done - now))
            session.ages.append(1e3 * (done - move / RATE))
            if not answer.is_success:
                session.errors.append(f"{answer.status_code} {answer.text[:200]}")


async def all_at_once(sessions: list[Session], url: str, seconds: float, method: str) -> None:
    """Every session at the same time."""
    await asyncio.gather(*(drag(session, url, seconds, method) for session in sessions))


def fill(api: httpx.Client) -> int:
    """Ask for long rollouts until the queue is full; how many fit."""
    count = 0
    while True:
        try:
            long_rollout(api, count)
        except httpx.HTTPStatusError as error:
            if error.response.status_code != 429:
                raise
            return count
        count += 1


def run(
    quick: bool = False, count: int = 20, seconds: float | None = None, method: str = "critical"
) -> list[Row]:
    """All rows."""
    seconds = seconds or (5.0 if quick else 20.0)
    with serve() as service, httpx.Client(base_url=service.api, timeout=120) as api:
        rollouts = fill(api)
        sessions = [Session(api.post("/sessions").json()["id"], k) for k in range(count)]
        asyncio.run(all_at_once(sessions, service.api, 1.0, method))  # connections, caches
        sessions = [Session(each.name, each.number) for each in sessions]
        asyncio.run(all_at_once(sessions, service.api, seconds, method))
        dead = service.figure('worker_deaths_total{pool="plans"}')
    errors = [error for session in sessions for error in session.errors]
    for error in errors[:5]:
        print(error)
    rates = sorted(len(session.times) / seconds for session in sessions)
    tails = [percentile(session.times, 0.99) for session in sessions]
    every = [each for session in sessions for each in session.times]
    ages = [each for session in sessions for each in session.ages]
    middle = statistics.median(rates)
    work = f"{count} sessions drag ({method}), {rollouts} rollouts wait"
    solved = f"{len(every) - len(errors)} of {len(every)}"
    return [
        Row(f"{work}: answer", "all", statistics.median(every), percentile(every, 0.95),
            solved=solved, note=f"{len(every) / seconds:.0f} answers/s, {dead:.0f} dead workers"),
        Row("age of the move that an answer shows", "all", statistics.median(ages),
            percentile(ages, 0.95)),
        Row("p99 of an answer, by session", "sessions", statistics.median(tails), max(tails)),
        Row("answers a second, by session", "sessions", middle, unit="1/s",
            ratio=middle / rates[0], note=f"slowest {rates[0]:.2f}, fastest {rates[-1]:.2f}"),
    ]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sessions", type=int, default=20)
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--method", default="critical")
    parser.add_argument("--quick", action="store_true", help="5 seconds")
    parser.add_argument("--json")
    given = parser.parse_args()
    publish(run(given.quick, given.sessions, given.seconds, given.method), given.json)


if __name__ == "__main__":
    main()
