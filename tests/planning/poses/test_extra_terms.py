"""Cost terms and constraints of the user."""

import re
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

import stairwright as sw
from stairwright.errors import InputError

STAIR = "single-stair-036"


def optimal(plan):
    assert plan.feasible, plan.problem
    return [plan.poses[k] for k in plan.critical]


def test_both_solvers_find_the_same_poses():
    native, ipopt = (sw.plan(STAIR, method="critical", solver=s) for s in ("native", "ipopt"))
    for a, b in zip(optimal(native), optimal(ipopt), strict=True):
        assert np.allclose(a.q, b.q, atol=2e-3)
        assert np.allclose([a.x_c, a.z_c, a.pitch], [b.x_c, b.z_c, b.pitch], atol=2e-3)


@pytest.mark.slow
def test_a_cost_term_draws_the_poses():
    plain = sw.plan(STAIR, method="critical", solver="ipopt")
    level = sw.plan(STAIR, method="critical", extra_cost=lambda pose: 50 * pose.pitch**2)
    tilt = [sum(abs(pose.pitch) for pose in optimal(plan)) for plan in (plain, level)]
    assert tilt[1] < 0.8 * tilt[0]


@pytest.mark.slow
def test_constraints_are_kept():
    plain = sw.plan(STAIR, method="critical", solver="ipopt")
    highest = max(pose.z_c for pose in optimal(plain)[:1])

    def high_trunk(pose):
        return [pose.z - (highest + 0.03), ca.fmin(pose.q[0] + 4, 1)]

    raised = sw.plan(STAIR, method="critical", extra_constraints=high_trunk)
    assert all(pose.z_c >= highest + 0.03 - 1e-6 for pose in optimal(raised))
    assert raised.certificate.passed


def test_points_are_those_of_the_pose():
    seen = []

    def knee(pose):
        seen.append(pose)
        return pose.knees[0][1] - pose.hips[0][1] + 0.1  # at most 0.1 m below the hip

    pose = optimal(sw.plan(STAIR, method="critical", extra_constraints=knee))[0]
    assert seen
    robot = sw.load_robot("a1_wheeled")
    thigh = pose.pitch + pose.q[0]
    assert robot.thigh.length * np.cos(thigh) <= 0.1 + 1e-5


@pytest.mark.slow
def test_what_cannot_be_kept_is_infeasible():
    low = "curb-015"  # has fewer poses
    plan = sw.plan(low, method="critical", extra_constraints=lambda pose: -1 - pose.pitch**2)
    assert not plan.feasible
    assert plan.problem is not None


def test_the_documented_example_runs():
    text = (Path(__file__).parents[3] / "docs" / "method.md").read_text()
    (example,) = (code for code in re.findall(r"```python\n(.*?)```", text, re.DOTALL))
    names = {}
    exec(compile(example, "docs/method.md", "exec"), names)
    poses = optimal(names["plan"])
    plain = optimal(sw.plan(STAIR, method="critical"))
    assert sum(abs(p.pitch) for p in poses) < sum(abs(p.pitch) for p in plain)


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ({"method": "path", "extra_cost": lambda pose: pose.x}, "extra_cost"),
        ({"method": "path", "solver": "ipopt"}, "solver"),
        ({"method": "critical", "solver": "snopt"}, "solver"),
        ({"method": "critical", "solver": "native", "extra_cost": lambda pose: 0}, "solver"),
        ({"method": "critical", "extra_cost": lambda pose: "much"}, "extra_cost"),
        ({"method": "critical", "extra_cost": lambda pose: [pose.x, pose.z]}, "extra_cost"),
        (
            {"method": "critical", "extra_cost": lambda pose: ca.vertcat(1, 2) * pose.x},
            "extra_cost",
        ),
        ({"method": "critical", "extra_constraints": lambda pose: None}, "extra_constraints"),
    ],
)
def test_bad_terms_are_named(arguments, field):
    with pytest.raises(InputError) as error:
        sw.plan(STAIR, **arguments)
    assert field in str(error.value)
