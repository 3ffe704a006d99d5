"""Robot documents of both schemas: what the second one holds, and what the first one must not."""

from __future__ import annotations

import copy
import math
from functools import reduce

import mujoco
import numpy as np
import pytest

from stairwright import _core
from stairwright.errors import InputError
from stairwright.library import load_robot, robots
from stairwright.robot import kinematics, spatial
from stairwright.robot.description import LEGS, Robot
from stairwright.robot.mujoco_model import build_model
from tests.robot.random_robots import random_robot

FIRST = load_robot("a1_wheeled").model_dump()
SEEDS = range(6)


def test_documents_of_the_first_schema_stay_as_they_were():
    assert FIRST["schema"] == "stairwright/robot/1"
    assert set(FIRST["trunk"]) == {"size", "mass", "inertia"}
    assert set(FIRST["actuators"]) == {"leg", "wheel"}
    assert {"rear", "payload", "source", "assumed", "assumed_fields", "abduction"}.isdisjoint(FIRST)
    assert Robot.model_validate(FIRST).hash == load_robot("a1_wheeled").hash
    unnamed = {key: value for key, value in FIRST.items() if key != "schema"}
    assert Robot.model_validate(unnamed) == load_robot("a1_wheeled")


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("payload",), {"mass": 1.0}),
        (("trunk", "com"), [0.01, 0.0, 0.0]),
        (("thigh", "com"), [0.0, -0.05]),
        (("calf", "shape"), [{"start": [0, 0], "end": [0, -0.2], "radius": 0.01}]),
        (("actuators", "thigh"), FIRST["actuators"]["leg"]),
        (("wheel", "rolling_resistance"), 0.02),
        (("gains",), None),
        (("joints", "front", "calf"), [-1.0, 1.0]),
    ],
)
def test_what_is_new_needs_the_second_schema(path, value):
    data = copy.deepcopy(FIRST)
    owner = data
    for key in path[:-1]:
        owner = owner[key]
    owner[path[-1]] = value
    with pytest.raises((InputError, ValueError)) as error:
        load_robot(data)
    assert error.value.field[-1] == path[-1] or path[-1] in error.value.field
    load_robot(data | {"schema": "stairwright/robot/2"})


@pytest.mark.parametrize(
    ("path", "value", "field"),
    [
        (("trunk", "outline"), [{"points": [[0, 0], [1, 0], [0.2, 0.2], [0, 1]], "width": 0.1}],
         "points"),
        (("rear",), {"wheel": FIRST["wheel"] | {"radius": 0.06}}, "radius"),
        (("actuators",), {"wheel": FIRST["actuators"]["wheel"]}, "thigh"),
        (("assumed_fields",), {"wheel.radius": 0}, "wheel.radius"),
    ],
)  # fmt: skip
def test_bad_documents_name_the_field(path, value, field):
    data = copy.deepcopy(FIRST) | {"schema": "stairwright/robot/2"}
    owner = data
    for key in path[:-1]:
        owner = owner[key]
    owner[path[-1]] = value
    with pytest.raises(InputError) as error:
        load_robot(data)
    assert error.value.field[-1] == field


@pytest.mark.parametrize("name", robots())
def test_fields_that_are_assumed_are_there(name):
    robot = load_robot(name)
    for path in robot.assumed_fields:
        assert reduce(getattr, path.split("."), robot) is not None
    assert set(robot.assumed_fields.values()) == set(range(len(robot.assumed)))


