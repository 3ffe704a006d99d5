"""Tolerances and margins over REST, by the client, on the command line and in studies."""

from __future__ import annotations

import json
from pathlib import Path

import httpx
import pytest

import stairwright as sw
from stairwright.cli import main
from stairwright.jobs.questions import MarginsQuestion, RolloutQuestion
from stairwright.simulation import robust_margins
from stairwright.simulation.robust_margins import DELAYS, FRICTIONS
from tests.conftest import Server

CURB = {"name": "curb", "points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]], "friction": 0.4}
LEVEL = {"name": "level", "points": [[-0.5, 0], [0.5, 0]], "friction": 0.2}
ASKED = {"height": 0.01, "friction": 0.1}


def test_a_plan_with_a_tolerance_is_that_of_python(server: Server, api: httpx.Client) -> None:
    with sw.Client(server.url) as service:
        plan = service.plan(CURB, tolerance=ASKED)
        assert service.get_plan(plan.id) == plan
        assert service.plan(CURB).id != plan.id
    own = sw.plan(CURB, tolerance=ASKED)
    assert (plan.id, plan.tolerance, plan.poses) == (own.id, own.tolerance, own.poses)
    listed = {entry["id"]: entry["summary"] for entry in api.get("/plans").json()}
    assert listed[plan.id]["tolerance"] == ASKED


@pytest.mark.parametrize(
    ("body", "field"),
    [
        ({"tolerance": {"height": 1}}, "tolerance.height"),
        ({"tolerance": {"friction": 0.4}}, "tolerance.friction"),
        ({"tolerance": ASKED, "method": "critical"}, "tolerance"),
        ({"tolerance": [1]}, "tolerance"),
    ],
)
def test_a_bad_tolerance_is_told_by_its_field(
    api: httpx.Client, body: dict[str, object], field: str
) -> None:
    answer = api.post("/plans", json={"terrain": CURB, **body})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == field


def test_settings_tell_what_can_be_asked(api: httpx.Client) -> None:
    told = api.get("/settings").json()["tolerance"]["properties"]
    assert list(told) == ["height", "place", "friction"]
    assert told["height"]["unit"] == "m"
    assert told["height"]["minimum"] == 0.0


@pytest.mark.slow
def test_margins_are_those_of_python(server: Server, api: httpx.Client) -> None:
    told: list[float] = []
    with sw.Client(server.url) as service:
        plan = service.plan(LEVEL)
        found = service.margins(plan.id, seed=2, progress=told.append)
    assert found.plan_id == plan.id
    assert found.delay is not None
    assert sw.rollout(plan, seed=2, disturbance={"delay": found.delay}).success
    assert told[-1] == 1.0
    listed = api.get("/margins").json()[0]
    assert listed["id"] == found.id
    assert listed["summary"]["delay_margin"] == found.delay
    again = api.post("/margins", json={"plan_id": plan.id, "seed": 2})
    assert again.status_code == 202
    assert again.json()["state"] == "done"
    assert again.json()["result"] == f"/api/v1/margins/{found.id}"
    assert api.delete(f"/margins/{found.id}").status_code == 204
    assert api.get(f"/margins/{found.id}").status_code == 404
    refused = api.post("/margins", json={"plan_id": plan.id, "friction": 0.3})
    assert refused.json()["errors"][0]["field"] == "friction"


def test_a_question_for_margins_survives_a_restart() -> None:
    asked = MarginsQuestion("0" * 64, None, {}, 4)
    again = RolloutQuestion.restored(json.loads(json.dumps(asked.data)))
    assert again == asked
    assert asked.runs == 1 + len(DELAYS) + len(FRICTIONS)


@pytest.mark.slow
def test_the_command_line_asks_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(robust_margins, "DELAYS", (0.002,))
    monkeypatch.setattr(robust_margins, "FRICTIONS", (0.05,))
    terrain, out = tmp_path / "curb.json", tmp_path / "plan.json"
    terrain.write_text(json.dumps(CURB))
    asked = [f"{name}={value}" for name, value in ASKED.items()]
    flags = [word for one in asked for word in ("--tolerance", one)]
    assert main(["plan", str(terrain), *flags, "-o", str(out)]) == 0
    assert json.loads(out.read_text())["id"] == sw.plan(CURB, tolerance=ASKED).id
    assert main(["plan", str(terrain), *flags]) == 0
    assert "height 0.01, friction 0.1" in capsys.readouterr().out
    assert main(["plan", str(terrain), "--tolerance", "width=1"]) == 2
    assert main(["margins", str(out), *flags]) == 2  # the plan says it already
    assert main(["margins", str(out), "-o", str(tmp_path / "margins.json")]) == 0
    told = json.loads((tmp_path / "margins.json").read_text())
    assert told["schema"] == "stairwright/margins/1"
    assert told["delay"] == 0.002


def test_a_study_varies_it(tmp_path: Path) -> None:
    document = {
        "schema": "stairwright/study/1",
        "terrain": CURB,
        "tolerance": {"friction": 0.1},
        "axes": [{"name": "tolerance.height", "values": [0.0, 0.01]}],
    }
    found = sw.study(document, workers=1, store=tmp_path / "study.zarr").dataset
    ids = [str(value) for value in found.plan_id.values]
    frictions = [{"friction": 0.1}, {"friction": 0.1, "height": 0.01}]
    assert ids == [sw.plan(CURB, tolerance=one).id for one in frictions]
