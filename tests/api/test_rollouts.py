"""Rollouts over REST: real planner, real simulator, real workers."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator

import httpx
import numpy as np
import pytest

from stairwright.client import Client, ServiceError
from stairwright.terrain.profile import Terrain
from tests.conftest import Server

CURB = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
WALL = {"points": [[-1.0, 0], [0, 0], [0, 1.3], [1, 1.3]]}


@pytest.fixture(scope="module")
def service(server: Server) -> Iterator[Client]:
    with Client(server.url) as client:
        yield client


def events(api: httpx.Client, job: str, **headers: str) -> list[tuple[int, dict[str, object]]]:
    """All events of a job until its stream ends: (id, document)."""
    found = []
    with api.stream("GET", f"/jobs/{job}/events", headers=headers) as stream:
        assert stream.headers["content-type"].startswith("text/event-stream")
        block: dict[str, str] = {}
        for line in stream.iter_lines():
            if line and not line.startswith(":"):
                key, _, value = line.partition(": ")
                block[key] = value
            elif block:
                if block["event"] == "job":
                    found.append((int(block["id"]), json.loads(block["data"])))
                else:
                    assert block["event"] == "series"
                    assert "id" not in block
                block = {}
    return found


@pytest.mark.slow
def test_a_rollout_from_start_to_files(api: httpx.Client) -> None:
    started = api.post("/rollouts", json={"terrain": CURB, "robot": "a1_wheeled_x", "seed": 3})
    assert started.status_code == 202, started.text
    job = started.json()
    assert started.headers["location"] == f"/api/v1/jobs/{job['id']}"
    assert int(started.headers["retry-after"]) >= 1
    told = events(api, job["id"])
    assert [number for number, _ in told] == sorted({number for number, _ in told})
    progress = [document["progress"] for _, document in told]
    assert progress == sorted(progress)
    last = told[-1][1]
    assert (last["state"], last["progress"], last["error"]) == ("done", 1.0, None)
    assert last == api.get(f"/jobs/{job['id']}").json()
    path = str(last["result"]).removeprefix("/api/v1")
    run = api.get(path).json()
    assert run["schema"] == "stairwright/rollout/1"
    assert run["outcome"] == "success"
    assert run["seed"] == 3
    samples = len(run["series"]["time"])
    assert np.shape(run["series"]["q"]) == (samples, 12)
    plan = api.get(f"/plans/{run['plan_id']}")
    assert plan.status_code == 200  # the plan that it made for itself can be looked at
    for name in ("json", "csv", "npz", "mcap", "html"):
        export = api.get(f"{path}/export", params={"format": name})
        assert export.status_code == 200, export.text
        assert f".{name}" in export.headers["content-disposition"]
        assert len(export.content) > 1000
        if name == "json":
            assert export.json()["id"] == run["id"]
        if name == "npz":
            with np.load(io.BytesIO(export.content)) as arrays:
                assert any(len(arrays[key]) == samples for key in arrays.files if arrays[key].ndim)
    for name in ("json", "csv", "npz", "mcap", "mjcf"):
        assert api.get(f"/plans/{run['plan_id']}/export?format={name}").status_code == 200
    bundle = api.get(f"/plans/{run['plan_id']}/export?format=bundle")
    assert bundle.headers["content-type"] == "application/zip"
    assert bundle.content[:2] == b"PK"
    assert api.get(f"{path}/export?format=mjcf").status_code == 422

    again = api.post("/rollouts", json={"terrain": CURB, "robot": "a1_wheeled_x", "seed": 3})
    assert again.json()["state"] == "done"
    assert again.json()["id"] != job["id"]
    assert again.json()["result"] == last["result"]

    seen = api.get(f"/jobs/{job['id']}/events", headers={"last-event-id": str(told[-1][0])})
    assert seen.status_code == 204
    missed = events(api, job["id"], **{"last-event-id": str(told[-2][0])})
    assert missed == told[-1:]


@pytest.mark.slow
def test_a_changed_plan_and_its_rollout_get_ids_of_their_own(api: httpx.Client) -> None:
    plan = api.post("/plans", json={"terrain": CURB, "method": "critical"}).json()
    changed = json.loads(json.dumps(plan))
    changed["poses"][1]["pitch"] += 0.01
    results = []
    for body in ({"plan_id": plan["id"]}, {"plan": plan}, {"plan": changed}):
        job = api.post("/rollouts", json=body).json()
        results.append(events(api, job["id"])[-1][1]["result"])
    assert results[0] == results[1] != results[2]


@pytest.mark.slow
def test_the_client_does_the_same(service: Client) -> None:
    terrain = Terrain.model_validate(CURB)
    plan = service.plan(terrain, robot="a1_wheeled_x", friction=0.65)
    assert plan.feasible
    assert service.get_plan(plan.id) == plan
    seen: list[float] = []
    run = service.rollout(plan_id=plan.id, progress=seen.append, controller={"maximum_lead": 0.02})
    assert run.success
    assert run.plan_id == plan.id
    assert seen[-1] == 1.0
    assert service.export_rollout(run.id, "csv").startswith(b"time_s,")
    assert service.robots()[0].name == "a1_wheeled"
    saved = service.save_terrain(terrain.model_copy(update={"name": "of the client"}))
    assert service.terrain(saved.name) == saved
    service.delete_terrain(saved.name)
    with pytest.raises(ServiceError, match="there is no terrain") as refused:
        service.terrain(saved.name)
    assert refused.value.status == 404
    with pytest.raises(ServiceError, match="friction"):
        service.plan(terrain, friction=-1.0)


@pytest.mark.parametrize(
    ("body", "status", "field"),
    [
        ({}, 422, "plan_id"),
        ({"plan_id": "p-0123456789abcdef"}, 404, "plan_id"),
        ({"plan_id": "none of ours"}, 404, "plan_id"),
        ({"plan_id": "p-1", "terrain": CURB}, 422, "terrain"),
        ({"terrain": CURB, "controller": {"wings": 1}}, 422, "controller.wings"),
        ({"terrain": CURB, "controller": {"maximum_lead": -1}}, 422, "controller.maximum_lead"),
        ({"terrain": CURB, "controller": {"maximum_lead": [1]}}, 422, "controller.maximum_lead"),
        ({"terrain": CURB, "seed": -1}, 422, "seed"),
        ({"terrain": CURB, "seed": 1.5}, 422, "seed"),
    ],
)
def test_bad_rollouts(api: httpx.Client, body: dict[str, object], status: int, field: str) -> None:
    answer = api.post("/rollouts", json=body)
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert [error["field"] for error in answer.json()["errors"]] == [field]


@pytest.mark.slow
def test_a_rollout_over_a_wall_says_what_happened(api: httpx.Client) -> None:
    job = api.post("/rollouts", json={"terrain": WALL}).json()
    last = events(api, job["id"])[-1][1]
    if last["state"] == "failed":  # no pose at all, so nothing to carry out
        assert isinstance(last["error"], dict)
        assert last["error"]["status"] == 422
        assert last["result"] is None
    else:
        run = api.get(str(last["result"]).removeprefix("/api/v1")).json()
        # A plan that ends at the obstacle can be carried out as far as that.
        assert run["outcome"] != "success" or run["plan"]["status"] == "infeasible"


def test_a_key_makes_a_repeated_post_harmless(api: httpx.Client) -> None:
    body = {"terrain": CURB, "robot": "a1_wheeled_x", "seed": 77}
    key = {"idempotency-key": "key-of-this-test"}
    first = api.post("/rollouts", json=body, headers=key)
    second = api.post("/rollouts", json=body, headers=key)
    assert first.json()["id"] == second.json()["id"]
    other = api.post("/rollouts", json={**body, "seed": 78}, headers=key)
    assert other.status_code == 422
    assert other.json()["type"] == "urn:stairwright:problem:idempotency"
    bad = api.post("/rollouts", json={"seed": 1}, headers={"idempotency-key": "failed"})
    assert bad.status_code == 422
    retried = api.post("/rollouts", json=body, headers={"idempotency-key": "failed"})
    assert retried.status_code == 202  # a key whose request failed may be used again
    plans = [
        api.post("/plans", json={"terrain": CURB}, headers={"idempotency-key": "plan"}).json()
        for _ in range(2)
    ]
    assert plans[0]["id"] == plans[1]["id"]
