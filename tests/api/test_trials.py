"""Sets of trials over REST: jobs like rollouts, and what came of them."""

from __future__ import annotations

import httpx
import pytest

import stairwright as sw
from tests.conftest import Server

CURB = {"name": "curb", "points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}


@pytest.mark.slow
def test_trials_are_those_of_python(server: Server, api: httpx.Client) -> None:
    told: list[float] = []
    with sw.Client(server.url) as service:
        plan = service.plan(CURB)
        found = service.trials(plan.id, 2, "laboratory", seed=3, progress=told.append)
    assert found == sw.trials(plan, 2, bundle="laboratory", seed=3)
    assert found.count == 2
    assert told[-1] == 1.0
    listed = api.get("/trials").json()[0]
    assert listed["id"] == found.id
    assert listed["summary"]["successes"] == found.successes
    assert api.get("/jobs", params={"kind": "trials"}).json()[0]["kind"] == "trials"

    worst = found.trials[0]
    body = {
        "plan_id": plan.id,
        "seed": worst.seed,
        "disturbance": worst.disturbance.model_dump(mode="json"),
    }
    job = api.post("/rollouts", json=body).json()
    with sw.Client(server.url) as service:
        replayed = service.result(service.wait(job["id"]))
    assert replayed.metrics.pitch_error_max == pytest.approx(worst.pitch_error_max)

    again = api.post("/trials", json={"plan_id": plan.id, "count": 2, "bundle": "laboratory",
                                      "seed": 3}).json()  # fmt: skip
    assert again["state"] == "done"
    assert again["result"] == f"/api/v1/trials/{found.id}"
    assert api.delete(again["result"].removeprefix("/api/v1")).status_code == 204
    assert api.get(again["result"].removeprefix("/api/v1")).status_code == 404


def test_trials_plan_first_and_can_be_cancelled(api: httpx.Client) -> None:
    job = api.post("/trials", json={"terrain": "three-stairs-up", "count": 500}).json()
    assert job["kind"] == "trials"
    assert api.delete(f"/jobs/{job['id']}").json()["state"] == "cancelled"


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        ({"count": 0}, "count"),
        ({"count": 1001}, "count"),
        ({"bundle": "moon"}, "bundle"),
        ({"bundle": "field", "ranges": {}}, "bundle"),
        ({"ranges": {"heading": [0.1, -0.1]}}, "ranges.heading"),
        ({"seed": 2**53}, "seed"),
        ({"plan_id": "p-0"}, "plan_id"),
        ({"controller": {"stiffness": 1}}, "controller.stiffness"),
    ],
)
def test_bad_questions_name_the_field(
    api: httpx.Client, wrong: dict[str, object], field: str
) -> None:
    body = {} if "plan_id" in wrong else {"terrain": CURB}
    answer = api.post("/trials", json={**body, **wrong})
    assert answer.status_code in (404, 422)
    assert field in {error["field"] for error in answer.json()["errors"]}


def test_settings_tell_what_can_deviate(api: httpx.Client) -> None:
    document = api.get("/settings").json()
    assert document["disturbance"]["properties"]["heading"]["default"] == 0.0
    assert {"usual", "laboratory", "field"} <= document["bundles"].keys()
    assert document["bundles"]["field"]["x_offset"][1] > 0.0
