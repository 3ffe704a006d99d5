import numpy as np
import pytest

import stairwright as sw
from stairwright._core import GRAVITY
from stairwright.errors import InputError
from stairwright.planning.interpolation import reference
from tests.shapely_checker import check

A1S = ("a1_wheeled", "a1_wheeled_x")

CASES = [(t, r) for r in A1S for t in ("ramp-30deg-025", "single-stair-036", "curb-015")]


@pytest.mark.parametrize(("terrain", "robot"), CASES)
def test_curve_keeps_contact_and_clearance(terrain, robot):
    plan = sw.plan(terrain, robot, method="critical")
    samples = reference(plan)
    for i in range(0, len(samples.time), 3):
        verdict = check(
            plan.robot_description, plan.terrain.vertices, *samples.trunk[i], samples.q[i]
        )
        assert verdict.wheel_gap < 1e-4
        assert verdict.clearance > 0.0
        assert verdict.joint_slack > -1e-9
    assert np.abs(np.diff(samples.q, axis=0)).max() < 0.2


def test_joint_mode_is_equations_23_and_24():
    plan = sw.plan("single-stair-036", method="critical")
    samples = reference(plan, "joint", joint_rate=None)
    a, b = plan.poses[1], plan.poses[2]
    middle = np.argmin(np.abs(samples.time - (a.time + b.time) / 2))
    share = (samples.time[middle] - a.time) / (b.time - a.time)
    assert samples.q[middle] == pytest.approx((1 - share) * np.array(a.q) + share * np.array(b.q))
    assert samples.trunk[middle, 2] == pytest.approx((1 - share) * a.pitch + share * b.pitch)


@pytest.mark.parametrize(("terrain", "mode"), [("three-stairs-up", "joint"), ("ramp-1-8", "curve")])
def test_reference_passes_through_the_poses(terrain, mode):
    """Where no pose has to move aside for balance or clearance."""
    plan = sw.plan(terrain, method="critical")
    samples = reference(plan, mode)
    for pose in plan.poses:
        i = int(np.argmin(np.abs(samples.progress - pose.progress)))
        assert samples.progress[i] == pytest.approx(pose.progress)
        assert samples.q[i] == pytest.approx(pose.q, abs=1e-6)
        assert samples.trunk[i] == pytest.approx([pose.x_c, pose.z_c, pose.pitch], abs=1e-6)
        assert samples.wheel_progress[i] == pytest.approx(pose.wheel_progress)
        assert samples.com[i] == pytest.approx(pose.com, abs=1e-6)


@pytest.mark.parametrize("method", ["critical", "nominal", "path"])
def test_all_methods(method):
    plan = sw.plan("curb-015", method=method)
    samples = reference(plan)
    assert np.all(np.diff(samples.progress) > 0)
    assert np.all(np.diff(samples.time) > 0)
    assert samples.duration >= plan.poses[-1].time - plan.poses[0].time - 1e-6
    rate = np.abs(np.diff(samples.q, axis=0)).max(axis=1) / np.diff(samples.time)
    assert rate.max() <= 1.5 + 1e-6
    assert np.diff(samples.progress).max() <= 0.005 + 1e-9
    for name in ("progress", "time", "trunk", "q", "wheel_progress", "com", "normals", "forces"):
        assert np.all(np.isfinite(getattr(samples, name)))


def test_forces_balance_the_weight():
    plan = sw.plan("ramp-30deg-025", method="critical")
    samples = reference(plan)
    n = samples.normals
    tangents = np.stack([n[..., 1], -n[..., 0]], axis=-1)
    world = samples.forces[..., :1] * tangents + samples.forces[..., 1:] * n
    weight = plan.robot_description.mass * GRAVITY
    assert np.allclose(world.sum(axis=1), [0.0, weight], atol=1e-6)
    moment = samples.contacts[..., 0] * world[..., 1] - samples.contacts[..., 1] * world[..., 0]
    assert np.allclose(moment.sum(axis=1), weight * samples.com[:, 0], atol=1e-6)


def test_one_pose_is_no_trajectory():
    plan = sw.plan("curb-015", method="critical")
    with pytest.raises(InputError, match="two poses"):
        reference(plan.model_copy(update={"poses": plan.poses[:1]}))
