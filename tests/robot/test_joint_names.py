"""Names that the robot's own software has for its joints."""

from __future__ import annotations

import pytest

import stairwright as sw
from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.robot.description import JOINTS, Robot

# From before there were such names: ids of stored plans are made of these.
HASHES = {"a1_wheeled": "sha256:b8ba3823f88f546e", "a1_wheeled_x": "sha256:a44f2bcb0efc9e70"}


def named(names: object) -> Robot:
    document = sw.load_robot("a1_wheeled").model_dump(mode="json")
    return parse(Robot, {**document, "joint_names": names})


@pytest.mark.parametrize("name", HASHES)
def test_robots_without_names_are_the_ones_they_were(name) -> None:
    robot = sw.load_robot(name)
    assert robot.hash == HASHES[name]
    assert "joint_names" not in robot.model_dump(mode="json")
    assert "joint_names" not in robot.model_dump_json()
    assert robot.ros_joints == JOINTS
    assert parse(Robot, robot.model_dump(mode="json")) == robot


def test_names_belong_to_the_robot() -> None:
    robot = named({"FL_thigh": "fl_hip", "RR_wheel": "rr_wheel_joint"})
    assert robot.ros_joints == ("fl_hip", *JOINTS[1:11], "rr_wheel_joint")
    assert robot.hash not in HASHES.values()
    assert parse(Robot, robot.model_dump(mode="json")) == robot
    assert named({}).hash == HASHES["a1_wheeled"]


@pytest.mark.parametrize(
    ("names", "field", "told"),
    [
        ({"FL_knee": "x"}, "FL_knee", "FL_thigh, FL_calf"),
        ({"FL_thigh": ""}, "FL_thigh", "letter"),
        ({"FL_thigh": "a b"}, "FL_thigh", "letter"),
        ({"FL_thigh": "9lives"}, "FL_thigh", "letter"),
        ({"FL_thigh": "<"}, "FL_thigh", "letter"),
        ({"FL_thigh": "x" * 101}, "FL_thigh", "100"),
        ({"FL_thigh": "x", "FR_thigh": "x"}, "FL_thigh", "two joints"),
        ({"FL_thigh": "FR_thigh"}, "FL_thigh", "two joints"),
        ({"FL_thigh": 5}, "FL_thigh", "string"),
        ([], "joint_names", "mapping"),
    ],
)
def test_bad_names_are_refused(names, field, told) -> None:
    with pytest.raises(InputError, match=told) as refused:
        named(names)
    assert refused.value.field[-1] == field
    assert refused.value.field[0] == "joint_names"
