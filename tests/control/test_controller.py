"""Equations of the controller; tests/native compares its native form with the plain one."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

from stairwright import load_robot, load_terrain, robots
from stairwright.control import balance, rigid_body, rolling, tracking
from stairwright.control.contact import AFTER, BEFORE, face_normal, support
from stairwright.control.inertial_loads import friction_loads
from stairwright.control.measurement import measure
from stairwright.control.setpoint import FORCES, RATES, WIDTH, Setpoint
from stairwright.control.settings import ControllerSettings, parse_settings
from stairwright.errors import InputError
from stairwright.robot import kinematics
from stairwright.robot.description import LEGS
from stairwright.robot.mujoco_model import build_model
from stairwright.terrain.wheel_path import wheel_path


def random_state(robot, random: np.random.Generator):
    qpos, qvel = np.empty(19), random.normal(0, 0.5, 18)
    qpos[:3] = random.uniform(-0.8, 0.8), random.normal(0, 0.1), random.uniform(0.3, 0.7)
    angles = random.normal(0, 0.15, 3)
    angles[1] += random.uniform(-1.5, 1.5)
    mujoco.mju_euler2Quat(qpos[3:7], angles, "xyz")
    legs = random.uniform(*kinematics.limits(robot).T, (2, 4)).reshape(4, 2)[[0, 2, 1, 3]]
    qpos[7:] = np.column_stack([legs, random.normal(0, 3, 4)]).ravel()
    return qpos, qvel


@pytest.mark.parametrize("name", robots())
def test_measurement_equals_the_simulators(name: str) -> None:
    robot = load_robot(name)
    model = build_model(robot)
    data = mujoco.MjData(model)
    random = np.random.default_rng(0)
    for _ in range(50):
        qpos, qvel = random_state(robot, random)
        data.qpos[:], data.qvel[:] = qpos, qvel
        mujoco.mj_forward(model, data)
        mujoco.mj_subtreeVel(model, data)
        state = measure(robot, qpos, qvel)
        for part, places in (("thigh", state.hips), ("calf", state.knees), ("wheel", state.wheels)):
            true = [data.body(f"{leg}_{part}").xpos[[0, 2]] for leg in LEGS]
            np.testing.assert_allclose(places, true, atol=1e-9)
        np.testing.assert_allclose(state.com, data.subtree_com[1][[0, 2]], atol=1e-9)
        np.testing.assert_allclose(state.com_velocity, data.subtree_linvel[1][[0, 2]], atol=1e-9)


def test_inertia_is_the_simulators() -> None:
    """A rigid robot that turns about y: angular momentum over rate."""
    robot = load_robot("a1_wheeled")
    model = build_model(robot)
    data = mujoco.MjData(model)
    data.qpos[3] = 1.0
    data.qpos[7:] = np.tile([0.8, -1.6, 0.0], 4)
    data.qvel[4] = 1.0
    mujoco.mj_forward(model, data)
    mujoco.mj_subtreeVel(model, data)
    state = measure(robot, data.qpos, data.qvel)
    assert state.inertia == pytest.approx(data.subtree_angmom[1][1], rel=1e-9)


def test_heading_has_no_singularity_at_vertical_pitch() -> None:
    robot = load_robot("a1_wheeled")
    qpos, qvel = np.zeros(19), np.zeros(18)
    for pitch in (-2.0, -math.pi / 2, 0.0, 1.0, math.pi / 2):
        for yaw in (-0.3, 0.0, 0.2):
            a = [math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)]
            b = [math.cos(pitch / 2), 0.0, math.sin(pitch / 2), 0.0]
            mujoco.mju_mulQuat(qpos[3:7], np.array(a), np.array(b))
            state = measure(robot, qpos, qvel)
            assert state.heading == pytest.approx(yaw, abs=1e-12)
            assert math.cos(state.pitch - pitch) > math.cos(0.2)


def test_wrench_of_forces() -> None:
    """A force map equals forces and moments summed one by one (eqs 4-5)."""
    random = np.random.default_rng(1)
    angle = random.uniform(-1.5, 1.5, 4)
    normals = np.column_stack([-np.sin(angle), np.cos(angle)])
    frames = rigid_body.contact_frames(normals)
    levers, F = random.normal(size=(4, 2)), random.normal(size=(4, 2))
    total = np.zeros(3)
    for frame, lever, force in zip(frames, levers, F, strict=True):
        x, z = frame @ force
        total += x, z, lever[1] * x - lever[0] * z
    np.testing.assert_allclose(rigid_body.force_map(frames, levers) @ F.ravel(), total)
    np.testing.assert_allclose(frames[:, :, 0] @ [0, 0], 0)
    assert rigid_body.traction(np.array([0.5]), 0.05) == pytest.approx(10.0)
    # Level ground: tangent forward, normal up; a vertical face ahead: tangent up.
    np.testing.assert_allclose(rigid_body.contact_frames(np.array([[0.0, 1.0]]))[0], np.eye(2))
    wall = rigid_body.contact_frames(np.array([[-1.0, 0.0]]))[0]
    np.testing.assert_allclose(wall[:, 0], [0.0, 1.0])


def test_force_torques_are_the_jacobians() -> None:
    """J' F by virtual work: torque times a small turn is minus force times the wheel's motion."""
    robot = load_robot("a1_wheeled")
    random = np.random.default_rng(2)
    qpos, qvel = random_state(robot, random)
    qpos[3:7] = 1.0, 0.0, 0.0, 0.0
    state = measure(robot, qpos, qvel)
    F = random.normal(size=(4, 2))
    torques = balance.force_torques(state, state.wheels, F)
    for leg in range(4):
        for part in range(2):
            moved = qpos.copy()
            moved[7 + 3 * leg + part] += 1e-6
            shift = (measure(robot, moved, qvel).wheels[leg] - state.wheels[leg]) / 1e-6
            assert torques[leg, part] == pytest.approx(-F[leg] @ shift, abs=1e-5)


def test_leg_weight_is_gravity_of_the_simulator() -> None:
    robot = load_robot("a1_wheeled_x")
    model = build_model(robot)
    data = mujoco.MjData(model)
    qpos, _ = random_state(robot, np.random.default_rng(6))
    qpos[3:7] = 1.0, 0.0, 0.0, 0.0
    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    state = measure(robot, qpos, np.zeros(18))
    expected = data.qfrc_bias[6:].reshape(4, 3)[:, :2]
    np.testing.assert_allclose(balance.leg_weight_torques(robot, state), expected, atol=1e-9)


def test_friction_of_the_motors_is_the_simulators() -> None:
    robot, random = load_robot("go2w"), np.random.default_rng(5)
    model = build_model(robot, load_terrain("flat"), 0.6)
    data = mujoco.MjData(model)
    row = np.zeros(41)
    row[RATES : 2 * RATES] = random.normal(0.0, 2.0, RATES)
    target = Setpoint.from_row(row)
    loads = friction_loads(robot, target)
    data.qvel[4] = target.pitch_rate
    for leg in range(4):
        pair = leg // 2
        thigh, calf = target.q_rate[2 * pair : 2 * pair + 2]
        wheel = target.wheel_speed[pair] / robot.wheel.radius - target.pitch_rate - thigh - calf
        data.qvel[6 + 3 * leg : 9 + 3 * leg] = thigh, calf, wheel
    mujoco.mj_forward(model, data)
    assert np.repeat(loads, 2, axis=0).ravel() == pytest.approx(-data.qfrc_passive[6:])


def test_rolling_and_tracking_laws() -> None:
    assert rolling.wheel_rates(np.array([0.1]), 0.05) == pytest.approx(2.0)
    difference = rolling.yaw_difference(1.0, 0.5, 0.1, 3.0)
    np.testing.assert_allclose(difference, 2.7 * np.array([-1, 1, -1, 1]))
    torque = rolling.wheel_torques(0.6, np.array([2.0]), np.array([1.5]))
    assert torque == pytest.approx(0.3)
    zero = np.zeros((4, 2))
    found = tracking.joint_torques(zero + 1.0, 40.0, 1.0, zero + 0.1, zero, zero + 0.2, zero)
    np.testing.assert_allclose(found, 1.0 + 4.0 + 0.2)


def test_planned_face_at_a_concave_corner() -> None:
    terrain = load_terrain("single-stair-036")
    path = wheel_path(terrain, 0.05)
    corner = float(path.corners[0])

    def normal(measured: float, planned: float):
        return face_normal(path, measured, planned)

    floor, wall = (0.0, 1.0), (-1.0, 0.0)
    np.testing.assert_allclose(normal(corner - 0.01, corner - 0.005), floor, atol=1e-9)
    np.testing.assert_allclose(normal(corner - 0.01, corner + 0.005), wall, atol=1e-9)
    np.testing.assert_allclose(normal(corner + 0.01, corner + 0.02), wall, atol=1e-9)
    np.testing.assert_allclose(normal(corner + 0.005, corner - 0.01), floor, atol=1e-9)
    # Far behind its plan, the wheel counts where it is.
    np.testing.assert_allclose(normal(corner - 0.2, corner + 0.2), floor, atol=1e-9)


def test_a_wheel_off_a_corner_stays_on_the_face_that_the_plan_leans_on() -> None:
    """However far off, while the plan rests in the corner, on either side of it."""
    path = wheel_path(load_terrain("single-stair-036"), 0.05)
    corner = float(path.corners[0])
    floor, wall = (0.0, 1.0), (-1.0, 0.0)
    for lean, side, face, other in ((BEFORE, -1.0, floor, wall), (AFTER, 1.0, wall, floor)):
        for planned in (corner - 1e-4, corner + 1e-4):
            for off in (0.001, 0.011, 0.03):
                out = np.empty(8)
                support(path, corner + side * off, planned, 0.6, lean, out)
                np.testing.assert_allclose(out[:2], face, atol=1e-9)
        # A wheel on the other face gets to that which is leant on once it is in the corner.
        support(path, corner - side * 0.009, corner, 0.6, lean, out)
        np.testing.assert_allclose(out[:2], face, atol=1e-9)
        support(path, corner - side * 0.02, corner - side * 1e-4, 0.6, lean, out)
        np.testing.assert_allclose(out[:2], other, atol=1e-9)


@pytest.mark.parametrize("roll", [0.0, 0.05])
@pytest.mark.parametrize("angles", [(0.0, 0.0), (0.9, 0.5), (1.57, 1.4)])
def test_roll_is_held_by_what_forces_lift(roll: float, angles: tuple[float, float]) -> None:
    """A robot that straddles a block, left wheels farther down its edges than the right ones."""
    robot, settings = load_robot("a1_wheeled"), ControllerSettings()
    qpos, qvel = np.zeros(19), np.zeros(18)
    mujoco.mju_euler2Quat(qpos[3:7], np.array([roll, 0.0, 0.0]), "xyz")
    qpos[7:] = np.tile([0.9, -1.6, 0.0], 4)
    state = measure(robot, qpos, qvel)
    row = np.zeros(WIDTH)
    row[FORCES] = 0.0, 60.0, 0.0, 56.0
    slopes = np.array([*angles, *(-a for a in angles)])
    frames = rigid_body.contact_frames(np.column_stack([np.sin(slopes), np.cos(slopes)]))
    rows, asked = balance.side_differences(robot, settings, state, Setpoint.from_row(row), frames)
    forces = np.linalg.lstsq(rows, asked, rcond=None)[0].reshape(4, 2)
    left, right = np.einsum("nij,nj->ni", frames, forces).reshape(2, 2, 2).transpose(1, 0, 2)
    np.testing.assert_allclose(left[:, 0], right[:, 0], atol=1e-9)
    moment = robot.hips.half_track * (left - right)[:, 1].sum()
    height = state.com[1] - state.wheels[:, 1].mean() + robot.wheel.radius
    wanted = -robot.mass * height**2 * settings.roll_stiffness * state.roll
    assert moment == pytest.approx(wanted, abs=1e-9)


def test_settings_say_what_is_wrong() -> None:
    assert parse_settings(None) == ControllerSettings()
    with pytest.raises(InputError) as caught:
        parse_settings({"alpha": -1.0})
    assert caught.value.field == ("controller", "alpha")
    with pytest.raises(InputError, match="unknown field"):
        parse_settings({"gain": 1.0})


def test_settings_schema_feeds_sliders() -> None:
    for name, entry in ControllerSettings.model_json_schema()["properties"].items():
        assert entry["title"], name
        assert entry["description"], name
        assert "default" in entry, name
        if "enum" not in entry:
            assert {"minimum", "maximum", "unit", "scale"} <= set(entry), name
            assert entry["scale"] in ("log", "linear")


def test_settings_stored_under_the_old_name_of_the_lead_are_read() -> None:
    assert parse_settings({"leash": 0.02}).lead == 0.02
    assert parse_settings({"sensing": "robot"}).lead == 0.03
    with pytest.raises(InputError, match="leash"):
        parse_settings({"leash": 0.02, "maximum_lead": 0.01})
