"""Joints that do not move in the side view, or that the user wants rigid."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

import numpy as np
import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.robot.importing.holding import written_hold
from stairwright.robot.importing.read import read
from stairwright.robot.importing.report import Imported
from stairwright.robot.importing.upload import Upload
from tests.robot.importing.files import LEGS, Design
from tests.robot.importing.written import ANKLES, BELOW, hinge, link, urdf, with_ankles


def imported(text: str, hold: Mapping[str, float] | None = None) -> Imported:
    return read(Upload("a.urdf", text.encode()), {"hold": hold})


def refused(text: str, hold: Mapping[str, float] | None = None) -> str:
    with pytest.raises(InputError) as caught:
        imported(text, hold)
    return str(caught.value)


@pytest.mark.parametrize("axis", ["0 0 1", "1 0 0"], ids=["steering", "camber"])
def test_joints_that_turn_wheels_out_of_the_side_view_are_held(axis: str) -> None:
    made, plain = imported(with_ankles(axis)), imported(urdf(Design())).robot
    assert {name: made.locked[name] for name in ANKLES} == dict.fromkeys(ANKLES, 0.0)
    assert any("FL_ankle_joint 0, FR_ankle_joint 0" in each for each in made.assumed)
    assert made.robot.mass == pytest.approx(plain.mass + 0.4)
    assert made.robot.calf.length == pytest.approx(plain.calf.length)
    assert made.robot.hips == plain.hips


def test_of_three_joints_in_the_side_view_the_user_says_which_is_rigid() -> None:
    text, straight = with_ankles("0 1 0"), imported(urdf(Design())).robot.calf.length
    message = refused(text)
    assert message.startswith("file: 'FL_ankle_joint': one joint too many")
    assert "FL_thigh_joint, FL_calf_joint, FL_ankle_joint" in message
    assert "hold one in each leg, for instance FL_ankle_joint=0.3" in message
    bent = imported(text, dict.fromkeys(ANKLES, 0.5))
    length = math.hypot(straight - BELOW + BELOW * math.cos(0.5), BELOW * math.sin(0.5))
    assert bent.robot.calf.length == pytest.approx(length, abs=1e-4)
    assert bent.robot.held_joints == dict.fromkeys(ANKLES, 0.5)
    assert bent.locked["RR_ankle_joint"] == 0.5
    assert any(
        "range -2..2" in each for each in imported(text, dict.fromkeys(ANKLES, 2.2)).warnings
    )


def test_a_hip_that_turns_like_the_thigh_can_be_held() -> None:
    hips = [f"{leg}_hip_joint" for leg in LEGS]
    text = re.sub(
        r'(name="\w\w_hip_joint".*?<axis xyz=")[^"]*',
        r"\g<1>0 1 0",
        urdf(Design()),
        flags=re.DOTALL,
    )
    assert "hold one in each leg, for instance FL_hip_joint=0 [rad]" in refused(text)
    assert imported(text, dict.fromkeys(hips, 0.0)).robot.held_joints == dict.fromkeys(hips, 0.0)


def test_an_arm_is_held_where_it_is_wanted() -> None:
    arm = link("arm", 2.0, x=0.2) + hinge("arm_joint", "base", "arm", "0.1 0 0.1", "0 1 0")
    text = urdf(Design(), extra=arm)
    ahead, up = imported(text), imported(text, {"arm_joint": -math.pi / 2})
    moved = np.subtract(up.robot.trunk.com, ahead.robot.trunk.com) * up.robot.trunk.mass
    assert moved == pytest.approx(np.array([-0.4, 0.0, 0.4]))
    assert any("arm_joint" in each for each in ahead.warnings)
    assert not any("arm_joint" in each for each in up.warnings)


def test_an_arm_is_no_leg_that_steers() -> None:
    places = ("base", "shoulder", "elbow", "wrist", "hand")
    arm = "".join(link(name, 0.3) for name in places[1:])
    for parent, child, axis in zip(
        places, places[1:], ("0 1 0", "0 1 0", "0 0 1", "0 1 0"), strict=False
    ):
        arm += hinge(f"{child}_joint", parent, child, "0.1 0 0.1", axis)
    made = imported(urdf(Design(), extra=arm))
    assert not any("wrist_joint" in each for each in made.assumed)
    (warning,) = [each for each in made.warnings if "of no leg" in each]
    assert "shoulder_joint 0, elbow_joint 0, wrist_joint 0, hand_joint 0" in warning


@pytest.mark.slow
def test_the_original_is_simulated_as_it_was_read() -> None:
    text = with_ankles("0 1 0")
    made = imported(text, dict.fromkeys(ANKLES, 0.2))
    plan = sw.plan({"points": [(-0.5, 0), (0, 0), (0, 0.1), (0.5, 0.1)]}, made.robot)
    run = sw.rollout(plan, controller={"speed": 1.0}, model=text)
    assert run.outcome == "success", run.reason


@pytest.mark.parametrize(
    ("hold", "words"),
    [
        ({"FL_ankle": 0.0}, "there is no joint 'FL_ankle'; there are FL_hip_joint"),
        (dict.fromkeys(("FL_thigh_joint", "FL_hip_joint"), 0.0), "3 legs end in a wheel"),
    ],
    ids=["unknown", "needed"],
)
def test_what_cannot_be_held(hold: dict[str, float], words: str) -> None:
    assert words in refused(urdf(Design()), hold)


@pytest.mark.parametrize(
    ("texts", "words"),
    [
        (["arm"], "hold: 'arm' must be JOINT=RAD"),
        (["arm=up"], "hold: 'arm=up' must be JOINT=RAD"),
        (["=0.5"], "hold: '=0.5' must be JOINT=RAD"),
        (["arm=nan"], "hold: 'arm': must be a number"),
        (["arm=1", "arm=2"], "hold: 'arm' is named twice"),
    ],
)
def test_what_is_no_joint_and_position(texts: list[str], words: str) -> None:
    with pytest.raises(InputError, match=re.escape(words)):
        written_hold(texts)


def test_names_may_hold_an_equals_sign() -> None:
    assert written_hold(["a=b=0.5", "c=-1"]) == {"a=b": 0.5, "c": -1.0}
