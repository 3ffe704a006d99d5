"""Every plan format, read back by a reader that is not ours."""

from __future__ import annotations

import csv
import io
import json
import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np
import pytest
from rosbags.highlevel import AnyReader

import stairwright as sw
from stairwright.errors import InputError
from stairwright.export.formats import PLAN_FORMATS, convert, load_plan, save
from stairwright.planning.carrying import holding_torques
from stairwright.planning.plan import Plan
from stairwright.robot import kinematics
from stairwright.robot.description import JOINTS
from tests.export.mcap_reading import messages, metadata, world
from tests.scene.example import example_plan


@pytest.fixture(scope="module")
def plan() -> Plan:
    return example_plan(count=40)


def test_json_is_the_document(plan, tmp_path):
    save(plan, tmp_path / "plan.json")
    data = json.loads((tmp_path / "plan.json").read_text())
    assert data["schema"] == "stairwright/plan/1"
    assert data["poses"][7]["q"] == list(plan.poses[7].q)
    assert load_plan(tmp_path / "plan.json") == plan


def test_csv_columns_carry_units_and_exact_numbers(plan):
    text = PLAN_FORMATS["csv"].write(plan).decode()
    rows = list(csv.DictReader(io.StringIO(text)))
    assert len(rows) == len(plan.poses)
    for row, pose in zip(rows, plan.poses, strict=True):
        assert float(row["progress_m"]) == pose.progress
        assert float(row["pitch_rad"]) == pose.pitch
        assert float(row["rear_calf_rad"]) == pose.q[3]
        assert float(row["rear_wheel_z_m"]) == pose.wheels[1][1]
        assert float(row["torque_margin_Nm"]) == pose.margins.torque
    assert [i for i, row in enumerate(rows) if row["key"] == "1"] == plan.critical
    assert plan.terrain_hash in rows[0]["source"]
    assert plan.robot_hash in rows[0]["source"]


def test_csv_is_readable_by_numpy(plan):
    text = PLAN_FORMATS["csv"].write(plan).decode()
    table = np.genfromtxt(io.StringIO(text), delimiter=",", names=True)
    np.testing.assert_array_equal(table["x_c_m"], [pose.x_c for pose in plan.poses])


def test_npz_holds_arrays_and_metadata(plan, tmp_path):
    save(plan, tmp_path / "plan.npz")
    with np.load(tmp_path / "plan.npz", allow_pickle=False) as file:
        np.testing.assert_array_equal(file["q"], [pose.q for pose in plan.poses])
        assert file["collision_points"].shape == (len(plan.poses), 25, 2)
        about = json.loads(str(file["metadata"]))
    assert about["joint_order"] == ["front_thigh", "front_calf", "rear_thigh", "rear_calf"]
    assert about["document"]["terrain_hash"] == plan.terrain_hash
    assert load_plan(tmp_path / "plan.npz") == plan


def test_mcap_tells_where_it_comes_from(plan):
    about = metadata(PLAN_FORMATS["mcap"].write(plan))
    assert about["robot_hash"] == plan.robot_hash
    assert about["terrain_hash"] == plan.terrain_hash
    assert json.loads(about["joint_order"]) == list(JOINTS)


@pytest.mark.slow
def test_mcap_goes_from_the_first_pose_to_the_last(plan):
    topics = messages(PLAN_FORMATS["mcap"].write(plan))
    for index in (0, -1):
        pose, (_, tf) = plan.poses[index], topics["/tf"][index]
        trunk = tf.transforms[0]
        assert (trunk.header.frame_id, trunk.child_frame_id) == ("world", "trunk")
        # xyzw on this side: pitch about y is 2 atan2(y, w).
        turn = trunk.transform.rotation
        assert 2 * np.arctan2(turn.y, turn.w) == pytest.approx(pose.pitch)
        for name, centre in zip(("FR_wheel", "RL_wheel"), pose.wheels, strict=True):
            np.testing.assert_allclose(world(tf, name)[[0, 2], 3], centre, atol=1e-9)
        position = np.array(topics["/joint_states"][index][1].position)
        np.testing.assert_allclose(position[[0, 1, 9, 10]], pose.q, atol=1e-9)


