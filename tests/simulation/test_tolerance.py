"""Plans with a tolerance, carried out at corners of the set that their certificate holds for."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw

STAIRS = {
    "points": [[-1.2, 0], [0, 0], [0, 0.16], [0.3, 0.16], [0.3, 0.32], [0.6, 0.32], [0.6, 0.48],
               [1.8, 0.48]],
    "friction": 0.6,
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_a_robot_with_its_own_sensors_stands_what_was_asked(seed: int) -> None:
    asked = {"height": 0.01, "place": 0.01, "friction": 0.1}
    plan = sw.plan(STAIRS, "a1_wheeled_x", tolerance=asked)
    assert plan.feasible, plan.problem
    signs = np.random.default_rng(seed).choice([-1.0, 1.0], (2, 3))
    world = {
        "step_height_error": (asked["height"] * signs[0]).tolist(),
        "face_place_error": (asked["place"] * signs[1]).tolist(),
        "friction": -asked["friction"],
    }
    run = sw.rollout(plan, disturbance=world, seed=seed, controller={"sensing": "robot"})
    assert run.success, run.reason
    assert run.metrics.link_contacts == 0
