"""Exports over REST: every format of every kind, derived from one table."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import httpx
import numpy as np
import pytest

from stairwright.api.described import ANY_FILE
from stairwright.client import Client, ServiceError
from stairwright.export.table import FORMATS, ROBOT_FORMATS
from stairwright.library import load_robot, robots
from tests.conftest import Server
from tests.export.mcap_reading import messages
from tests.export.ros2_control import times

CURB = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
ROUTES = {
    "plan": "/api/v1/plans/{plan_id}/export",
    "rollout": "/api/v1/rollouts/{rollout_id}/export",
    "robot": "/api/v1/robots/{name}/export",
}


@pytest.fixture(scope="module")
def plan(api: httpx.Client) -> str:
    return str(api.post("/plans", json={"terrain": CURB, "method": "critical"}).json()["id"])


@pytest.mark.parametrize("kind", FORMATS)
def test_the_interface_lists_the_tables_formats(api: httpx.Client, kind: str) -> None:
    document = api.get("/openapi.json").json()
    call = document["paths"][ROUTES[kind]]["get"]
    (chosen,) = [each for each in call["parameters"] if each["name"] == "format"]
    assert chosen["schema"]["enum"] == list(FORMATS[kind])
    types = {each.media_type.split(";")[0] for each in FORMATS[kind].values()}
    assert set(call["responses"]["200"]["content"]) == types | {ANY_FILE}
    shown = api.get("/settings").json()["exports"][kind]
    assert [each["name"] for each in shown] == list(FORMATS[kind])
    assert all(each["note"] for each in shown)


@pytest.mark.parametrize("name", robots())
def test_robots_as_files(api: httpx.Client, name: str) -> None:
    for form, known in ROBOT_FORMATS.items():
        answer = api.get(f"/robots/{name}/export", params={"format": form})
        assert answer.status_code == 200, answer.text
        assert answer.headers["content-type"] == known.media_type
        assert f'"{name}{known.suffix}"' in answer.headers["content-disposition"]
        assert answer.content.strip() == known.write(load_robot(name)).strip()
        again = api.get(
            f"/robots/{name}/export",
            params={"format": form},
            headers={"if-none-match": answer.headers["etag"]},
        )
        assert again.status_code == 304
    assert ET.fromstring(api.get(f"/robots/{name}/export").content).tag == "robot"  # urdf


@pytest.mark.slow
def test_a_plans_commands_at_the_rate_that_is_asked_for(api: httpx.Client, plan: str) -> None:
    etags = set()
    for rate in (None, 50.0, 200.0):
        params = {"format": "mcap"} | ({} if rate is None else {"rate": rate})
        answer = api.get(f"/plans/{plan}/export", params=params)
        assert answer.status_code == 200, answer.text
        ((_, legs),) = messages(answer.content)["/joint_trajectory"]
        np.testing.assert_allclose(np.diff(times(legs)), 1 / (rate or 100.0), atol=2e-9)
        etags.add(answer.headers["etag"])
    assert len(etags) == 3


@pytest.mark.parametrize(
    ("query", "field"),
    [
        ("format=mcap&rate=5", "rate"),
        ("format=mcap&rate=1e9", "rate"),
        ("format=mcap&rate=nan", "rate"),
        ("format=mcap&rate=fast", "rate"),
        ("format=csv&rate=50", "rate"),
        ("rate=50", "rate"),
        ("format=html", "format"),
        ("format=", "format"),
    ],
)
def test_what_there_is_not_is_named(api: httpx.Client, plan: str, query: str, field: str) -> None:
    answer = api.get(f"/plans/{plan}/export?{query}")
    assert answer.status_code == 422, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert field in answer.json()["detail"]


def test_robots_that_there_are_not(api: httpx.Client) -> None:
    assert api.get("/robots/nobody/export").status_code == 404
    assert api.get("/robots/a1_wheeled/export?format=csv").status_code == 422


def test_the_client_fetches_them(server: Server, plan: str) -> None:
    with Client(server.url) as client:
        assert client.export_robot("a1_wheeled", "urdf").startswith(b"<?xml")
        content = client.export_plan(plan, "mcap", rate=20.0)
        ((_, legs),) = messages(content)["/joint_trajectory"]
        assert np.diff(times(legs)).max() == pytest.approx(0.05)
        with pytest.raises(ServiceError, match="rate"):
            client.export_plan(plan, "npz", rate=20.0)
