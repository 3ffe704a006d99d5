"""Risers that come earlier than the robot's map has them."""

from __future__ import annotations

from typing import Any

import pytest

import stairwright as sw

EARLY = {"x_offset": -0.05}
# The second riser comes 6 cm earlier, against the first one.
NEAR = {"face_place_error": [0.03, -0.03, 0.03, 0.03]}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("terrain", "robot", "deviation"),
    [
        pytest.param("single-stair-036", "a1_wheeled_x", EARLY, id="thigh"),
        pytest.param("single-stair-036", "go2w", EARLY, id="trunk"),
        pytest.param("stairs-industrial", "b2w", NEAR, id="unnoticed"),
    ],
)
def test_wheels_meet_it_first_and_it_is_noticed(
    terrain: str, robot: str, deviation: dict[str, Any]
) -> None:
    plan = sw.plan(sw.load_terrain(terrain), robot, friction=0.6)
    run = sw.rollout(plan, disturbance=deviation, seed=3)
    assert run.success, run.reason
