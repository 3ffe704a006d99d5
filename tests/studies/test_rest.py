"""Studies over REST: started, followed, cancelled, gone on with, taken along."""

from __future__ import annotations

import io
import json
import signal
import time
import zipfile
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import httpx
import pytest
import xarray as xr

import stairwright as sw
from stairwright.studies.writer import WRITE_EVERY
from tests.conftest import Server
from tests.in_process import served

from .small import STEP, identical, study
from .test_designs_rest import LONG as SEARCH

pytestmark = pytest.mark.slow  # a server of its own

ENDED = ("done", "failed", "cancelled")
LONG = study(
    {"name": "stairs.rise", "from": 0.05, "to": 0.5, "count": 60},
    {"name": "stairs.run", "from": 0.22, "to": 0.4, "count": 20},
)


def _wait(api: httpx.Client, name: str, until: tuple[str, ...] = ENDED) -> dict[str, Any]:
    for _ in range(600):
        state: dict[str, Any] = api.get(f"/studies/{name}").json()
        if state["state"] in until:
            return state
        time.sleep(0.1)
    raise AssertionError(state)


def _events(api: httpx.Client, name: str) -> list[tuple[str, dict[str, Any]]]:
    out = []
    with api.stream("GET", f"/studies/{name}/events") as stream:
        event = ""
        for line in stream.iter_lines():
            if line.startswith("event: "):
                event = line[7:]
            elif line.startswith("data: "):
                out.append((event, json.loads(line[6:])))
    return out


@pytest.fixture(scope="module")
def done(api: httpx.Client) -> dict[str, Any]:
    """A small study, followed to its end."""
    answer = api.post("/studies", json=STEP)
    assert answer.status_code == 202, answer.text
    posted = answer.json()
    assert answer.headers["location"] == f"/api/v1/studies/{posted['id']}"
    events = _events(api, posted["id"])
    cells = [cell for kind, data in events if kind == "cells" for cell in data["cell"]]
    assert sorted(cells) == list(range(6))
    states = [data for kind, data in events if kind == "study"]
    assert states[-1]["state"] == "done"
    assert [each["done"] for each in states] == sorted(each["done"] for each in states)
    return _wait(api, posted["id"])


def test_its_state_tells_the_axes(done: dict[str, Any]) -> None:
    assert (done["done"], done["total"], done["progress"]) == (6, 6, 1.0)
    assert done["axes"][0] == {
        "name": "step.height", "unit": "m", "values": [0.05, 0.3, 1.2], "boundary": False
    }  # fmt: skip
    assert not done["outdated"]


def test_the_same_document_is_the_same_study(api: httpx.Client, done: dict[str, Any]) -> None:
    begun = time.monotonic()
    again = api.post("/studies", json=STEP | {"name": "by another name"}).json()
    assert (again["id"], again["state"]) == (done["id"], "done")
    document = api.get(f"/studies/{done['id']}/document").json()
    assert api.post("/studies", json=document).json()["id"] == done["id"]
    assert time.monotonic() - begun < 2.0
    assert done["id"] in [each["id"] for each in api.get("/studies").json()]


def test_files_hold_what_python_computes(
    api: httpx.Client, done: dict[str, Any], tmp_path: Path
) -> None:
    truth = sw.study(STEP, workers=1, store=tmp_path / "t.zarr").dataset
    link = f"/studies/{done['id']}/export"
    (tmp_path / "a.nc").write_bytes(api.get(link).content)
    assert xr.open_dataset(tmp_path / "a.nc").load().equals(truth)
    packed = zipfile.ZipFile(io.BytesIO(api.get(link, params={"format": "zarr"}).content))
    packed.extractall(tmp_path / "a.zarr")
    unpacked = xr.open_zarr(tmp_path / "a.zarr", consolidated=False).load()
    assert identical(unpacked[list(truth.data_vars)], truth)
    table = api.get(link, params={"format": "csv"})
    assert table.headers["content-type"] == "text/csv; charset=utf-8"
    assert len(table.text.splitlines()) == 7
    block = api.get(f"/studies/{done['id']}/cells").json()
    assert block["plan_id"] == truth.plan_id.values.ravel().tolist()
    assert block["margin_com"][-1] is None  # a step of 1.2 m
    kinds = [kind for kind, _ in _events(api, done["id"])]
    assert list(dict.fromkeys(kinds)) == ["cells", "study"]  # in one block or several


def test_a_cell_opens_as_a_plan(api: httpx.Client, done: dict[str, Any]) -> None:
    cell = api.get(f"/studies/{done['id']}/cells/3").json()
    assert cell["values"] == {"step.height": 0.3, "friction": 0.6}
    plan = api.post("/plans", json=cell["plan"]).json()
    assert plan["id"] == cell["record"]["plan_id"]
    assert api.get(f"/studies/{done['id']}/cells/6").status_code == 404


