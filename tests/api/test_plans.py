"""Plans and rollouts over REST: real planner, real simulator, real workers."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator

import httpx
import numpy as np
import pytest

import stairwright as sw
from stairwright.client import Client, ServiceError
from stairwright.terrain.profile import Terrain
from tests.conftest import Server

CURB = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
WALL = {"points": [[-1.0, 0], [0, 0], [0, 3], [1, 3]]}


@pytest.fixture(scope="module")
def api(server: Server) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as client:
        yield client


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


def test_a_plan_is_solved_stored_and_found_again(api: httpx.Client) -> None:
    first = api.post("/plans", json={"terrain": CURB, "robot": "a1_wheeled"})
    assert first.status_code == 200, first.text
    plan = first.json()
    assert plan["schema"] == "stairwright/plan/1"
    assert plan["status"] == "feasible"
    assert len(plan["poses"]) > 10
    again = api.post("/plans", json={"terrain": CURB, "robot": "a1_wheeled"})
    assert again.json() == plan  # solve_time and all: it was not solved again
    stored = api.get(f"/plans/{plan['id']}")
    assert stored.json() == plan
    tag = stored.headers["etag"]
    same = api.get(f"/plans/{plan['id']}", headers={"if-none-match": tag})
    assert same.status_code == 304
    assert plan["id"] in [each["id"] for each in api.get("/plans").json()]


def test_plans_of_documents_that_differ_in_texts_are_kept_apart(api: httpx.Client) -> None:
    robot = sw.load_robot("a1_wheeled").model_dump(mode="json")
    questions = [
        {"terrain": CURB | {"name": "Alice"}, "robot": robot},
        {"terrain": CURB | {"name": "Bob"}, "robot": robot},
        {"terrain": CURB | {"name": "Bob", "description": "a curb"}, "robot": robot},
        {"terrain": CURB | {"name": "Bob"}, "robot": robot | {"description": "mine"}},
    ]
    plans = [api.post("/plans", json=question).json() for question in questions]
    assert len({plan["id"] for plan in plans}) == len(plans)
    assert len({plan["terrain_hash"] for plan in plans}) == 1  # of what planning depends on
    assert len({plan["robot_hash"] for plan in plans}) == 1
    for plan in plans:
        assert api.get(f"/plans/{plan['id']}").json() == plan


def test_robots_that_cannot_be_simulated_are_refused(api: httpx.Client) -> None:
    robot = sw.load_robot("a1_wheeled").model_dump(mode="json")
    robot["trunk"]["inertia"] = [1.0, 1.0, 100.0]
    answer = api.post("/plans", json={"terrain": CURB, "robot": robot})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == "robot.trunk.inertia"


def test_compressed_or_not_it_is_the_same_plan(api: httpx.Client) -> None:
    question = {"terrain": CURB, "robot": "a1_wheeled"}
    plain = api.post("/plans", json=question, headers={"accept-encoding": "identity"})
    packed = api.post("/plans", json=question, headers={"accept-encoding": "gzip"})
    assert "content-encoding" not in plain.headers
    assert packed.headers["content-encoding"] == "gzip"
    assert plain.json() == packed.json()


@pytest.mark.slow
def test_what_cannot_be_climbed_is_a_plan_with_a_problem(api: httpx.Client) -> None:
    answer = api.post("/plans", json={"terrain": WALL, "method": "path"})
    assert answer.status_code == 200, answer.text
    plan = answer.json()
    assert plan["status"] == "infeasible"
    assert plan["problem"]["message"]
    assert len(plan["problem"]["at"]) == 2


@pytest.mark.parametrize("method", ["path", "critical", "nominal"])
@pytest.mark.parametrize("robot", ["a1_wheeled", "a1_wheeled_x"])
def test_every_method_with_every_robot(api: httpx.Client, method: str, robot: str) -> None:
    body = {"terrain": CURB, "robot": robot, "method": method, "friction": 0.7}
    answer = api.post("/plans", json=body)
    assert answer.status_code == 200, answer.text
    assert answer.json()["method"] == method
    assert answer.json()["friction"] == 0.7


@pytest.mark.parametrize(
    ("body", "field"),
    [
        ({}, "terrain"),
        ({"terrain": "nowhere"}, "terrain"),
        ({"terrain": "../../etc/passwd"}, "terrain"),
        ({"terrain": "pyproject.toml"}, "terrain"),
        ({"terrain": "/etc/passwd.yaml"}, "terrain"),
        ({"terrain": {"points": [[0, 0], [1, 0], [0.5, 1]]}}, "terrain.points.2"),
        ({"terrain": {"points": [[0, 0], [1, "a"]]}}, "terrain.points.1.1"),
        ({"terrain": {"points": [[0, 0], [1, 0]], "colour": 1}}, "terrain.colour"),
        ({"terrain": CURB, "robot": "nobody"}, "robot"),
        ({"terrain": CURB, "robot": {"name": "x"}}, "robot.nominal_height"),
        ({"terrain": CURB, "friction": 0}, "friction"),
        ({"terrain": CURB, "friction": True}, "friction"),
        ({"terrain": CURB, "method": "magic"}, "method"),
        ({"terrain": CURB, "weights": {"beauty": 1}}, "weights.beauty"),
        ({"terrain": CURB, "weights": {"speed": 1e6}}, "weights.speed"),
        ({"terrain": CURB, "weights": {"speed": "slow"}}, "weights.speed"),
        ({"terrain": 5}, "terrain"),
        ({"terrain": CURB, "wieghts": {}}, "wieghts"),
    ],
)
def test_each_bad_value_is_named(api: httpx.Client, body: dict[str, object], field: str) -> None:
    answer = api.post("/plans", json=body)
    assert answer.status_code == 422, answer.text
    problem = answer.json()
    assert problem["status"] == 422
    assert problem["errors"][0]["field"] == field
    assert problem["errors"][0]["message"]


def test_misspelt_fields_and_unknown_ids_are_told_in_words(api: httpx.Client) -> None:
    misspelt = api.post("/plans", json={"terain": {"point": []}, "robot": "a1_wheeled"}).json()
    assert misspelt["errors"][0]["message"] == "unknown field; did you mean 'terrain'?"
    inner = api.post("/plans", json={"terrain": CURB, "tolerance": {"width": 1}}).json()
    assert inner["errors"][0]["message"] == "unknown field; there are: height, place, friction"
    other = api.post("/plans", json={"terrain": {"schema": "stairwright/robot/2", "name": "x"}})
    assert other.json()["detail"].endswith("this is a robot (stairwright/robot/2), not a terrain")
    for path, told in {
        "/trials/x": "there are no trials with the id 'x'",
        "/rollouts/x": "there is no rollout with the id 'x'",
        "/robots/x": "there is no robot with the name 'x'",
    }.items():
        assert api.get(path).json()["detail"] == told


def test_null_is_the_default_as_in_python(api: httpx.Client) -> None:
    nothing = {"friction": None, "weights": None}
    plans = [api.post("/plans", json={"terrain": CURB, **given}) for given in ({}, nothing)]
    assert plans[0].json()["id"] == plans[1].json()["id"]
    for controller in (None, {"speed": None}):
        body = {"terrain": CURB, "controller": controller, **nothing}
        assert api.post("/rollouts", json=body).status_code == 202


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
