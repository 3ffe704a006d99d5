"""What lists tell of results."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright.jobs import summaries


def test_a_run_that_failed_is_drawn_where_it_ended() -> None:
    plan = sw.plan("three-stairs-up", "a1_wheeled_x", method="nominal")
    run = sw.rollout(plan)
    assert not run.success
    pose = summaries.of_rollout(run, plan)["pose"]
    end = run.series.base_position[-1]
    assert pose != summaries.of_plan(plan)["pose"]
    assert (pose["x"], pose["z"]) == pytest.approx((end[0], end[2]), abs=6e-4)
    assert pose["pitch"] == pytest.approx(run.series.pitch[-1], abs=6e-4)
    joints = dict(zip(("FL", "FR", "RL", "RR"), run.series.q[-1].reshape(4, 3), strict=True))
    front, rear = joints["FL"] + joints["FR"], joints["RL"] + joints["RR"]
    assert pose["q"] == pytest.approx(np.array([*front[:2], *rear[:2]]) / 2, abs=6e-4)


def test_a_run_that_arrived_is_drawn_where_its_plan_is_tightest() -> None:
    plan = sw.plan("curb-015", "a1_wheeled_x", timing="fast")
    run = sw.rollout(plan)
    assert run.success
    assert summaries.of_rollout(run, plan)["pose"] == summaries.of_plan(plan)["pose"]
