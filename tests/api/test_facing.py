"""Which end of the robot leads: asked over REST and at the command line."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import httpx
import pytest

import stairwright as sw
from stairwright.cli import main

if TYPE_CHECKING:
    from tests.conftest import Server

CURB = {"points": [[-1.2, 0.0], [0.0, 0.0], [0.0, 0.05], [1.2, 0.05]]}
DROP = {"points": [[-1.2, 0.25], [0.0, 0.25], [0.0, 0.0], [1.2, 0.0]]}


@pytest.fixture
def api(server: Server) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=60) as client:
        yield client


@pytest.mark.slow
@pytest.mark.parametrize("facing", ["forward", "backward"])
def test_the_robot_of_a_plan_is_told_as_its_file_has_it(api: httpx.Client, facing: str) -> None:
    robot = api.get("/robots/go2w").json()
    del robot["readonly"], robot["version"]
    robot["calf"]["length"] += 0.01
    question = {"terrain": CURB, "robot": robot, "facing": facing}
    plan = api.post("/plans", json=question).json()
    assert plan["facing"] == facing
    assert api.get(f"/plans/{plan['id']}/robot").json() == robot
    assert api.get("/plans/p-none/robot").status_code == 404


@pytest.mark.slow
def test_a_backward_plan_is_that_of_python(server: Server, api: httpx.Client) -> None:
    own = sw.plan(CURB, facing="backward")
    with sw.Client(server.url) as service:
        plan = service.plan(CURB, facing="backward")
        job = api.post("/rollouts", json={"terrain": CURB, "facing": "backward"}).json()
        run = service.result(service.wait(job["id"]))
    assert (plan.id, plan.facing, plan.poses) == (own.id, "backward", own.poses)
    assert (run.plan_id, run.outcome) == (own.id, "success")
    listed = {entry["id"]: entry["summary"] for entry in api.get("/plans").json()}
    assert listed[plan.id]["facing"] == "backward"


@pytest.mark.slow
def test_the_service_is_asked_for_either_end(server: Server) -> None:
    own = sw.plan(DROP, facing="backward", timing="fast")
    with sw.Client(server.url) as service:
        usual, either, backward = (
            service.plan(DROP, timing="fast", facing=end) for end in (None, "either", "backward")
        )
        forward, safer = (service.plan(ground, facing="either") for ground in (CURB, DROP))
        thin = service.plan(DROP)
        again = service.get_plan(either.id)
    assert {plan.id for plan in (usual, either, backward)} == {own.id}
    assert {plan.facing for plan in (usual, either, backward, again)} == {"backward"}
    assert (forward.facing, safer.facing, thin.facing) == ("forward", "backward", "forward")
    assert thin.safer_facing is not None
    assert thin.safer_facing.facing == "backward"


def test_a_way_that_is_none_is_told_by_its_field(api: httpx.Client) -> None:
    answer = api.post("/plans", json={"terrain": CURB, "facing": "sideways"})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == "facing"


def test_the_command_line_asks_for_it_and_tells(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    terrain, out = tmp_path / "curb.json", tmp_path / "plan.json"
    terrain.write_text(json.dumps(CURB))
    assert main(["plan", str(terrain), "--facing", "backward", "-o", str(out)]) == 0
    assert json.loads(out.read_text())["id"] == sw.plan(CURB, facing="backward").id
    assert main(["plan", str(terrain), "--facing", "backward"]) == 0
    assert "a1_wheeled, facing backward" in capsys.readouterr().out
    terrain.write_text(json.dumps(DROP))
    assert main(["plan", str(terrain)]) == 0
    assert re.search(r"safer +facing backward: CoM \d+ mm", capsys.readouterr().out)
    assert main(["plan", str(terrain), "--timing", "fast", "-o", str(out)]) == 0
    assert json.loads(out.read_text())["facing"] == "backward"
