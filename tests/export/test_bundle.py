"""What a robot's computer is given: complete, readable, and the same for the same plan."""

from __future__ import annotations

import io
import json
import xml.etree.ElementTree as ET
import zipfile
from functools import cache

import numpy as np
import pytest

import stairwright as sw
from stairwright import _core
from stairwright.errors import InputError
from stairwright.export.formats import PLAN_FORMATS
from stairwright.export.player_plan import player_plan
from stairwright.planning.plan import Plan
from stairwright.robot.description import JOINTS
from tests.scene.example import example_plan

CURB = {"points": [[-1.3, 0], [0, 0], [0, 0.05], [1.3, 0.05]]}
FRAMES = {"FR_thigh": {"sign": -1}, "RL_calf": {"sign": 1, "offset": -0.4}}


@cache
def curb() -> Plan:
    robot = sw.load_robot("go2w").model_dump(mode="json", by_alias=True)
    robot |= {"joint_frames": FRAMES, "joint_names": {"FR_thigh": "right_hip"}, "abduction": 0.1}
    return sw.plan(CURB, robot, friction=0.6)


def lines(key: str) -> list[list[str]]:
    found = (line.split() for line in player_plan(curb()).splitlines())
    return [words[1:] for words in found if words and words[0] == key]


def test_a_bundle_holds_plan_robot_player_and_words(tmp_path):
    curb().save(str(tmp_path / "curb.zip"))
    content = (tmp_path / "curb.zip").read_bytes()
    assert content == PLAN_FORMATS["bundle"].write(curb())
    archive = zipfile.ZipFile(io.BytesIO(content))
    names = {name.removeprefix("stairwright-go2w/") for name in archive.namelist()}
    assert {"README.md", "plan.txt", "plan.json", "robot.urdf", "native/CMakeLists.txt"} <= names
    assert {"native/player/main.cpp", "native/ros2/package.xml"} <= names
    assert not [name for name in names if "rollout" in name or "python" in name]
    read = {name: archive.read(f"stairwright-go2w/{name}").decode() for name in names}
    assert json.loads(read["plan.json"])["id"] == curb().id
    assert ET.fromstring(read["robot.urdf"]).get("name") == "go2w"
    assert read["plan.txt"] == player_plan(curb())
    assert "$" not in read["README.md"]
    assert f"x = {curb().poses[0].wheels[0][0]:.3f} m" in read["README.md"]


def test_all_that_the_player_includes_is_there():
    archive = zipfile.ZipFile(io.BytesIO(PLAN_FORMATS["bundle"].write(curb())))
    names = set(archive.namelist())
    for name in names:
        if name.endswith((".cpp", ".hpp")):
            for line in archive.read(name).decode().splitlines():
                if line.startswith('#include "stairwright/'):
                    header = line.split('"')[1]
                    assert f"stairwright-go2w/native/include/{header}" in names, (name, header)


def test_motors_are_numbered_and_counted_as_the_robot_does():
    roles = {int(number): role for number, *role in lines("motor")}
    assert list(roles) == list(range(16))
    assert roles[0] == ["FR_hip", "hold", "-0.1"]  # outward is to the right
    assert roles[3] == ["FL_hip", "hold", "0.1"]
    assert roles[1] == ["right_hip", "drive", str(JOINTS.index("FR_thigh")), "-1", "0"]
    assert roles[11] == ["RL_calf", "drive", str(JOINTS.index("RL_calf")), "1", "-0.4"]
    assert [roles[k][0] for k in range(12, 16)] == ["FR_wheel", "FL_wheel", "RR_wheel", "RL_wheel"]


def test_the_course_is_the_plans():
    rows = np.array(lines("row"), float)
    assert rows.shape[1] == 42
    first, last = curb().poses[0], curb().poses[-1]
    np.testing.assert_allclose(rows[0, 3:7], first.q, atol=1e-8)
    np.testing.assert_allclose(rows[-1, 10:12], [last.x_c, last.z_c], atol=1e-8)
    np.testing.assert_allclose(np.array(lines("vertex"), float), CURB["points"])


def test_an_infeasible_plan_has_no_bundle():
    """Not even where it has poses, which a simulated robot may try."""
    for count in (0, 4):
        plan = example_plan(count=4, problem=True).model_copy(update={"method": "critical"})
        plan = plan if count else plan.model_copy(update={"poses": [], "critical": []})
        assert plan.executable == (count > 0)
        with pytest.raises(InputError, match="not for a robot"):
            PLAN_FORMATS["bundle"].write(plan)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text.replace("player 1", "player 2"), "line 1"),
        (lambda text: text.replace("friction 0.6", "friction nan"), "friction takes 1 number"),
        (lambda text: text.replace("trunk ", "trunk 1 "), "trunk takes 4 numbers"),
        (lambda text: text + "frictoin 1\n", "unknown: frictoin"),
        (lambda text: text + "friction 0.5\n", "a second friction"),
        (lambda text: text.replace("motor 0 FR_hip hold -0.1\n", ""), None),
        (lambda text: text.replace(" drive 0 ", " drive 3 "), "drive takes a joint of its own"),
        (lambda text: text.replace("motor 12 ", "motor 13 "), "a number of its own"),
        (lambda text: "\n".join(x for x in text.splitlines() if not x.startswith("row")), "row"),
    ],
)
def test_a_plan_file_that_is_not_one_is_refused_with_its_line(change, words):
    text = change(player_plan(curb()))
    if words is None:  # a robot without an abduction motor
        assert _core.Player(text).phase == "waiting"
        return
    with pytest.raises(RuntimeError, match=words):
        _core.Player(text)
