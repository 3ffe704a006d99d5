"""Terrains and robots over REST, on the running server."""

from __future__ import annotations

import math
from urllib.parse import quote, unquote

import httpx
import numpy as np
import pytest
import trimesh

from stairwright.library import robots, terrains

STAIR = {"points": [[-1.5, 0], [0, 0], [0, 0.2], [2, 0.2]], "friction": 0.8}


def test_presets_are_listed_first_and_read_only(api: httpx.Client) -> None:
    listed = api.get("/terrains").json()
    assert [each["name"] for each in listed][: len(terrains())] == terrains()
    assert all(each["readonly"] for each in listed[: len(terrains())])
    name = terrains()[0]
    assert api.get(f"/terrains/{name}").json() == listed[0]
    for answer in (api.put(f"/terrains/{name}", json=STAIR), api.delete(f"/terrains/{name}")):
        assert answer.status_code == 403
        assert answer.headers["content-type"] == "application/problem+json"
    assert "cannot be deleted" in answer.json()["detail"]


def test_a_terrain_is_saved_changed_and_deleted(api: httpx.Client) -> None:
    made = api.put("/terrains/my stair", json=STAIR)
    assert made.status_code == 201
    assert made.json()["name"] == "my stair"
    assert made.json()["readonly"] is False
    assert api.put("/terrains/my stair", json=made.json()).status_code == 200  # as it was got
    assert "my stair" in [each["name"] for each in api.get("/terrains").json()]
    other = api.put("/terrains/other", json=made.json())
    assert other.status_code == 422
    assert other.json()["errors"][0]["field"] == "name"
    assert api.delete("/terrains/my stair").status_code == 204
    assert api.get("/terrains/my stair").status_code == 404
    assert api.delete("/terrains/my stair").status_code == 404


@pytest.mark.parametrize("name", ["階段", "Stufe ä", "ends in a space ", "a+b.c"])
def test_a_name_in_any_script_can_be_saved_and_found(api: httpx.Client, name: str) -> None:
    made = api.put(f"/terrains/{quote(name)}", json=STAIR)
    assert made.status_code == 201
    assert unquote(made.headers["location"]) == f"/api/v1/terrains/{name}"
    found = api.get(made.headers["location"].removeprefix("/api/v1"))
    assert found.json() == made.json()
    assert api.delete(f"/terrains/{quote(name)}").status_code == 204


def test_pages_and_entity_tags(api: httpx.Client) -> None:
    first = api.get("/terrains", params={"limit": 2})
    assert len(first.json()) == 2
    assert int(first.headers["x-total-count"]) >= len(terrains())
    following = api.get(first.links["next"]["url"].removeprefix("/api/v1"))
    assert following.json()[0]["name"] == terrains()[2]
    tag = first.headers["etag"]
    again = api.get("/terrains", params={"limit": 2}, headers={"if-none-match": tag})
    assert again.status_code == 304
    assert again.content == b""


def test_robots(api: httpx.Client) -> None:
    assert [each["name"] for each in api.get("/robots").json()] == robots()
    assert api.get("/robots/a1_wheeled").json()["schema"] == "stairwright/robot/1"
    assert api.get("/robots/nobody").status_code == 404


def test_settings_describe_every_slider(api: httpx.Client) -> None:
    settings = api.get("/settings").json()
    assert set(settings["weights"]) == {"path", "critical", "nominal"}
    for group in (*settings["weights"].values(), settings["controller"]):
        for name, each in group["properties"].items():
            assert each["title"], name
            assert each["description"], name
            if "enum" not in each and each["type"] != "boolean":
                assert each["minimum"] < each["maximum"], name
                assert {"unit", "scale"} <= set(each), name


def test_generators(api: httpx.Client) -> None:
    stair = api.post("/terrains/generate", json={"kind": "stair", "rise": 0.18, "count": 5})
    assert max(z for _, z in stair.json()["points"]) == pytest.approx(0.9)
    ramp = api.post(
        "/terrains/generate", json={"kind": "ramp", "rise": 0.25, "slope": math.radians(30)}
    )
    assert len(ramp.json()["points"]) == 4
    flat = api.post("/terrains/generate", json={"kind": "flat", "length": 3})
    assert flat.json()["points"] == [[-1.5, 0.0], [1.5, 0.0]]


@pytest.mark.parametrize(
    ("body", "field"),
    [
        ({}, "kind"),
        ({"kind": "hill"}, "kind"),
        ({"kind": "stair"}, "rise"),
        ({"kind": "stair", "rise": 0.2, "count": 0}, "count"),
        ({"kind": "stair", "rise": 9, "count": 200}, "count"),
        ({"kind": "ramp", "rise": 50, "slope": 0.01}, "rise"),
        ({"kind": "flat", "slope": 1}, "slope"),
    ],
)
def test_a_generator_names_the_bad_measure(
    api: httpx.Client, body: dict[str, object], field: str
) -> None:
    answer = api.post("/terrains/generate", json=body)
    assert answer.status_code == 422, answer.text
    assert answer.json()["errors"][0]["field"] == field


def stair_mesh() -> trimesh.Trimesh:
    low = trimesh.creation.box(bounds=[[-2, -1, -0.1], [0, 1, 0]])
    high = trimesh.creation.box(bounds=[[0, -1, -0.1], [2, 1, 0.2]])
    return trimesh.util.concatenate([low, high])


@pytest.mark.parametrize("kind", ["stl", "obj", "ply", "off"])
def test_a_mesh_is_cut_into_its_profile(api: httpx.Client, kind: str) -> None:
    content = stair_mesh().export(file_type=kind)
    data = content.encode() if isinstance(content, str) else content
    answer = api.post("/terrains/import", files={"file": (f"hall.{kind}", data)}, data={"y": "0.1"})
    assert answer.status_code == 200, answer.text
    terrain = answer.json()
    assert terrain["name"] == "hall"
    assert np.ptp(np.array(terrain["points"])[:, 1]) == pytest.approx(0.2, abs=1e-3)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("t.csv", b"x,z\n0,0\n1,0\n1,0.2\n3,0.2\n"),
        ("t.json", b'{"points": [[0,0],[1,0],[1,0.2],[3,0.2]]}'),
        ("t.yaml", b"points: [[0,0],[1,0],[1,0.2],[3,0.2]]\n"),
    ],
)
def test_text_files_are_imported(api: httpx.Client, name: str, content: bytes) -> None:
    answer = api.post("/terrains/import", files={"file": (name, content)}, data={"friction": "0.5"})
    assert answer.status_code == 200, answer.text
    assert answer.json()["points"] == [[0, 0], [1, 0], [1, 0.2], [3, 0.2]]
    assert answer.json()["friction"] == 0.5


@pytest.mark.parametrize(
    ("name", "content", "status"),
    [
        ("t.exe", b"MZ", 422),
        ("t", b"x", 422),
        ("t.csv", b"x,z\n0,0\nhello,world\n", 422),
        ("t.yaml", b"points: &a [[0,0],[1,0]]\nname: *a\n", 422),
        ("t.yaml", b"name: 2001-13-45\n", 422),
        ("t.json", b"[" * 100_000, 422),
        ("t.json", b'{"points": [[0,0],[1,NaN]]}', 422),
        ("t.stl", b"solid \xff\xfe garbage", 422),
        ("t.obj", b"v 0 0 nan\nf 1 1 1\nmtllib /etc/passwd\n", 422),
    ],
)
def test_bad_files_are_refused(api: httpx.Client, name: str, content: bytes, status: int) -> None:
    answer = api.post("/terrains/import", files={"file": (name, content)})
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
