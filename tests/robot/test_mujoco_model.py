"""The MuJoCo model says the same as the robot's description and as the planner's kinematics."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

from stairwright import load_robot, robots
from stairwright.robot import kinematics
from stairwright.robot.description import JOINTS, LEGS, Robot
from stairwright.robot.mujoco_model import build_model, build_spec
from stairwright.robot.mujoco_terrain import prisms
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

STAIR = Terrain(points=[(-1.5, 0.0), (0.0, 0.0), (0.0, 0.3), (1.5, 0.3)], friction=0.6)


@pytest.fixture(params=robots())
def robot(request: pytest.FixtureRequest) -> Robot:
    return load_robot(request.param)


def place(data, x, z, pitch, q):
    data.qpos[:] = 0.0
    data.qpos[[0, 2]] = x, z
    data.qpos[3:7] = math.cos(pitch / 2), 0.0, math.sin(pitch / 2), 0.0
    legs = np.asarray(q).reshape(2, 2)[[0, 0, 1, 1]]
    data.qpos[7:] = np.insert(legs, 2, 0.0, axis=1).ravel()


def test_kinematics_and_com_equal_the_planners(robot: Robot) -> None:
    model = build_model(robot)
    data = mujoco.MjData(model)
    random = np.random.default_rng(0)
    limits = kinematics.limits(robot)
    for _ in range(200):
        x, z, pitch = random.uniform([-5, -1, -3], [5, 2, 3])
        q = random.uniform(*limits.T)
        place(data, x, z, pitch, q)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        frames = kinematics.forward(robot, x, z, pitch, q)
        for leg, name in enumerate(LEGS):
            points = (("thigh", frames.hips), ("calf", frames.knees), ("wheel", frames.wheels))
            for part, expected in points:
                found = data.body(f"{name}_{part}").xpos[[0, 2]]
                np.testing.assert_allclose(found, expected[leg // 2], atol=1e-9)
        com = kinematics.com(robot, np.asarray(x), np.asarray(z), np.asarray(pitch), frames)
        np.testing.assert_allclose(data.subtree_com[0][[0, 2]], com, atol=1e-9)


def test_masses_inertias_and_limits_are_the_files(robot: Robot) -> None:
    model = build_model(robot)
    assert model.body_mass.sum() == pytest.approx(robot.mass, abs=1e-12)
    assert model.body("trunk").mass[0] == robot.trunk.mass
    np.testing.assert_array_equal(model.body("trunk").inertia, robot.trunk.inertia)
    for leg in LEGS:
        limits = robot.joints.front if leg[0] == "F" else robot.joints.rear
        for part in ("thigh", "calf", "wheel"):
            link = getattr(robot, part)
            body = model.body(f"{leg}_{part}")
            assert body.mass[0] == link.mass
            # MuJoCo keeps principal inertias sorted by its own frame: compare as sets.
            np.testing.assert_allclose(np.sort(body.inertia), np.sort(link.inertia), rtol=1e-12)
        np.testing.assert_array_equal(model.joint(f"{leg}_thigh").range, limits.thigh)
        np.testing.assert_array_equal(model.joint(f"{leg}_calf").range, limits.calf)
        assert not model.jnt_limited[model.joint(f"{leg}_wheel").id]
    assert [model.actuator(i).name for i in range(model.nu)] == list(JOINTS)
    assert [model.joint(i).name for i in range(1, model.njnt)] == list(JOINTS)
    for name, motor in zip(JOINTS, robot.motors, strict=True):
        np.testing.assert_array_equal(model.actuator(name).ctrlrange, [-motor.torque, motor.torque])
        assert model.joint(name).armature[0] == motor.armature


def test_options() -> None:
    option = build_model(load_robot("a1_wheeled"), STAIR).opt
    assert option.timestep == 0.001
    assert option.integrator == mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    assert option.solver == mujoco.mjtSolver.mjSOL_NEWTON
    assert option.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
    assert option.jacobian == mujoco.mjtJacobian.mjJAC_DENSE
    assert option.disableflags & mujoco.mjtDisableBit.mjDSBL_MULTICCD


def test_looks_change_no_dynamics(robot: Robot) -> None:
    plain, seen = build_model(robot, STAIR), build_model(robot, STAIR, visual=True)
    assert seen.ngeom > plain.ngeom
    np.testing.assert_array_equal(plain.body_mass, seen.body_mass)
    np.testing.assert_array_equal(plain.body_inertia, seen.body_inertia)


def contact_pairs(model, data) -> set[frozenset[str]]:
    return {
        frozenset(model.geom(int(g)).name for g in pair) for pair in data.contact.geom[: data.ncon]
    }


def test_who_touches_whom(robot: Robot) -> None:
    model = build_model(robot, STAIR)

    def meets(a: str, b: str) -> bool:
        first, second = model.geom(a), model.geom(b)
        forth = int(first.contype[0]) & int(second.conaffinity[0])
        back = int(second.contype[0]) & int(first.conaffinity[0])
        return bool(forth or back)

    parts = ("thigh", "calf", "wheel")
    for part in parts:
        for leg in LEGS:
            assert meets(f"{leg}_{part}", "terrain_0")
            assert not meets(f"{leg}_{part}", "trunk")
            for other in parts:
                assert meets(f"F{leg[1]}_{part}", f"R{leg[1]}_{other}")
                assert not meets(f"{leg}_{part}", f"{leg}_{other}")
                assert not meets(f"FL_{part}", f"FR_{other}")
                assert not meets(f"FL_{part}", f"RR_{other}")
    assert meets("trunk", "terrain_0")


@pytest.mark.parametrize("friction", [0.2, 0.9])
def test_friction_is_the_given_one(friction: float) -> None:
    robot = load_robot("a1_wheeled")
    model = build_model(robot, STAIR, friction)
    data = mujoco.MjData(model)
    place(data, -0.8, robot.nominal_height - 1e-4, 0.0, kinematics.standing_joints(robot))
    mujoco.mj_forward(model, data)
    assert data.ncon == 4
    np.testing.assert_allclose(data.contact.friction[:, :2], friction)


def hung_wheel(terrain: Terrain, shape: str = "sphere"):
    """A lone wheel that slides freely in x and z and turns about y."""
    robot = load_robot("a1_wheeled")
    spec = build_spec(robot, terrain, 0.6, visual=False)
    spec.delete(spec.body("trunk"))
    for sensor in list(spec.sensors):
        spec.delete(sensor)
    for actuator in list(spec.actuators):
        spec.delete(actuator)
    body = spec.worldbody.add_body(name="wheel")
    for axis, kind in (([1, 0, 0], "x"), ([0, 0, 1], "z")):
        body.add_joint(name=kind, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
    body.add_joint(name="turn", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 1, 0])
    body.explicitinertial, body.mass, body.inertia = True, 3.0, [0.002, 0.00375, 0.002]
    body.add_geom(
        type=getattr(mujoco.mjtGeom, f"mjGEOM_{shape.upper()}"),
        size=[robot.wheel.radius, 0, 0],
        contype=2,
        conaffinity=1,
        friction=[0.6, 0, 0],
        condim=3,
    )
    model = spec.compile()
    return model, mujoco.MjData(model), robot.wheel.radius


PROFILES = {
    "box edge": [(-1.5, 0.0), (0.0, 0.0), (0.0, 0.3), (1.5, 0.3)],
    "ramp": [(-1.5, 0.0), (0.0, 0.0), (0.5, 0.25), (1.5, 0.25)],
    "down": [(-1.5, 0.3), (0.0, 0.3), (0.0, 0.0), (1.5, 0.0)],
    "teeth": [(-1.0, 0.0), (0.0, 0.0), (0.1, 0.12), (0.2, 0.0), (0.3, 0.12), (0.4, 0), (1, 0)],
}


@pytest.mark.parametrize("name", PROFILES)
def test_contact_lies_on_the_wheel_curve(name: str) -> None:
    """Moved along the exact curve, the wheel touches with the curve's own normal only."""
    terrain = Terrain(points=PROFILES[name])
    model, data, radius = hung_wheel(terrain)
    path = wheel_path(terrain, radius)
    for s in np.arange(0.3, path.length - 0.3, 0.0037):
        if np.min(np.abs(path.corners - s), initial=1.0) < 0.002:
            continue
        centre, normal = path.centres(s)[0], path.normals(s)[0]
        data.qpos[:2] = centre - 1e-4 * normal
        mujoco.mj_forward(model, data)
        assert data.ncon >= 1
        # The deepest contact is the true one; near an edge the neighbour touches a little, too.
        deepest = min(data.contact, key=lambda contact: contact.dist)
        assert deepest.dist == pytest.approx(-1e-4, abs=2e-6)
        assert abs(deepest.frame[:3][[0, 2]] @ normal) > math.cos(0.005)
        for contact in data.contact:
            assert abs(contact.frame[:3][[0, 2]] @ normal) > math.cos(0.07)


