"""Robots that do not roll on the level, or lack many times what they have: the reason is true."""

from __future__ import annotations

from typing import Any

import pytest

import stairwright as sw

LEVEL = {"points": [[-1.5, 0.0], [1.5, 0.0]]}
CURB = "curb-015"


def robot(**changes: Any) -> dict[str, Any]:
    """The A1 with other parts."""
    data = sw.load_robot("a1_wheeled").model_dump(mode="json")
    for part, values in changes.items():
        data[part] |= values
    return data


def thighs(low: float) -> dict[str, Any]:
    legs = sw.load_robot("a1_wheeled").joints.model_dump(mode="json")
    return robot(joints={end: legs[end] | {"thigh": [low, 2.9]} for end in ("front", "rear")})


def thick_thighs(hips: float) -> dict[str, Any]:
    return robot(thigh={"radius": 0.13}, hips={"front": [hips, 0.0], "rear": [-hips, 0.0]})


@pytest.mark.slow
def test_thighs_that_cannot_swing_to_the_ground():
    problem = sw.plan(LEVEL, thighs(2.0)).problem
    assert (problem.kind, problem.limit.quantity) == ("joint_limit", "thigh range")
    assert problem.limit.available == pytest.approx(0.9)
    # Half of what is missing is added at each end.
    half = 0.5 * (problem.limit.needed - problem.limit.available)
    assert sw.plan(LEVEL, thighs(2.0 - 1.05 * half)).feasible
    assert not sw.plan(LEVEL, thighs(2.0 - 0.95 * half)).feasible


@pytest.mark.slow
def test_legs_that_touch_each_other_however_they_stand():
    hips = sw.load_robot("a1_wheeled").hips.front[0]
    problem = sw.plan(LEVEL, thick_thighs(hips)).problem
    assert (problem.kind, problem.limit.quantity) == ("clearance", "distance of the hips")
    assert problem.limit.available == pytest.approx(2 * hips)
    assert sw.plan(LEVEL, thick_thighs(0.5 * 1.02 * problem.limit.needed)).feasible
    assert not sw.plan(LEVEL, thick_thighs(0.5 * 0.98 * problem.limit.needed)).feasible


@pytest.mark.slow
def test_wheel_motors_of_a_seventh_of_what_is_needed():
    def weak(torque: float) -> dict[str, Any]:
        actuators = sw.load_robot("a1_wheeled").actuators.model_dump(mode="json")
        return robot(actuators={"wheel": actuators["wheel"] | {"torque": torque}})

    problem = sw.plan(CURB, weak(0.05)).problem
    assert (problem.kind, problem.limit.quantity) == ("torque", "wheel torque")
    assert sw.plan(CURB, weak(1.02 * problem.limit.needed)).feasible
    assert not sw.plan(CURB, weak(0.98 * problem.limit.needed)).feasible


@pytest.mark.slow
@pytest.mark.parametrize(
    ("quantity", "part", "values"),
    [
        ("payload", "payload", {"mass": 60.0, "place": [0.4, 0.1]}),
        ("trunk CoM offset", "trunk", {"com": [-0.5, 0.0, 0.0]}),
    ],
)
def test_a_mass_centre_that_no_wheels_stand_under(quantity, part, values):
    def asked(share: float) -> sw.Plan:
        data = sw.load_robot("go2w").model_dump(mode="json")
        changed = dict(values)
        if part == "payload":
            changed["mass"] *= share
        else:
            changed["com"] = [share * values["com"][0], 0.0, 0.0]
        data[part] = (data.get(part) or {}) | changed
        return sw.plan(LEVEL, data)

    problem = asked(1.0).problem
    assert (problem.kind, problem.limit.quantity) == ("statics", quantity)
    share = problem.limit.needed / problem.limit.available
    assert asked(0.98 * share).feasible
    assert not asked(1.02 * share).feasible


@pytest.mark.parametrize(("motor", "part"), [("leg", "thigh"), ("wheel", "wheel")])
@pytest.mark.parametrize("method", ["path", "critical", "nominal"])
def test_motors_too_slow_to_be_controlled(motor, part, method):
    def slow(speed: float) -> sw.Plan:
        actuators = sw.load_robot("a1_wheeled").actuators.model_dump(mode="json")
        limited = robot(actuators={motor: actuators[motor] | {"speed": speed}})
        return sw.plan(LEVEL, limited, method=method)

    problem = slow(0.1).problem
    assert (problem.kind, problem.limit.quantity) == ("start", f"{part} motor speed")
    assert (problem.limit.available, problem.limit.unit) == (0.1, "rad/s")
    assert slow(problem.limit.needed).feasible
    assert not slow(0.98 * problem.limit.needed).feasible