@pytest.mark.parametrize(
    ("document", "field"),
    [
        (study({"name": "friction", "from": 0.1, "to": 1, "count": 2001}, STEP["axes"][0]), "axes"),
        (study(*({"name": f"w.{i}", "values": [1]} for i in range(1000))), "axes"),
        (study({"name": "step.height", "values": ["NaN"]}), "axes.0.values"),
        (study({"name": "__class__", "values": [1]}), "axes.0.name"),
        (study(STEP["axes"][0], terrain="../../etc/passwd"), "terrain"),
        (study(STEP["axes"][0], robot="no such robot"), "robot"),
        (study(STEP["axes"][0], path="/tmp/x"), "path"),
        (study(STEP["axes"][0], controller={"form": {"a": [1] * 1000}}), "controller"),
        ({"axes": {"a": 1}}, "axes"),
    ],
)  # fmt: skip
def test_hostile_documents_are_refused_at_once(
    api: httpx.Client, document: dict[str, Any], field: str
) -> None:
    begun = time.monotonic()
    answer = api.post("/studies", json=document)
    assert time.monotonic() - begun < 1.0
    assert answer.status_code == 422, answer.text
    assert answer.json()["errors"][0]["field"].startswith(field), answer.text


def test_the_least_cells_that_are_too_many_are_refused_in_words(api: httpx.Client) -> None:
    axes = [
        {"name": name, "from": 0.1, "to": 0.9, "count": 10_000}
        for name in ("stairs.rise", "stairs.run", "friction")
    ]
    answer = api.post("/studies", json=study(*axes))
    assert answer.status_code == 422
    assert "1,000,000,000,000 cells" in answer.json()["detail"]
    raw = '{"axes": [{"name": "step.height", "values": [NaN]}]}'
    answer = api.post("/studies", content=raw, headers={"content-type": "application/json"})
    assert answer.status_code in (400, 422)


def test_cancelled_and_gone_on_with(api: httpx.Client) -> None:
    name = api.post("/studies", json=LONG).json()["id"]
    while api.get(f"/studies/{name}").json()["done"] < 5:
        time.sleep(0.1)
    assert api.post(f"/studies/{name}/cancel").json()["state"] == "cancelled"
    kept = 0
    while kept < 5:  # they are written down once the batches at work are done
        time.sleep(0.1)
        kept = len(api.get(f"/studies/{name}/cells").json()["cell"])
    assert kept < 1200
    again = api.post("/studies", json=LONG).json()
    assert (again["id"], again["state"]) == (name, "queued")
    while (state := api.get(f"/studies/{name}").json())["state"] != "running" or (
        state["done"] <= kept or state["eta"] is None  # its pace is known after its first batch
    ):
        time.sleep(0.1)
    assert state["eta"] > 0.0
    plan = api.post("/plans", json={"terrain": "curb-015"})  # plans do not wait meanwhile
    assert plan.status_code == 200
    assert api.delete(f"/studies/{name}").status_code == 204
    assert api.get(f"/studies/{name}").status_code == 404


def test_without_the_packages_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from stairwright.api.app import create_app
    from stairwright.api.settings import Settings
    from stairwright.studies import packages

    monkeypatch.setattr(packages, "find_spec", lambda name: None if name == "zarr" else 1)
    app = create_app(Settings(data=tmp_path))
    with served(app) as (_, port):
        answer = httpx.post(f"http://127.0.0.1:{port}/api/v1/studies", json=STEP)
    assert answer.status_code == 501
    assert "./dev studies" in answer.json()["detail"]
    assert "not there: zarr" in answer.json()["detail"]


def test_the_server_is_killed_and_the_study_and_what_waits_for_it_go_on(
    start_server: Callable[..., AbstractContextManager[Server]],
) -> None:
    variables = {"STAIRWRIGHT_STUDY_WORKERS": "1"}
    with start_server(**variables) as server:
        api = httpx.Client(base_url=f"{server.url}/api/v1", timeout=60)
        name = api.post("/studies", json=LONG).json()["id"]
        waiting = api.post("/designs", json=SEARCH).json()["id"]
        while (before := api.get(f"/studies/{name}").json()["done"]) < 10:
            time.sleep(0.1)
        time.sleep(WRITE_EVERY)
        seen = api.get(f"/studies/{name}").json()["done"]
        while api.get(f"/studies/{name}").json()["done"] == seen:  # what comes now takes it along
            time.sleep(0.1)
        server.process.send_signal(signal.SIGKILL)
        server.process.wait()
    time.sleep(1.0)
    with start_server(**variables) as server:
        api = httpx.Client(base_url=f"{server.url}/api/v1", timeout=60)
        while (state := api.get(f"/studies/{name}").json())["done"] == 0:
            time.sleep(0.05)
        assert state["done"] >= before
        _kill_runner(server)
        seen = state["done"]
        while (state := api.get(f"/studies/{name}").json())["done"] <= seen + 10:
            assert state["state"] in ("queued", "running")
            time.sleep(0.1)
        cells = api.get(f"/studies/{name}/cells").json()["cell"]
        assert len(cells) == len(set(cells))
        # What waited behind it was not forgotten, and is carried out when it is its turn.
        assert api.get(f"/designs/{waiting}").json()["state"] == "queued"
        api.post(f"/studies/{name}/cancel")
        while (now := api.get(f"/designs/{waiting}").json()["state"]) != "running":
            assert now == "queued"
            time.sleep(0.1)


def _kill_runner(server: Server) -> None:
    import psutil

    children = psutil.Process(server.process.pid).children()
    runner = next(each for each in children if "stairwright.studies.runner" in each.cmdline())
    runner.kill()