def test_wheel_rolls_over_box_seams_without_a_bump() -> None:
    """False contacts at seams would throw the wheel up or stop it.

    A soft contact sinks 0.3 mm, so that each of the 20 seams takes a little speed; no more.
    """
    points = [(-1.0, 0.0)] + [(x, 1e-9 * (-1) ** i) for i, x in enumerate(np.arange(0, 1, 0.05))]
    terrain = Terrain(points=[*points, (3.0, 0.0)])
    model, data, radius = hung_wheel(terrain)
    data.qpos[:2] = -0.5, radius
    data.qvel[:] = 0.5, 0.0, 0.5 / radius
    heights = []
    for _ in range(3000):
        mujoco.mj_step(model, data)
        heights.append(data.qpos[1])
    assert data.qpos[0] == pytest.approx(0.95, abs=0.06)
    assert np.ptp(heights) < 5e-4
    assert max(heights) <= radius + 1e-6


def test_wheel_rolls_down_a_ramp_as_physics_says() -> None:
    angle = math.radians(20)
    terrain = Terrain(points=[(0.0, 0.0), (4.0, -4.0 * math.tan(angle))])
    model, data, radius = hung_wheel(terrain)
    path = wheel_path(terrain, radius)
    start = 1.0
    data.qpos[:2] = path.centres(np.array([start]))[0]
    for _ in range(1000):
        mujoco.mj_step(model, data)
    inertia_share = 1.0 + 0.00375 / (3.0 * radius**2)
    expected = 0.5 * 9.81 * math.sin(angle) / inertia_share
    rolled = path.project(data.qpos[:2]) - start
    assert rolled == pytest.approx(expected, rel=0.01)


def test_a_spike_becomes_a_thin_prism() -> None:
    terrain = Terrain(points=[(-1, 0), (0, 0), (0, 0.4), (0, 0), (1, 0)])
    shapes = prisms(terrain)
    assert len(shapes) == 5  # with level ground beyond both ends
    thin = min(shapes, key=lambda outline: np.ptp(outline[:, 0]))
    assert np.ptp(thin[:, 0]) == pytest.approx(0.002)
    assert thin[:, 1].max() == 0.4
    build_model(load_robot("a1_wheeled"), terrain)
