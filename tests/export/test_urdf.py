"""URDF: the same robot as the one that is planned for and simulated."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import mujoco
import numpy as np
import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.export.table import PLAN_FORMATS, ROBOT_FORMATS
from stairwright.robot.description import JOINTS, Robot
from stairwright.robot.mujoco_model import build_model
from tests.scene.example import example_plan


def loaded(robot: Robot) -> mujoco.MjModel:
    """MuJoCo's reading of the URDF, free in the world as the robot is."""
    root = ET.fromstring(ROBOT_FORMATS["urdf"].write(robot))
    ET.SubElement(root, "link", name="world")
    free = ET.SubElement(root, "joint", name="root", type="floating")
    ET.SubElement(free, "parent", link="world")
    ET.SubElement(free, "child", link="trunk")
    mujoco_only = ET.SubElement(root, "mujoco")
    ET.SubElement(mujoco_only, "compiler", fusestatic="true", discardvisual="false")
    return mujoco.MjModel.from_xml_string(ET.tostring(root, encoding="unicode"))


@pytest.fixture(scope="module", params=["a1_wheeled", "a1_wheeled_x", "uneven"])
def robot(request: pytest.FixtureRequest) -> Robot:
    if request.param != "uneven":
        return sw.load_robot(request.param)
    document = sw.load_robot("a1_wheeled").model_dump(mode="json")
    document["thigh"].update(length=0.23, com=0.4, mass=1.1, inertia=[0.002, 0.003, 0.0015])
    document["hips"].update(front=[0.15, 0.02], rear=[-0.15, -0.02])
    document["actuators"]["leg"].update(armature=0.0, torque=20.0)
    return Robot.model_validate(document)


def test_kinematics_and_dynamics_are_the_simulators(robot) -> None:
    """Frames, mass matrix and gravity's torques over random postures."""
    ours, theirs = build_model(robot), loaded(robot)
    assert theirs.nbody == ours.nbody
    a, b = mujoco.MjData(ours), mujoco.MjData(theirs)
    joints = {name: theirs.joint(name).qposadr[0] for name in JOINTS}
    speeds = {name: theirs.joint(name).dofadr[0] for name in JOINTS}
    free = theirs.joint("root").dofadr[0]
    dofs = [*range(free, free + 6), *speeds.values()]
    rng = np.random.default_rng(7)
    for _ in range(50):
        base = np.concatenate([rng.normal(size=3), rng.normal(size=4)])
        base[3:] /= np.linalg.norm(base[3:])
        q = rng.uniform(-3.0, 3.0, size=12)
        a.qpos[:7], a.qpos[7:] = base, q
        start = theirs.joint("root").qposadr[0]
        b.qpos[start : start + 7] = base
        b.qpos[list(joints.values())] = q
        for model, data in ((ours, a), (theirs, b)):
            mujoco.mj_forward(model, data)
        for name in ("trunk", *JOINTS):
            np.testing.assert_allclose(b.body(name).xpos, a.body(name).xpos, atol=1e-9)
            np.testing.assert_allclose(b.body(name).xmat, a.body(name).xmat, atol=1e-9)
            np.testing.assert_allclose(b.body(name).xipos, a.body(name).xipos, atol=1e-9)
        full = []
        for model, data in ((ours, a), (theirs, b)):
            matrix = np.zeros((model.nv, model.nv))
            mujoco.mj_fullM(model, data, matrix)
            full.append(matrix - np.diag(model.dof_armature))
        np.testing.assert_allclose(full[1][np.ix_(dofs, dofs)], full[0], atol=1e-9)
        np.testing.assert_allclose(b.qfrc_bias[dofs], a.qfrc_bias, atol=1e-9)