def test_mcap_is_read_by_rosbags(plan, tmp_path):
    save(plan, tmp_path / "plan.mcap")
    with AnyReader([tmp_path / "plan.mcap"]) as reader:
        topics = {c.topic: c for c in reader.connections}
        assert topics["/joint_trajectory"].msgtype == "trajectory_msgs/msg/JointTrajectory"
        assert topics["/terrain"].msgtype == "visualization_msgs/msg/Marker"
        assert topics["/path"].msgtype == "nav_msgs/msg/Path"
        ((connection, _, raw),) = reader.messages([topics["/joint_trajectory"]])
        trajectory = reader.deserialize(raw, connection.msgtype)
    np.testing.assert_allclose(trajectory.points[0].positions[:2], plan.poses[0].q[:2], atol=1e-9)


def test_mjcf_keyframes_are_the_poses(plan, tmp_path):
    save(plan, tmp_path / "plan.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "plan.xml"))
    data = mujoco.MjData(model)
    assert model.nkey == len(plan.poses)
    for i in (0, 13, 27, len(plan.poses) - 1):
        mujoco.mj_resetDataKeyframe(model, data, i)
        mujoco.mj_forward(model, data)
        for leg, wheel in (("FL", 0), ("FR", 0), ("RL", 1), ("RR", 1)):
            place = data.body(f"{leg}_wheel").xpos[[0, 2]]
            np.testing.assert_allclose(place, plan.poses[i].wheels[wheel], atol=1e-6)
    texts = {t.get("name"): t.get("data") for t in ET.parse(tmp_path / "plan.xml").iter("text")}
    assert texts["terrain_hash"] == plan.terrain_hash
    assert texts["joint_order"].split() == list(JOINTS)


def test_mjcf_poses_hold(plan):
    """A loaded keyframe stands still for two seconds: servos carry the static torques.

    Only poses inside the friction cones can: the example rolls over corners without asking.
    """
    model = mujoco.MjModel.from_xml_string(PLAN_FORMATS["mjcf"].write(plan).decode())
    data = mujoco.MjData(model)
    sound = [
        i
        for i, pose in enumerate(plan.poses)
        if all(abs(along) < 0.8 * plan.friction * across for along, across in pose.forces)
    ]
    assert len(sound) > 10
    for i in sound[::6]:
        mujoco.mj_resetDataKeyframe(model, data, i)
        start = data.qpos.copy()
        for _ in range(2000):
            mujoco.mj_step(model, data)
        assert np.isfinite(data.qpos).all()
        assert np.linalg.norm(data.qpos[:3] - start[:3]) < 0.02, i
        assert np.abs(data.qpos[7:] - start[7:]).max() < 0.06, i


@pytest.mark.slow
def test_mjcf_poses_of_a_real_climb_hold():
    """Every tenth pose of the certified path up the paper's highest stair."""
    plan = sw.plan("single-stair-036", "a1_wheeled_x")
    model = mujoco.MjModel.from_xml_string(PLAN_FORMATS["mjcf"].write(plan).decode())
    data = mujoco.MjData(model)
    for i in range(0, model.nkey, 10):
        mujoco.mj_resetDataKeyframe(model, data, i)
        start = data.qpos.copy()
        for _ in range(2000):
            mujoco.mj_step(model, data)
        assert np.linalg.norm(data.qpos[:3] - start[:3]) < 0.01, i


@pytest.mark.slow
def test_mjcf_servos_of_a_real_climb_do_what_lifts_the_robot():
    """In corners too, where a wheel touches two faces and only one of them carries it."""
    plan = sw.plan("three-stairs-up", "a1_wheeled_x")
    model = mujoco.MjModel.from_xml_string(PLAN_FORMATS["mjcf"].write(plan).decode())
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    data = mujoco.MjData(model)
    stiffness, joints = model.actuator_gainprm[:, 0], model.key_qpos[:, 7:]
    torques = stiffness * (model.key_ctrl - joints)
    heights = []
    for i in range(model.nkey):
        mujoco.mj_resetDataKeyframe(model, data, i)
        mujoco.mj_forward(model, data)
        heights.append(data.energy[0])
    work = ((torques[:-1] + torques[1:]) / 2 * np.diff(joints, axis=0)).sum()
    assert work == pytest.approx(heights[-1] - heights[0], rel=0.03)


def test_mjcf_masses_are_the_robots(plan):
    model = mujoco.MjModel.from_xml_string(PLAN_FORMATS["mjcf"].write(plan).decode())
    assert model.body_mass.sum() == pytest.approx(plan.robot_description.mass)


def test_standing_pose_needs_the_torques_of_its_weight():
    """On flat ground with vertical forces the knee carries the load at its lever."""
    plan = example_plan(count=5)
    robot, pose = plan.robot_description, plan.poses[0]
    torques = holding_torques(plan)[0].reshape(4, 3)
    frames = kinematics.forward(robot, pose.x_c, pose.z_c, pose.pitch, np.array(pose.q))
    lever = pose.contacts[0][0] - frames.knees[0, 0]
    own = robot.calf.com * (pose.wheels[0][0] - frames.knees[0, 0]) * robot.calf.mass
    own += (pose.wheels[0][0] - frames.knees[0, 0]) * robot.wheel.mass
    expected = lever * pose.forces[0][1] / 2 - own * 9.81
    assert torques[0, 1] == pytest.approx(expected, abs=1e-9)
    assert abs(torques[:, 2]).max() < 1e-9


@pytest.mark.parametrize("name", ["plan", "plan.html", "plan.txt"])
def test_unknown_ending_names_the_valid_ones(plan, tmp_path, name):
    endings = r"\.json, \.csv, \.npz, \.mcap, \.mjcf, \.urdf, \.bundle, \.xml, \.zip"
    with pytest.raises(InputError, match=endings):
        save(plan, tmp_path / name)
    assert not (tmp_path / name).exists()


def test_convert_picks_the_format_by_name_or_ending(plan, tmp_path):
    save(plan, tmp_path / "plan.json")
    convert(tmp_path / "plan.json", None, tmp_path / "out.csv")
    convert(tmp_path / "plan.json", "csv", tmp_path / "out.txt")
    assert (tmp_path / "out.csv").read_bytes() == (tmp_path / "out.txt").read_bytes()
    with pytest.raises(InputError, match="html"):
        convert(tmp_path / "plan.json", "html", tmp_path / "out")


def test_damaged_files_are_input_errors(tmp_path):
    (tmp_path / "a.npz").write_bytes(b"PK not a zip")
    np.savez(tmp_path / "b.npz", x=np.zeros(3))
    (tmp_path / "c.json").write_text('{"schema": "stairwright/terrain/1"}')
    (tmp_path / "d.csv").write_text("x\n")
    for name in ("a.npz", "b.npz", "c.json", "d.csv", "missing.json"):
        with pytest.raises(InputError):
            load_plan(tmp_path / name)
    with pytest.raises(InputError, match="cannot write"):
        save(example_plan(count=3), Path(tmp_path / "no" / "folder" / "plan.json"))


def test_an_npz_whose_arrays_do_not_fit_is_an_input_error(plan, tmp_path):
    save(plan, tmp_path / "plan.npz")
    arrays = dict(np.load(tmp_path / "plan.npz"))
    np.savez(tmp_path / "bad.npz", **{**arrays, "trunk": arrays["trunk"][:, :2]})
    with pytest.raises(InputError, match="arrays of a plan"):
        load_plan(tmp_path / "bad.npz")


@pytest.mark.parametrize("name", ["csv", "npz", "mcap", "mjcf"])
def test_poses_with_other_collision_points_than_the_robots_are_refused(plan, name):
    odd = plan.poses[1].model_copy(update={"collision_points": [(0.0, 0.0)]})
    broken = plan.model_copy(update={"poses": [plan.poses[0], odd, *plan.poses[2:]]})
    with pytest.raises(InputError, match="collision_points"):
        PLAN_FORMATS[name].write(broken)


@pytest.mark.parametrize("time", [-1.0, 1e12, 1e300])
def test_a_time_that_no_ros_message_holds_is_refused(plan, time):
    late = plan.poses[-1].model_copy(update={"time": time})
    broken = plan.model_copy(update={"poses": [*plan.poses[:-1], late]})
    with pytest.raises(InputError, match="ROS messages"):
        PLAN_FORMATS["mcap"].write(broken)


def test_infeasible_plan_without_poses_exports_everywhere_but_to_a_robot():
    plan = example_plan(count=4, problem=True).model_copy(update={"poses": [], "critical": []})
    for name, format_ in PLAN_FORMATS.items():
        if name != "bundle":
            assert format_.write(plan), name
