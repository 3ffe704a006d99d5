"""Searches for designs over REST: started, followed, cancelled, gone on with, removed."""

from __future__ import annotations

import json
import time
from typing import Any

import httpx
import pytest

import stairwright as sw

from .test_design import TORQUE, _document

pytestmark = pytest.mark.slow  # a server of its own

ENDED = ("done", "failed", "cancelled")
STEPS = {"robot": "a1_wheeled", "axes": [{"name": "step.height", "values": [0.1, 0.2]}]}
SMALL = _document(
    ask=STEPS,
    vary=[{"name": TORQUE, "between": [6, 40]}],
    aims=[{"minimise": TORQUE}],
    designs=6,
    generation=3,
)
# Long by number: motors that climb every step, for a refusal takes a hundred times the work.
STRONG = {"vary": [{"name": TORQUE, "between": [15, 40]}]}
LONG = SMALL | STRONG | {"designs": 400, "generation": 2, "seed": 1}


def _listed(api: httpx.Client, name: str) -> dict[str, Any]:
    found: dict[str, Any] = next(each for each in api.get("/designs").json() if each["id"] == name)
    return found


def _until(api: httpx.Client, name: str, tried: int) -> dict[str, Any]:
    """Wait until it has tried so many."""
    while (now := _listed(api, name))["tried"] < tried:
        assert now["state"] in ("queued", "running"), now
        assert now["tried"] <= now["progress"] * now["designs"] + 0.01
        time.sleep(0.2)
    return now


def test_a_search_finds_what_the_command_line_finds(api: httpx.Client) -> None:
    answer = api.post("/designs", json=SMALL)
    assert answer.status_code == 202, answer.text
    name = answer.json()["id"]
    assert answer.headers["location"] == f"/api/v1/designs/{name}"
    assert api.get(f"/designs/{name}").status_code == 200  # before it has found anything
    while (found := api.get(f"/designs/{name}").json())["state"] not in ENDED:
        time.sleep(0.1)
    assert (found["state"], found["progress"], found["complete"]) == ("done", 1.0, True)
    truth = sw.design(SMALL, workers=1)
    assert truth.id == name
    assert sw.DesignResult.model_validate(found) == truth
    again = api.post("/designs", json=found["design"]).json()
    assert (again["id"], again["state"], again["tried"]) == (name, "done", 6)
    assert name not in [each["id"] for each in api.get("/studies").json()]
    assert api.get(f"/studies/{name}").status_code == 404


def test_its_events_tell_how_far_it_is_until_it_is_done(api: httpx.Client) -> None:
    begun = api.post("/designs", json=SMALL | {"seed": 5}).json()
    told = []
    with api.stream("GET", begun["links"]["events"].removeprefix("/api/v1")) as stream:
        assert stream.headers["content-type"].startswith("text/event-stream")
        for line in stream.iter_lines():
            if line.startswith("data: "):
                told.append(json.loads(line[6:]))
            elif line.startswith("id: "):
                last = line[4:]
    assert [each["id"] for each in told] == [begun["id"]] * len(told)
    assert [each["progress"] for each in told] == sorted(each["progress"] for each in told)
    assert (told[-1]["state"], told[-1]["tried"], told[-1]["complete"]) == ("done", 6, True)
    again = api.get(f"/designs/{begun['id']}/events", headers={"Last-Event-ID": last})
    assert again.status_code == 204
    assert api.get("/designs/d-0123456789abcdef/events").status_code == 404


def test_cancelled_gone_on_with_and_removed(api: httpx.Client) -> None:
    name = api.post("/designs", json=LONG).json()["id"]
    _until(api, name, 2)
    assert api.post(f"/designs/{name}/cancel").json()["state"] == "cancelled"
    kept = api.get(f"/designs/{name}").json()["candidates"]
    assert api.post("/designs", json=LONG).json()["id"] == name
    state = _until(api, name, len(kept) + 6)
    assert (state["state"], state["designs"]) == ("running", 400)
    assert state["eta"] > 0.0
    more = api.get(f"/designs/{name}").json()["candidates"]
    assert [each["values"] for each in more[: len(kept)]] == [each["values"] for each in kept]
    assert api.delete(f"/designs/{name}").status_code == 204
    assert api.get(f"/designs/{name}").status_code == 404
    assert api.post(f"/designs/{name}/cancel").status_code == 404


@pytest.mark.parametrize(
    ("fields", "field"),
    [
        ({"designs": 100_000}, "designs"),
        ({"designs": 10**12}, "designs"),
        ({"vary": [{"name": "__class__.x", "between": [1, 2]}]}, "vary.0.name"),
        ({"vary": [{"name": "robot.tail", "between": [1, 2]}], "aims": [{"minimise": "mass"}]},
         "vary.0.between"),
        ({"vary": [{"name": TORQUE, "between": [1, "NaN"]}]}, "vary.0.between"),
        ({"vary": [{"name": f"robot.{k}.x", "between": [1, 2]} for k in range(100)]}, "vary"),
        ({"aims": []}, "aims"),
        ({"aims": [{"minimise": "beauty"}]}, "aims.0"),
        ({"ask": STEPS | {"robot": "no such robot"}}, "ask.robot"),
        ({"ask": STEPS | {"terrain": "../../etc/passwd"}}, "ask.terrain"),
        ({"ask": STEPS | {"axes": [{"name": "friction", "from": 0, "to": 1, "count": 9999}]}},
         "designs"),
        ({"path": "/tmp/x"}, "path"),
    ],
)  # fmt: skip
def test_hostile_documents_are_refused_with_the_field(
    api: httpx.Client, fields: dict[str, Any], field: str
) -> None:
    answer = api.post("/designs", json=SMALL | fields)
    assert answer.status_code == 422, answer.text
    assert answer.json()["errors"][0]["field"].startswith(field), answer.text


def test_the_budget_is_the_services(api: httpx.Client) -> None:
    answer = api.post("/designs", json=SMALL | {"designs": 1001})
    assert answer.status_code == 422
    assert "2,002 cells are more than the budget of 2,000" in answer.json()["detail"]
    assert "STAIRWRIGHT_STUDY_CELLS" in answer.json()["detail"]
