"""The robot turned about: everything stands where it stood, seen from behind."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.robot import kinematics as kin
from stairwright.robot.description import Robot
from stairwright.robot.turning import symmetric, turned

from .random_robots import random_robot

MIRROR = (-1.0, 1.0)
OTHER_END = [2, 3, 0, 1]


@pytest.mark.parametrize("seed", range(4))
def test_every_point_is_mirrored(seed: int) -> None:
    robot = random_robot(seed)
    about = turned(robot)
    x, z, pitch, q = 0.3, 0.4, 0.2, np.array([0.5, -1.1, 0.7, 1.2])
    there = (-x, z, -pitch, -q[OTHER_END])
    ours, theirs = kin.forward(robot, x, z, pitch, q), kin.forward(about, *there)
    for name in ("hips", "knees", "wheels"):
        np.testing.assert_allclose(getattr(theirs, name), getattr(ours, name)[::-1] * MIRROR)
    np.testing.assert_allclose(
        kin.com(about, *there[:3], theirs), kin.com(robot, x, z, pitch, ours) * MIRROR
    )

    def points(of: Robot, *pose: object) -> list[list[float]]:
        return sorted(kin.collision_points(of, *pose).round(9).tolist())

    mirrored = [[-p[0], p[1]] for p in points(robot, x, z, pitch, q)]
    np.testing.assert_allclose(points(about, *there), sorted(mirrored), atol=1e-8)
    np.testing.assert_allclose(about.torque_limits, robot.torque_limits[::-1])
    np.testing.assert_allclose(kin.limits(about), -kin.limits(robot)[OTHER_END][:, ::-1])
    assert about.mass == pytest.approx(robot.mass)


@pytest.mark.parametrize("name", sw.robots())
def test_twice_is_not_at_all(name: str) -> None:
    robot = sw.load_robot(name)
    again = turned(turned(robot)).model_copy(update={"schema_": robot.schema_})
    assert again == robot
    document = turned(robot).model_dump(mode="json", by_alias=True)
    assert Robot.model_validate(document) == turned(robot)


def test_which_robots_are_the_same_from_behind() -> None:
    assert [name for name in sw.robots() if symmetric(sw.load_robot(name))] == ["a1_wheeled_x"]
    named = {"joint_names": {"FL_thigh": "front_left_hip_pitch"}}
    assert symmetric(sw.load_robot("a1_wheeled_x").model_copy(update=named))


def test_its_own_software_still_knows_its_joints() -> None:
    own = {"joint_names": {"FL_thigh": "front_left_hip_pitch"}} | {
        "joint_frames": {"FL_thigh": {"sign": -1, "offset": 0.3}}
    }
    robot = sw.load_robot("go2w").model_dump(mode="json", by_alias=True) | own
    about = turned(Robot.model_validate(robot))
    joints = about.ros_joints
    assert sorted(joints) == sorted(Robot.model_validate(robot).ros_joints)
    place = joints.index("front_left_hip_pitch")
    assert place == 9  # RR_thigh
    signs, offsets = about.ros_frames
    assert (signs[place], offsets[place]) == (1.0, -0.3)
    assert (signs[0], offsets[0]) == (-1.0, 0.0)


def test_a_plan_backward_is_carried_out() -> None:
    forward, backward = (
        sw.plan("curb-015", "a1_wheeled", facing=facing) for facing in ("forward", "backward")
    )
    assert (forward.facing, backward.facing) == ("forward", "backward")
    assert forward.id != backward.id
    assert backward.feasible
    assert backward.robot_description == turned(forward.robot_description)
    assert sw.rollout(backward).success


def test_an_unknown_facing_is_told() -> None:
    with pytest.raises(InputError, match="facing: must be one of: forward, backward, either"):
        sw.plan("curb-015", facing="sideways")  # type: ignore[arg-type]