@pytest.mark.parametrize("seed", SEEDS)
def test_kinematics_and_mass_are_those_of_the_simulated_robot(seed):
    robot = random_robot(seed)
    model = build_model(robot)
    data = mujoco.MjData(model)
    random = np.random.default_rng(seed)
    assert model.body_mass.sum() == pytest.approx(robot.mass, abs=1e-12)
    for _ in range(100):
        x, z, pitch = random.uniform(-1, 1, 3)
        q = random.uniform(*kinematics.limits(robot).T)
        trunk, rolled = np.array([[x, z, pitch]]), random.uniform(-1, 1, (1, 2))
        position, turn, joints = spatial.lift(robot, trunk, q[None], rolled)
        data.qpos[:] = np.concatenate([position[0], turn[0], joints[0]])
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        frames = kinematics.forward(robot, x, z, pitch, q)
        for k, leg in enumerate(LEGS):
            for part, points in zip(("thigh", "calf", "wheel"), vars(frames).values(), strict=True):
                found = data.body(f"{leg}_{part}").xpos[[0, 2]]
                np.testing.assert_allclose(found, points[k // 2], atol=1e-9)
        com = kinematics.com(robot, x, z, pitch, frames)
        np.testing.assert_allclose(data.subtree_com[0][[0, 2]], com, atol=1e-9)
        np.testing.assert_allclose(
            spatial.place(robot, position, turn, joints).com[0], data.subtree_com[0], atol=1e-9
        )
        np.testing.assert_allclose(kinematics.inverse(robot, x, z, pitch, frames.wheels), q)


@pytest.mark.parametrize("seed", SEEDS)
def test_clearances_are_those_of_the_simulated_shapes(seed):
    """Of the legs from each other: least distance of MuJoCo's capsules and wheels of one side."""
    robot = random_robot(seed)
    model = build_model(robot)
    data = mujoco.MjData(model)
    random = np.random.default_rng(seed)
    left = [
        [g for g in range(model.ngeom) if model.body(model.geom_bodyid[g]).name.startswith(leg)]
        for leg in ("FL", "RL")
    ]
    for _ in range(20):
        q = random.uniform(*kinematics.limits(robot).T)
        trunk = np.zeros((1, 3))
        state = spatial.lift(robot, trunk, q[None], np.zeros((1, 2)))
        data.qpos[:] = np.concatenate([part[0] for part in state])
        mujoco.mj_kinematics(model, data)
        gaps = [mujoco.mj_geomDistance(model, data, a, b, 5.0, None)
                for a in left[0] for b in left[1]]  # fmt: skip
        ours = _core.legs_distance(robot.native, np.zeros(3), q)
        if min(gaps) > 0.0:
            assert ours == pytest.approx(min(gaps), abs=1e-6)


def test_knees_that_bend_both_ways_are_told_which():
    m20 = load_robot("m20")
    one = m20.with_knees(-1.0, 1.0)
    assert m20.joints.front.both_ways
    assert not one.joints.front.both_ways
    assert [leg.knee for leg in one.legs] == [-1.0, 1.0]
    assert one.legs != m20.legs
    assert one.hash != m20.hash
    with pytest.raises(InputError):
        load_robot("go2w").with_knees(1.0, -1.0)


def test_a_payload_is_part_of_the_body():
    data = load_robot("go2w").model_dump()
    loaded = Robot.model_validate(data | {"payload": {"mass": 4.0, "place": [0.1, 0.2]}})
    own, body = load_robot("go2w").body, loaded.body
    assert loaded.mass == pytest.approx(load_robot("go2w").mass + 4.0)
    assert body.com[0] == pytest.approx((own.mass * own.com[0] + 0.4) / body.mass)
    apart = np.hypot(0.1 - own.com[0], 0.2 - own.com[2])
    shared = own.mass * 4.0 / body.mass * apart**2
    assert body.inertia[1] == pytest.approx(own.inertia[1] + shared)


def test_thighs_that_turn_all_the_way_round_have_one_angle_for_each_posture():
    """Half a turn from where the leg hangs half folded, not where a folded leg points up."""
    folded_up = {-1.0: math.pi, 1.0: -math.pi}  # by which way the knee bends
    for leg in load_robot("anymal_wheels").with_knees(-1.0, 1.0).native.legs:
        turns = leg.thigh_range
        assert turns.upper - turns.lower == pytest.approx(2.0 * math.pi)
        assert turns.lower + 0.5 < folded_up[leg.knee] < turns.upper - 0.5
    for leg, document in zip(load_robot("m20").native.legs, load_robot("m20").legs, strict=True):
        assert (leg.thigh_range.lower, leg.thigh_range.upper) == document.limits.thigh