def test_masses_are_the_robots(robot) -> None:
    theirs = loaded(robot)
    assert theirs.body_mass.sum() == pytest.approx(robot.mass, abs=1e-9)
    for part in ("thigh", "calf", "wheel"):
        for leg in ("FL", "FR", "RL", "RR"):
            assert theirs.body(f"{leg}_{part}").mass[0] == pytest.approx(getattr(robot, part).mass)


def test_limits_are_the_motors(robot) -> None:
    root = ET.fromstring(ROBOT_FORMATS["urdf"].write(robot))
    found = {joint.get("name"): joint for joint in root.iter("joint")}
    for name in JOINTS:
        joint, wheel = found[name], name.endswith("wheel")
        motor = robot.actuators.wheel if wheel else robot.actuators.leg
        limit = joint.find("limit")
        assert float(limit.get("effort")) == motor.torque
        assert float(limit.get("velocity")) == motor.speed
        assert float(joint.find("dynamics").get("damping")) == motor.damping
        assert joint.find("axis").get("xyz") == "0 1 0"
        assert joint.get("type") == ("continuous" if wheel else "revolute")
        if not wheel:
            pair = robot.joints.front if name[0] == "F" else robot.joints.rear
            lower, upper = getattr(pair, name[3:])
            assert (float(limit.get("lower")), float(limit.get("upper"))) == (lower, upper)
    for link in root.iter("link"):
        if link.get("name") not in ("base_link", "imu"):
            assert link.find("inertial") is not None
            assert link.find("visual") is not None
            assert link.find("collision") is not None


def test_shapes_are_where_the_simulator_has_them(robot) -> None:
    """The lowest point of every link: capsules and wheels stand at the same height."""
    ours, theirs = build_model(robot), loaded(robot)
    reach = []
    for model in (ours, theirs):
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        lowest: dict[str, float] = {}
        for g in range(model.ngeom):
            size, kind = model.geom_size[g], model.geom_type[g]
            down = np.abs(data.geom_xmat[g].reshape(3, 3)[2])
            drop = {
                mujoco.mjtGeom.mjGEOM_SPHERE: size[0],
                mujoco.mjtGeom.mjGEOM_CAPSULE: size[0] + size[1] * down[2],
                mujoco.mjtGeom.mjGEOM_BOX: float(size @ down),
                mujoco.mjtGeom.mjGEOM_CYLINDER: size[1] * down[2]
                + size[0] * np.sqrt(max(0.0, 1 - down[2] ** 2)),
            }[mujoco.mjtGeom(kind)]
            name = model.body(model.geom_bodyid[g]).name
            height = data.geom_xpos[g, 2] - drop - data.body("trunk").xpos[2]
            lowest[name] = min(lowest.get(name, np.inf), height)
        reach.append(lowest)
    for name in ("trunk", *JOINTS):
        assert reach[1][name] == pytest.approx(reach[0][name], abs=1e-9), name


def test_a_plans_urdf_is_its_robots(tmp_path) -> None:
    plan = example_plan(count=3)
    robot = plan.robot_description
    plan.save(tmp_path / "plan.urdf")
    robot.save(tmp_path / "robot.urdf")
    content = (tmp_path / "plan.urdf").read_bytes()
    assert content == (tmp_path / "robot.urdf").read_bytes() == ROBOT_FORMATS["urdf"].write(robot)
    assert robot.hash.encode() in content
    assert PLAN_FORMATS["urdf"].write(plan) == content


def test_a_robots_mjcf_is_the_simulators(robot) -> None:
    model = mujoco.MjModel.from_xml_string(ROBOT_FORMATS["mjcf"].write(robot).decode())
    ours = build_model(robot)
    assert (model.nq, model.nv, model.nu) == (ours.nq, ours.nv, ours.nu)
    np.testing.assert_allclose(model.body_mass, ours.body_mass)


def test_other_formats_name_the_valid_ones(tmp_path) -> None:
    with pytest.raises(InputError, match=r"\.urdf, \.mjcf"):
        sw.load_robot("a1_wheeled").save(tmp_path / "robot.csv")
