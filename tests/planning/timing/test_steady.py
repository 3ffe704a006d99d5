"""Steady plans of robots with weak motors: slow enough for what moving takes beside standing."""

from __future__ import annotations

import numpy as np

import stairwright as sw
from stairwright.planning.certificate.dynamics import dynamics_of
from stairwright.planning.timing.steady import STRAINED, retimed, slowed_where_strained


def shares(plan: sw.Plan, torque: float) -> np.ndarray:
    """What standing takes of a leg motor (n,); all of these motors are alike."""
    return 1.0 - np.array([pose.margins.torque for pose in plan.poses]) / torque


def test_motion_fits_beside_standing() -> None:
    data = sw.load_robot("a1_wheeled").model_dump()
    data["actuators"]["leg"]["torque"] *= 0.30
    weak = sw.Robot.model_validate(data)
    plan = sw.plan("stairs-us-7-11", weak, friction=0.6)
    effort = shares(plan, weak.torque_limits[0, 0])
    assert effort.max() > STRAINED
    strained = np.flatnonzero(effort > STRAINED)
    strong = plan.model_copy(update={"robot_description": sw.load_robot("a1_wheeled")})
    usual = retimed(strong, plan.weights["speed"]).model_copy(update={"robot_description": weak})
    assert dynamics_of(usual, at=strained).share.max() > 1.0
    assert dynamics_of(plan, at=strained).share.max() <= 1.0
    # Elsewhere as fast as ever.
    assert plan.timing.total < 1.3 * usual.timing.total
    steps, before = (np.diff([p.time for p in each.poses]) for each in (plan, usual))
    assert np.median(steps / before) == 1.0


def test_strong_motors_change_nothing() -> None:
    plan = sw.plan("single-stair-030", "a1_wheeled", friction=0.6)
    effort = shares(plan, plan.robot_description.torque_limits[0, 0])
    assert effort.max() < STRAINED
    assert slowed_where_strained(plan, effort) is plan
