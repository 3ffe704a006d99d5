"""Plans over one connection: the same answers as REST's, and only the newest question counts."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect

from tests.conftest import Server

STAIR = {"points": [[-1.0, 0], [0, 0], [0, 0.2], [1.2, 0.2]]}


@pytest.fixture
def line(server: Server) -> Iterator[ClientConnection]:
    """A connection to the server."""
    with connect(f"{server.url.replace('http', 'ws')}/api/v1/plans/live") as connection:
        yield connection


def ask(line: ClientConnection, number: int, keep: bool = True, **body: Any) -> None:
    question = {"terrain": STAIR, "method": "critical"} | body
    line.send(json.dumps({"id": number, "keep": keep, "body": question}))


def answer(line: ClientConnection) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(line.recv(timeout=60))
    return found


def test_the_answer_is_that_of_rest(server: Server, line: ClientConnection) -> None:
    for _ in range(2):  # solved, then stored
        ask(line, 7)
        live = answer(line)
        assert (live["id"], live["status"]) == (7, 200)
        body = {"terrain": STAIR, "method": "critical"}
        assert httpx.post(f"{server.url}/api/v1/plans", json=body).json() == live["plan"]


def test_only_the_newest_question_is_answered(line: ClientConnection) -> None:
    for number in range(20):
        ask(line, number, friction=0.5 + 0.01 * number)
    answers = [answer(line)]
    while answers[-1]["id"] != 19:
        answers.append(answer(line))
    assert answers[-1]["plan"]["friction"] == pytest.approx(0.69)
    assert [one["id"] for one in answers] == sorted(one["id"] for one in answers)
    assert all(one["status"] == 200 for one in answers)


def test_what_is_not_to_be_kept_is_the_same_plan_and_leaves_no_trace(
    server: Server, line: ClientConnection
) -> None:
    plans = {}
    for keep in (False, True):
        ask(line, 1, keep, friction=0.77)
        plans[keep] = answer(line)["plan"]
        found = httpx.get(f"{server.url}/api/v1/plans/{plans[keep]['id']}").status_code
        assert found == (200 if keep else 404)
        del plans[keep]["solve_time"]
    assert plans[False]["certificate"] is None
    assert plans[True].pop("certificate")["passed"]
    assert plans[False] == plans[True] | {"certificate": None}


def test_a_path_that_is_not_to_be_kept_is_not_diagnosed(line: ClientConnection) -> None:
    wall = {"points": [[-1.0, 0], [0, 0], [0, 1.2], [1.2, 1.2]]}
    limits = []
    for keep in (False, True):
        ask(line, 1, keep, terrain=wall, method="path")
        plan = answer(line)["plan"]
        assert plan["status"] == "infeasible"
        limits.append(plan["problem"]["limit"])
    assert limits[0] is None
    assert limits[1] is not None


def test_a_question_can_be_taken_back(line: ClientConnection) -> None:
    ask(line, 1, terrain={"points": [[0.4 * k, 0.1 * (k % 2)] for k in range(150)]}, method="path")
    line.send(json.dumps({"id": 1}))
    ask(line, 2)
    assert answer(line)["id"] == 2


@pytest.mark.parametrize(
    ("message", "status", "number", "field"),
    [
        ("{", 400, None, None),
        ('{"id": 1, "body": {"friction": NaN}}', 400, None, None),
        ("[" * 100_000, 400, None, None),
        ("[]", 422, None, None),
        ('{"id": -1}', 422, -1, "id"),
        ('{"id": 3, "body": {}}', 422, 3, "terrain"),
        ('{"id": 4, "body": {"terrain": "nowhere"}}', 422, 4, "terrain"),
        ('{"id": 5, "body": {"terrain": "ramp-30", "friction": -1}}', 422, 5, "friction"),
        (
            '{"id": 6, "body": {"terrain": {"points": [[0, 0], [-1, 0]]}}}',
            422,
            6,
            "terrain.points.1",
        ),
        ('{"id": 7, "more": 1}', 422, 7, "more"),
        (b"\xff\x00", 400, None, None),
        ("x" * 5_000_000, 413, None, None),
    ],
)
def test_bad_messages_are_answered_and_the_connection_goes_on(
    line: ClientConnection, message: str | bytes, status: int, number: int | None, field: str | None
) -> None:
    line.send(message)
    refused = answer(line)
    assert (refused["status"], refused["id"]) == (status, number)
    assert refused["problem"]["status"] == status
    if field is not None:
        assert refused["problem"]["errors"][0]["field"] == field
    ask(line, 99)
    assert answer(line)["id"] == 99


def test_pages_of_others_are_refused(server: Server) -> None:
    address = f"{server.url.replace('http', 'ws')}/api/v1/plans/live"
    with pytest.raises(InvalidStatus), connect(address, origin="https://example.org"):
        pass
