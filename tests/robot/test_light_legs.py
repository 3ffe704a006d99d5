"""Robots whose legs are far lighter than what they carry: gains and contacts suit them, too."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest

import stairwright as sw
from stairwright.robot.mujoco_model import build_model

PERIOD = 2  # physics steps of 1 ms between two of the controller
FLAT = sw.Terrain(points=[(-1.0, 0.0), (1.0, 0.0)])


def lighter(name: str, share: float) -> sw.Robot:
    """The preset with legs of `share` of their mass, rotors included, and default gains."""
    data = sw.load_robot(name).model_dump()
    for part in ("thigh", "calf", "wheel"):
        data[part]["mass"] *= share
        data[part]["inertia"] = [share * moment for moment in data[part]["inertia"]]
    for motor in data["actuators"].values():
        motor |= {"armature": share * motor["armature"], "damping": 0.0}
    changes: dict[str, Any] = {"schema": "stairwright/robot/2", "gains": None}
    return sw.Robot.model_validate(data | changes)


@pytest.mark.parametrize("name", ["a1_wheeled", "b2w", "d1", "m20"])
@pytest.mark.parametrize("share", [1.0, 0.03])
def test_a_leg_in_the_air_comes_to_rest(name: str, share: float) -> None:
    robot = lighter(name, share)
    model = build_model(robot)
    model.opt.gravity[:] = 0.0
    data = mujoco.MjData(model)
    # As straight as its range allows: there hip and knee together show the least inertia.
    wanted = np.zeros(12)
    for k, leg in enumerate(robot.legs[i] for i in (0, 0, 1, 1)):
        wanted[3 * k + 1] = leg.knee * (min(map(abs, leg.limits.calf)) + 0.2)
    data.qpos[7:] = wanted
    data.qvel[7::3] = 0.5
    gains = robot.feedback
    stiffness = np.array([gains.joint_stiffness, gains.joint_stiffness, 0.0] * 4)
    damping = np.array([gains.joint_damping, gains.joint_damping, gains.wheel_damping] * 4)
    for _ in range(500):
        data.ctrl[:] = stiffness * (wanted - data.qpos[7:]) - damping * data.qvel[6:]
        mujoco.mj_step(model, data, PERIOD)
    assert np.abs(data.qvel[6:]).max() < 0.05


def test_contacts_of_the_presets_are_mujocos_own() -> None:
    for name in ("a1_wheeled", "b2w", "anymal_wheels"):
        model = build_model(sw.load_robot(name), FLAT)
        assert np.all(model.geom_solimp == [0.9, 0.95, 0.001, 0.5, 2.0])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["anymal_wheels", "b2w"])
def test_wheels_of_light_legs_creep_no_farther(name: str) -> None:
    """On MuJoCo's own contacts they end 10 to 13 cm from where the plan does."""
    run = sw.rollout(sw.plan("ramp-1-8", lighter(name, 0.1)))
    assert run.outcome == "success", run.reason
    assert run.metrics.end_error < 0.01
