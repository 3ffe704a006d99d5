"""The certificate of plans that move: its inverse dynamics are the simulator's, and it refuses."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import linprog

import stairwright as sw
from stairwright import _core
from stairwright.planning.certificate.certify import certify
from stairwright.planning.certificate.dynamics import WINDOW, _Motion, dynamics_of
from stairwright.planning.plan import Plan
from stairwright.planning.pose_arrays import PoseArrays
from stairwright.robot.mujoco_model import build_spec

Floats = NDArray[np.float64]


@pytest.fixture(
    scope="module", params=["a1_wheeled_x", pytest.param("go2w", marks=pytest.mark.slow)]
)
def fast(request: pytest.FixtureRequest) -> Plan:
    return sw.plan("three-stairs-up", request.param, timing="fast")


def _pose(plan: Plan, time: float) -> Floats:
    """Generalised coordinates (18,) by Euler angle: x, z, pitch, joints front, rear, by leg."""
    at = np.array([pose.time for pose in plan.poses])

    def value(columns: Floats) -> Floats:
        return np.array([np.interp(time, at, column) for column in columns.T])

    trunk = value(np.array([(p.x_c, p.z_c, p.pitch) for p in plan.poses]))
    joints = value(np.array([p.q for p in plan.poses]))
    rolled = value(np.array([p.wheel_progress for p in plan.poses]))
    spin = rolled / plan.robot_description.wheel.radius
    out = [*trunk]
    for pair in (0, 0, 1, 1):
        thigh, calf = joints[2 * pair : 2 * pair + 2]
        # The wheel's own joint turns against the calf.
        out += [thigh, calf, spin[pair] - trunk[2] - thigh - calf]
    return np.array(out)


def test_its_inverse_dynamics_are_the_simulators(fast: Plan) -> None:
    """Forces that MuJoCo says the ground and the motors must give, against those judged."""
    robot = fast.robot_description
    model = build_spec(robot, fast.terrain, 0.6, half_width=1.0, visual=False).compile()
    model.dof_damping[:] = 0.0
    model.dof_frictionloss[:] = 0.0
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_LIMIT)
    data = mujoco.MjData(model)
    poses = PoseArrays.of(fast)
    motion = _Motion.of(fast.robot_description, poses, poses.time)
    for i in range(30, len(fast.poses) - 30, 29):
        now = fast.poses[i].time
        low, middle, high = (_pose(fast, now + side) for side in (-WINDOW, 0.0, WINDOW))
        rate, second = (high - low) / (2 * WINDOW), (high - 2 * middle + low) / WINDOW**2
        x, z, pitch = middle[:3]
        data.qpos[:3], data.qpos[3:7] = (x, 0, z), (np.cos(pitch / 2), 0, np.sin(pitch / 2), 0)
        data.qpos[7:], data.qvel[6:], data.qacc[6:] = middle[3:], rate[3:], second[3:]
        data.qvel[:6] = rate[0], 0, rate[1], 0, rate[2], 0
        data.qacc[:6] = second[0], 0, second[1], 0, second[2], 0
        mujoco.mj_inverse(model, data)
        force = data.qfrc_inverse
        com = np.array(fast.poses[i].com)
        moment = force[4] - (com[1] - z) * force[0] + (com[0] - x) * force[2]
        # Differences of a place are not exactly its derivatives where the robot turns.
        weight = robot.mass * 9.81
        expected = (force[0], force[2], moment)
        assert motion.loads[i] == pytest.approx(expected, abs=0.015 * weight)
        legs = force[6:].reshape(4, 3)[[0, 2]].ravel()
        assert motion.torques[i] == pytest.approx(legs, abs=0.015 * weight)


def test_it_passes_and_says_what_was_judged(fast: Plan) -> None:
    names = {check.name for check in certify(fast).checks}
    assert {"poses out of dynamic balance", "share of the motors in motion"} <= names
    assert fast.certificate == certify(fast)
    assert certify(fast).passed


def test_standing_takes_what_statics_say(fast: Plan) -> None:
    """Driven very slowly there is no inertia: everything balances with static shares."""
    slow = dynamics_of(fast, 100.0 * np.array([pose.time for pose in fast.poses]))
    assert not slow.out_of_balance.any()
    limits = fast.robot_description.torque_limits[:, :2].max()
    least = np.array([1.0 - pose.margins.torque / limits for pose in fast.poses])
    assert (slow.share <= least + 0.02).all()


def _hurried(plan: Plan, factor: float) -> Plan:
    poses = [p.model_copy(update={"time": p.time / factor}) for p in plan.poses]
    return plan.model_copy(update={"poses": poses})


def test_a_plan_that_is_driven_too_fast_is_refused(fast: Plan) -> None:
    verdict = certify(_hurried(fast, 4.0))
    assert not verdict.passed
    failed = {check.name for check in verdict.checks if not check.passed}
    assert failed <= {"poses out of dynamic balance", "share of the motors in motion"}


def test_time_that_stands_still_is_refused(fast: Plan) -> None:
    poses = list(fast.poses)
    poses[20] = poses[20].model_copy(update={"time": poses[19].time})
    verdict = certify(fast.model_copy(update={"poses": poses}))
    assert [check.name for check in verdict.checks if not check.passed] == ["least step of time"]


def _least_share(
    wrenches: Floats, torques: Floats, load: Floats, free: Floats, lowest: Floats, highest: Floats
) -> tuple[float, float]:
    """Of one pose by SciPy: forces (12,), the share, and what is missed each way (6,)."""
    none = np.zeros((6, 6))
    balance = np.hstack([wrenches.T, np.zeros((3, 1)), np.eye(3), -np.eye(3)])
    motors = np.vstack(
        [np.column_stack([torques.T, -highest, none]), np.column_stack([-torques.T, lowest, none])]
    )
    together = np.concatenate([np.ones(12), np.zeros(7)])
    cost = np.concatenate([np.zeros(12), [1.0], np.full(6, 100.0)])
    best = linprog(
        cost, np.vstack([motors, together]), np.concatenate([-free, free, [10.0]]), balance, load
    )
    return best.x[12], best.x[13:].max()


def test_the_least_share_of_the_motors_is_scipys() -> None:
    """Some with few contacts, some out of balance, some of motors that turn at full speed."""
    rng = np.random.default_rng(11)
    n = 200
    wrenches, torques = rng.normal(size=(n, 12, 3)), 20.0 * rng.normal(size=(n, 12, 6))
    contact = (rng.random((n, 12)) < rng.random(n)[:, None])[..., None]
    load, free = rng.normal(size=(n, 3)), 5.0 * rng.normal(size=(n, 6))
    limit = np.where(rng.random((2, n, 6)) < 0.1, 1e-3, 1.0) * rng.uniform(5.0, 50.0, (2, n, 6))
    given = (wrenches * contact, torques * contact, load, free, -limit[0], limit[1])
    share, missed = _core.certificate_least_share(*given)
    expected = np.array([_least_share(*each) for each in zip(*given, strict=True)])
    assert 20 < (expected[:, 1] > 1e-6).sum() < n - 20
    assert share == pytest.approx(expected[:, 0], rel=1e-6, abs=1e-6)
    assert missed == pytest.approx(expected[:, 1], rel=1e-6, abs=1e-6)


def test_forces_that_press_a_wheel_between_two_faces_are_bounded() -> None:
    """Up an edge on one side, against a riser on the other: all but opposite, and of any size."""
    wrenches, torques = np.zeros((12, 3)), np.zeros((12, 6))
    wrenches[:4] = [
        [1.0007, 0.7992, -0.3819], [-0.56, 1.1517, 0.049], [-1.0, 0.8, 0.1194], [-1.0, -0.8, 0.3819]
    ]  # fmt: skip
    wrenches[6:8] = [[0.8, 1.0, -0.1078], [-0.8, 1.0, 0.1714]]
    torques[:4, :3] = [
        [22.6951, 16.7754, 2.323], [-14.5966, -2.5831, -2.323],
        [-18.9078, -4.2931, 2.323], [-22.6809, -16.7725, -2.323],
    ]  # fmt: skip
    torques[6:8, 3:] = [[15.05, 14.2371, 2.323], [-5.3311, 8.9805, -2.323]]
    load, free = np.array([-0.0004, 1.0012, 0.0001]), np.array([0.4, -0.5, 0.0, -0.1, -1.3, 0.0])
    limits = np.full(6, 33.5)
    given = (wrenches, torques, load, free, -limits, limits)
    share, missed = _core.certificate_least_share(*(each[None] for each in given))
    expected, _ = _least_share(*given)
    assert share == pytest.approx(expected, rel=1e-6)
    assert missed == pytest.approx(0.0, abs=1e-9)


def test_a_least_share_needs_as_many_of_each_as_poses() -> None:
    six = np.ones((1, 6))
    with pytest.raises(ValueError, match="as many of each"):
        _core.certificate_least_share(
            np.zeros((2, 12, 3)), np.zeros((1, 12, 6)), np.zeros((1, 3)), six, -six, six
        )
