"""Robots over REST, on the running server: saved, listed, used, imported."""

from __future__ import annotations

import io
import zipfile
from urllib.parse import quote

import httpx
import pytest

import stairwright as sw
from stairwright.library import robots
from tests.conftest import Server
from tests.robot.importing.files import Design
from tests.robot.importing.written import mjcf, urdf

CURB = {"points": [[-1.0, 0], [0, 0], [0, 0.03], [1, 0.03]]}
BOMB = '<!DOCTYPE a [<!ENTITY b "cccccccc">]><robot name="&b;"/>'


@pytest.fixture(scope="module")
def mine() -> dict[str, object]:
    """A robot of one's own: the A1 with longer legs."""
    document = sw.load_robot("a1_wheeled").model_dump(mode="json")
    return document | {"name": "mine", "thigh": document["thigh"] | {"length": 0.22}}


def sent(api: httpx.Client, name: str, content: str | bytes, **fields: object) -> httpx.Response:
    data = content.encode() if isinstance(content, str) else content
    return api.post("/robots/import", files={"file": (name, data)}, data=fields)


def test_presets_come_first_and_are_read_only(api: httpx.Client, mine: dict[str, object]) -> None:
    listed = api.get("/robots").json()
    assert [each["name"] for each in listed][: len(robots())] == robots()
    assert all(each["readonly"] for each in listed[: len(robots())])
    assert api.get("/robots/a1_wheeled").json() in listed
    for answer in (
        api.put("/robots/a1_wheeled", json=mine | {"name": "a1_wheeled"}),
        api.delete("/robots/a1_wheeled"),
    ):
        assert answer.status_code == 403
        assert answer.headers["content-type"] == "application/problem+json"
    assert "cannot be deleted" in answer.json()["detail"]


def test_a_robot_is_saved_used_changed_and_deleted(
    api: httpx.Client, mine: dict[str, object]
) -> None:
    made = api.put("/robots/mine", json=mine)
    assert made.status_code == 201, made.text
    assert made.headers["location"] == "/api/v1/robots/mine"
    document = made.json()
    assert document["readonly"] is False
    assert document["version"] == sw.Robot.model_validate(mine).hash
    assert api.put("/robots/mine", json=document).status_code == 200  # as it was got
    assert "mine" in [each["name"] for each in api.get("/robots").json()]
    by_name = api.post("/plans", json={"terrain": CURB, "robot": "mine"}).json()
    assert by_name["robot"] == "mine"
    assert by_name["robot_hash"] == document["version"]
    by_document = api.post("/plans", json={"terrain": CURB, "robot": document}).json()
    assert by_document["id"] == by_name["id"]
    heavier = mine | {"trunk": mine["trunk"] | {"mass": 9.0}}  # type: ignore[operator]
    assert api.put("/robots/mine", json=heavier).json()["version"] != document["version"]
    other = api.put("/robots/other", json=document)
    assert other.status_code == 422
    assert other.json()["errors"][0]["field"] == "name"
    assert api.delete("/robots/mine").status_code == 204
    assert api.get("/robots/mine").status_code == 404
    assert api.delete("/robots/mine").status_code == 404
    unknown = api.post("/plans", json={"terrain": CURB, "robot": "mine"})
    assert unknown.status_code == 422
    assert unknown.json()["errors"][0]["field"] == "robot"


def test_a_bad_robot_is_refused_by_the_field(api: httpx.Client, mine: dict[str, object]) -> None:
    answer = api.put("/robots/mine", json=mine | {"nominal_height": 3.0})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == "nominal_height"


def test_a_name_in_any_script_is_saved_and_exported(
    api: httpx.Client, mine: dict[str, object]
) -> None:
    name = "機械 ä"
    assert api.put(f"/robots/{quote(name)}", json=mine | {"name": name}).status_code == 201
    for form in ("yaml", "json", "urdf", "mjcf"):
        file = api.get(f"/robots/{quote(name)}/export", params={"format": form})
        assert file.status_code == 200, file.text
        assert quote(name, safe="") in file.headers["content-disposition"]
    assert api.delete(f"/robots/{quote(name)}").status_code == 204


@pytest.mark.parametrize(("name", "write"), [("a.urdf", urdf), ("a.xml", mjcf)])
def test_an_import_answers_robot_and_remarks(api: httpx.Client, name: str, write) -> None:
    answer = sent(api, name, write(Design()))
    assert answer.status_code == 200, answer.text
    report = answer.json()
    assert {"robot", "assumed", "warnings"} <= report.keys()
    assert report["robot"]["wheel"]["radius"] == pytest.approx(0.08)
    assert report["joints"]["FL_thigh"]["name"] == "FL_thigh_joint"
    kept = report["robot"] | {"name": "imported one"}
    assert api.put("/robots/imported one", json=kept).status_code == 201
    assert api.delete("/robots/imported one").status_code == 204


def test_a_zip_is_read_with_its_meshes(api: httpx.Client) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("maker/urdf/robot.urdf", urdf(Design()))
    answer = sent(api, "maker.zip", packed.getvalue(), abduction="0.05")
    assert answer.status_code == 200, answer.text
    assert answer.json()["robot"]["abduction"] == 0.05


@pytest.mark.parametrize(
    ("name", "content", "fields"),
    [
        ("a.urdf", BOMB, {}),
        ("a.xml", "<mujoco><worldbody><include file='/etc/passwd'/></worldbody></mujoco>", {}),
        ("a.xml", "<mujoco><worldbody><body><geom size='1'/></body></worldbody></mujoco>", {}),
        ("a.zip", b"PK\x03\x04nothing", {}),
        ("a.txt", "hello", {}),
        ("", "", {}),
        ("a.urdf", urdf(Design()), {"abduction": "nan"}),
        ("a.urdf", urdf(Design()), {"abduction": "1.0"}),
        ("a.urdf", urdf(Design()), {"wheel_radius": "-1"}),
        ("a.urdf", urdf(Design()), {"hold": "FL_hip_joint"}),
        ("a.urdf", urdf(Design()), {"hold": "nobody=0"}),
    ],
)
def test_what_is_no_robot_is_refused(
    api: httpx.Client, name: str, content: str | bytes, fields: dict[str, str]
) -> None:
    answer = sent(api, name, content, **fields)
    assert answer.status_code == 422, answer.text
    field = answer.json()["errors"][0]["field"]
    assert field in {"file", *fields}
    assert "passwd" not in answer.text or "not sent" in answer.text


def test_the_client_reads_and_saves_robots(server: Server, tmp_path) -> None:
    file = tmp_path / "a.urdf"
    file.write_text(urdf(Design()))
    with sw.Client(server.url) as client:
        hips = {f"{leg}_hip_joint": 0.0 for leg in ("FL", "FR", "RL", "RR")}
        assert client.import_robot(file, hold=hips).robot.held_joints == hips
        made = client.import_robot(file)
        robot = made.robot.model_copy(update={"name": "by the client"})
        assert client.save_robot(robot) == robot
        assert client.robot("by the client") == robot
        assert robot in client.robots()
        client.delete_robot("by the client")
