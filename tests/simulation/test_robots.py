"""Robots of other sizes and masses than the library's climb what their plans say they can."""

from typing import Any

import pytest

import stairwright as sw

DOWN_UP_DOWN = [(-2.0, 0.0), (0.0, 0.0), (0.0, -0.114), (0.64, -0.114), (0.64, -0.013),
                (0.95, -0.013), (0.95, -0.302), (3.4, -0.302)]  # fmt: skip
HILL = [(-2.0, 0.0), (0.0, 0.0), (0.0, 0.265), (0.3, 0.265), (0.3, 0.437), (0.91, 0.437),
        (0.91, 0.201), (1.43, 0.201), (1.43, 0.013), (3.9, 0.013)]  # fmt: skip


def scaled(name: str, legs: float, trunk: float, mass: float) -> dict[str, Any]:
    """A library robot with longer legs, a larger trunk and heavier parts; its gains stay."""
    robot = sw.load_robot(name).model_dump()
    for part in ("thigh", "calf", "wheel", "trunk"):
        size = {"thigh": legs, "calf": legs, "wheel": 1.2, "trunk": trunk}[part]
        robot[part]["mass"] *= mass
        robot[part]["inertia"] = [v * mass * size**2 for v in robot[part]["inertia"]]
    for part in ("thigh", "calf"):
        robot[part]["length"] *= legs
    robot["wheel"]["radius"] *= 1.2
    robot["nominal_height"] *= legs
    robot["trunk"]["size"] = [v * trunk for v in robot["trunk"]["size"]]
    robot["hips"] = {
        "front": [robot["hips"]["front"][0] * trunk, 0.0],
        "rear": [robot["hips"]["rear"][0] * trunk, 0.0],
        "half_track": robot["hips"]["half_track"] * trunk,
    }
    robot["actuators"]["leg"]["torque"] *= mass * legs
    return robot


@pytest.mark.slow
@pytest.mark.parametrize(
    ("robot", "points", "friction"),
    [
        # One pair carries nearly all of 41 kg: more than the force limit of the library's robots.
        (scaled("a1_wheeled", 1.43, 1.31, 3.5), DOWN_UP_DOWN, 0.5),
        # High on a narrow track, with joints that are soft for it: rolled over sideways.
        (scaled("a1_wheeled_x", 1.48, 0.83, 1.5), HILL, 0.35),
    ],
    ids=["heavy", "high and narrow"],
)
def test_what_is_planned_is_climbed(robot, points, friction):
    plan = sw.plan({"points": points}, robot, friction=friction)
    assert plan.feasible
    assert sw.rollout(plan).outcome == "success"
