"""Exports count joints as the robot's own software does: its axes, its zero angles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stairwright as sw
from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.export.formats import save
from stairwright.export.table import PLAN_FORMATS, ROLLOUT_FORMATS
from stairwright.robot.description import JOINTS, Robot
from tests.export.mcap_reading import messages

TERRAIN = {"points": [[-1.0, 0.0], [0.0, 0.0], [0.0, 0.05], [1.0, 0.05]]}
FRAMES = {
    joint: {"sign": -1 if k % 2 else 1, "offset": 0.1 * (k % 5) - 0.2}
    for k, joint in enumerate(JOINTS)
    if not joint.endswith("wheel")
}
FRAMES["FL_wheel"] = {"sign": -1, "offset": 0.0}
SIGNS = np.array([FRAMES.get(joint, {"sign": 1})["sign"] for joint in JOINTS], float)
OFFSETS = np.array([FRAMES.get(joint, {"offset": 0.0})["offset"] for joint in JOINTS])


def counted(frames: object) -> Robot:
    document = sw.load_robot("go2w").model_dump(mode="json")
    return parse(Robot, {**document, "joint_frames": frames})


@pytest.mark.slow
def test_the_urdf_reads_back_with_the_same_frames(tmp_path: Path) -> None:
    robot, path = counted(FRAMES), tmp_path / "own.urdf"
    save(robot, str(path))
    read = sw.import_robot(path)
    for joint, frame in FRAMES.items():
        assert read.joints[joint].sign == frame["sign"], joint
        assert read.joints[joint].offset == pytest.approx(frame["offset"], abs=1e-9), joint
    for end in ("front", "rear"):
        for link in ("thigh", "calf"):
            mine, theirs = (getattr(getattr(r.joints, end), link) for r in (robot, read.robot))
            assert theirs == pytest.approx(mine, abs=1e-9)
    again = tmp_path / "again.urdf"
    save(read.robot, str(again))
    for joint, mine in sw.import_robot(again).joints.items():
        assert mine.sign == read.joints[joint].sign
        assert mine.offset == pytest.approx(read.joints[joint].offset, abs=1e-9)


@pytest.mark.slow
def test_ros_messages_are_in_its_angles_and_documents_in_ours() -> None:
    plain, own = (sw.plan(TERRAIN, counted(frames)) for frames in ({}, FRAMES))
    assert [p.q for p in plain.poses] == [p.q for p in own.poses]
    ours, theirs = (messages(PLAN_FORMATS["mcap"].write(p, 100.0)) for p in (plain, own))
    for topic in ("/joint_trajectory", "/wheel_trajectory"):
        (_, a), (_, b) = ours[topic][0], theirs[topic][0]
        index = [JOINTS.index(name) for name in a.joint_names]
        for field, shift in (("positions", OFFSETS[index]), ("velocities", 0), ("effort", 0)):
            mine = np.array([getattr(point, field) for point in a.points])
            if mine.size:
                told = np.array([getattr(point, field) for point in b.points])
                assert np.allclose(told, SIGNS[index] * (mine - shift), atol=1e-9), field
    run = sw.rollout(own)
    states = messages(ROLLOUT_FORMATS["mcap"].write(run, None))["/joint_states"]
    at = np.array([message.position for _, message in states])
    assert np.allclose(at, SIGNS * (np.array(run.series.q) - OFFSETS), atol=1e-9)
    torque = np.array([message.effort for _, message in states])
    assert np.allclose(torque, SIGNS * np.array(run.series.torque), atol=1e-9)


@pytest.mark.parametrize(
    ("frames", "field"),
    [
        ({"FL_knee": {}}, "FL_knee"),
        ({"FL_calf": {"sign": 2}}, "sign"),
        ({"FL_calf": {"offset": "x"}}, "offset"),
        ({"FL_calf": {"turn": 1}}, "turn"),
    ],
)
def test_bad_frames_are_refused(frames: object, field: str) -> None:
    with pytest.raises(InputError) as refused:
        counted(frames)
    assert refused.value.field[0] == "joint_frames"
    assert refused.value.field[-1] == field


def test_robots_without_frames_are_the_ones_they_were() -> None:
    robot = counted({})
    assert robot.hash == sw.load_robot("go2w").hash
    assert "joint_frames" not in robot.model_dump(mode="json")
