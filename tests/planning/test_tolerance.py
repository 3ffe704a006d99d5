"""Plans that ask for a tolerance: what is asked, what comes back, what stays as it was."""

from __future__ import annotations

from typing import Any

import pytest

import stairwright as sw
from stairwright.documents import content_hash
from stairwright.errors import InputError
from stairwright.library import load_robot, load_terrain
from stairwright.planning.certificate.tolerance.checks import NAMES

CURB = {"name": "curb", "points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]], "friction": 0.6}
STAIR = "single-stair-030"
STAIRS = {
    "points": [[-1.5, 0], [0, 0], [0, 0.18], [0.28, 0.18], [0.28, 0.36], [0.56, 0.36],
               [0.56, 0.54], [2.0, 0.54]],
    "friction": 0.6,
}  # fmt: skip
RAMP = {"points": [[-1.5, 0], [0, 0], [0.6, 0.2], [2.0, 0.2]], "friction": 0.6}


def test_a_plan_says_what_it_stands() -> None:
    asked = {"height": 0.02, "place": 0.03, "friction": 0.1}
    plan = sw.plan(CURB, "go2w", tolerance=asked)
    assert plan.feasible, plan.problem
    assert plan.friction == 0.6
    assert plan.tolerance is not None
    assert plan.tolerance.asked == asked
    assert plan.certificate is not None
    assert set(NAMES.values()) <= {check.name for check in plan.certificate.checks}
    assert sw.certify(sw.Plan.model_validate(plan.model_dump())).passed


@pytest.mark.parametrize("nothing", [None, {}, {"height": 0.0}])
def test_who_asks_for_nothing_gets_what_there_was(nothing: dict[str, float] | None) -> None:
    plan = sw.plan(CURB, "a1_wheeled", tolerance=nothing)
    terrain, robot = load_terrain(CURB), load_robot("a1_wheeled")
    texts = [terrain.name, terrain.description, robot.name, robot.description]
    key = [terrain.hash, robot.hash, *texts, 0.6, "path", plan.weights]
    assert plan.id == "p-" + content_hash(key).removeprefix("sha256:")
    assert plan.tolerance is None
    assert plan.poses == sw.plan(CURB, "a1_wheeled").poses
    assert not set(NAMES.values()) & {c.name for c in sw.certify(plan).checks}


def test_each_tolerance_has_an_id_of_its_own() -> None:
    asked = [None, {"friction": 0.1}, {"friction": 0.2}]
    assert len({sw.plan(CURB, "a1_wheeled", tolerance=one).id for one in asked}) == 3


@pytest.mark.slow
def test_motors_that_are_too_weak_off_the_map_are_spared() -> None:
    """With what the usual path leaves them, no margin to the ground helps."""
    wall = {
        "points": [[-2.0, 0], [0, 0], [0, 0.3212], [0.5836, 0.3212], [0.5836, 0], [3.8836, 0]],
        "friction": 0.51,
    }
    plan = sw.plan(wall, "b2w", tolerance={"height": 0.01, "place": 0.02, "friction": 0.05})
    assert plan.feasible, plan.problem
    assert sw.certify(plan).passed
    assert plan.weights == sw.plan(CURB, "b2w").weights


@pytest.mark.slow
def test_friction_alone_is_planned_for() -> None:
    usual = sw.plan(STAIRS, "a1_wheeled_x")
    firm = sw.plan(STAIRS, "a1_wheeled_x", tolerance={"friction": 0.2})
    least = min(pose.margins.friction for pose in firm.poses)
    assert firm.feasible
    assert least >= 0.0  # of what is left of the friction
    assert least + 0.2 > min(pose.margins.friction for pose in usual.poses)


@pytest.mark.slow
def test_too_much_is_told() -> None:
    plan = sw.plan(STAIR, "a1_wheeled", tolerance={"height": 0.05, "place": 0.06})
    assert plan.status == "infeasible"
    problem = plan.problem
    assert problem is not None
    assert "height 0.05, place 0.06" in problem.message
    assert problem.limit is not None
    assert problem.limit.needed == 1.0
    assert 0.0 <= problem.limit.available < 1.0
    assert 0.0 <= problem.at[0] <= 0.6
    assert sw.plan(STAIR, "a1_wheeled").feasible


@pytest.mark.slow
def test_friction_that_is_too_low_is_told_as_ever() -> None:
    plan = sw.plan(RAMP, "a1_wheeled", tolerance={"friction": 0.5})
    assert plan.problem is not None
    assert plan.problem.kind == "statics"
    assert plan.tolerance is not None


@pytest.mark.slow
def test_a_fast_plan_keeps_its_tolerance() -> None:
    plan = sw.plan(CURB, "a1_wheeled", timing="fast", tolerance={"height": 0.01})
    assert plan.feasible, plan.problem
    assert plan.tolerance is not None
    assert plan.certificate == sw.certify(plan)


def test_ground_without_faces_has_nothing_that_could_be_off() -> None:
    plan = sw.plan(
        {**RAMP, "friction": 0.7}, "a1_wheeled", tolerance={"height": 0.03, "place": 0.03}
    )
    assert plan.feasible, plan.problem


@pytest.mark.parametrize(
    ("asked", "method", "field"),
    [
        ({"width": 0.1}, "path", ("tolerance", "width")),
        ({"height": -0.1}, "path", ("tolerance", "height")),
        ({"height": 0.5}, "path", ("tolerance", "height")),
        ({"height": float("nan")}, "path", ("tolerance", "height")),
        ({"friction": 0.6}, "path", ("tolerance", "friction")),
        ({"friction": 0.1}, "critical", ("tolerance",)),
        ({"friction": 0.1}, "nominal", ("tolerance",)),
        (3, "path", ("tolerance",)),
    ],
)
def test_what_is_none_is_refused(asked: Any, method: Any, field: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as refused:
        sw.plan({**CURB, "friction": 0.5}, "a1_wheeled", method=method, tolerance=asked)
    assert refused.value.field == field
