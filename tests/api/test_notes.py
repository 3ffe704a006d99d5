"""Lists of results: what they tell, names, notes and pins, search, and what survives."""

from __future__ import annotations

from pathlib import Path

import httpx
import pytest

import stairwright as sw
from stairwright.storage.store import Store
from tests.conftest import Server

CURB = {"name": "noted-curb", "points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}


@pytest.fixture(scope="module")
def rollout(server: Server, api: httpx.Client) -> str:
    """Its id; with a setting of each sort that differs from the default."""
    body = {"terrain": CURB, "weights": {"com_margin": 4.0}, "seed": 7, "friction": 0.7,
            "controller": {"joint_speed": 2.0}, "disturbance": {"payload": 0.5}}  # fmt: skip
    job = api.post("/rollouts", json=body).json()
    with sw.Client(server.url) as service:
        return service.result(service.wait(job["id"])).id


def _entry(api: httpx.Client, kind: str, document_id: str) -> dict[str, object]:
    return next(each for each in api.get(f"/{kind}").json() if each["id"] == document_id)


def test_a_row_tells_what_was_asked_and_what_came_of_it(api: httpx.Client, rollout: str) -> None:
    whole = api.get(f"/rollouts/{rollout}").json()
    summary = _entry(api, "rollouts", rollout)["summary"]
    assert isinstance(summary, dict)
    assert summary["weights"] == {"com_margin": 4.0}
    assert summary["controller"] == {"joint_speed": 2.0}
    assert summary["disturbance"] == {"payload": 0.5}
    assert (summary["seed"], summary["friction"], summary["method"]) == (7, 0.7, "path")
    assert summary["outcome"] == whole["outcome"]
    assert summary["duration"] == whole["metrics"]["duration"]
    plan = api.get(f"/plans/{whole['plan_id']}").json()
    least = min(pose["margins"]["com"] for pose in plan["poses"])
    assert summary["margins"]["com"] == pytest.approx(least)
    weight = sw.load_robot(plan["robot"]).mass * 9.81
    way = plan["poses"][-1]["progress"] * whole["metrics"]["progress"]
    assert summary["cost_of_transport"] == pytest.approx(whole["metrics"]["energy"] / weight / way)
    assert summary["planned_energy"] == plan["energy"] > 0
    assert summary["planned_cost_of_transport"] == plan["cost_of_transport"]
    assert summary["outline"] == CURB["points"]
    assert any(summary["pose"]["x"] == round(pose["x_c"], 3) for pose in plan["poses"])


def test_an_entry_is_named_noted_pinned_and_found(api: httpx.Client, rollout: str) -> None:
    path = f"/rollouts/{rollout}"
    changed = api.patch(path, json={"name": "Payload 50%", "note": "before the fix"})
    assert changed.status_code == 200, changed.text
    assert changed.json()["name"] == "Payload 50%"
    assert not changed.json()["pinned"]
    api.patch(path, json={"pinned": True})
    entry = _entry(api, "rollouts", rollout)
    assert (entry["name"], entry["note"], entry["pinned"]) == (
        "Payload 50%", "before the fix", True)  # fmt: skip
    assert api.get("/rollouts?pinned=true").json()[0]["id"] == rollout
    assert rollout not in [each["id"] for each in api.get("/rollouts?pinned=false").json()]
    for words in ("50%", "fix payload", "NOTED-curb"):
        found = api.get("/rollouts", params={"search": words, "limit": 5})
        assert rollout in [each["id"] for each in found.json()], words
        assert int(found.headers["x-total-count"]) >= 1
    for words in ("50_", "nowhere fix", "com_margin"):
        assert api.get("/rollouts", params={"search": words}).json() == []
    api.patch(path, json={"pinned": False, "name": "", "note": ""})
    assert api.get("/rollouts", params={"search": "50%"}).json() == []


@pytest.mark.parametrize(
    ("body", "field"),
    [
        ({"pinned": "yes"}, "pinned"),
        ({"name": "x" * 101}, "name"),
        ({"note": 3}, "note"),
        ({"colour": "red"}, "colour"),
    ],
)
def test_bad_changes_name_the_field(
    api: httpx.Client, rollout: str, body: dict[str, object], field: str
) -> None:
    refused = api.patch(f"/rollouts/{rollout}", json=body)
    assert refused.status_code == 422
    assert refused.json()["errors"][0]["field"] == field


@pytest.mark.parametrize("path", ["/plans/p-none", "/rollouts/r-none", "/trials/t-none"])
def test_what_is_not_there_cannot_be_noted(api: httpx.Client, path: str) -> None:
    assert api.patch(path, json={"pinned": True}).status_code == 404


def test_pinned_results_stay_when_room_is_made(tmp_path: Path) -> None:
    store = Store(tmp_path)
    for name in ("p-pinned", "p-plain", "p-new"):
        digest = store.artefacts.put(name.encode())
        store.shelve("plan", name, question=name, engine="e", digest=digest, size=100, summary={})
    store.documents.annotate("plan", "p-pinned", pinned=True)
    store.collect(keep_bytes=200)
    left = {entry.id for entry in store.documents.page("plan", 10, 0)[0]}
    assert left == {"p-pinned", "p-new"}
    store.collect(keep_bytes=0)
    assert [entry.id for entry in store.documents.page("plan", 10, 0)[0]] == ["p-pinned"]
    digest = store.artefacts.put(b"by newer code")
    store.shelve("plan", "p-pinned", question="q", engine="f", digest=digest, size=1, summary={})
    entry = store.documents.get("plan", "p-pinned")
    assert entry is not None
    assert entry.pinned
    store.close()
