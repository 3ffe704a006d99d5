"""Risers that are not where the robot's map has them."""

from __future__ import annotations

from typing import Any

import pytest

import stairwright as sw
from stairwright.terrain.stairs import stair

EARLY = {"x_offset": -0.05}
# The second riser comes 6 cm earlier, against the first one.
NEAR = {"face_place_error": [0.03, -0.03, 0.03, 0.03]}
# The same, and the push into its corner is felt on and off.
SLOW = {"face_place_error": [0.03, -0.03, -0.03, -0.03]}
# The fourth one does, and a front knee leads its wheel over the edge.
FOURTH = {"face_place_error": [0.03, 0.03, 0.03, -0.03, 0.03]}
# The second riser is 6 cm farther from the first one than legs reach as planned.
APART = {"face_place_error": [-0.03, 0.03, 0.03]}
# The tread before the third riser is so short that two wheels hardly find room on it.
SHORT = {"face_place_error": [0.03, 0.03, -0.03, 0.03]}
# The third riser comes 6 cm early.
THIRD = [0.03, 0.03, -0.03, 0.03, 0.03]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("terrain", "robot", "deviation"),
    [
        pytest.param("single-stair-036", "a1_wheeled_x", EARLY, id="thigh"),
        pytest.param("single-stair-036", "go2w", EARLY, id="trunk"),
        pytest.param("stairs-industrial", "b2w", NEAR, id="unnoticed"),
        pytest.param("stairs-industrial", "b2w", SLOW, id="hardly noticed"),
        pytest.param("stairs-us-7-11", "a1_wheeled_x", FOURTH, id="calf"),
        pytest.param("three-stairs-up", "a1_wheeled_x", APART, id="out of reach"),
        pytest.param("loading-dock", "a1_wheeled", SHORT, id="wheel on wheel"),
    ],
)
def test_no_leg_meets_it_before_the_wheels_do(
    terrain: str, robot: str, deviation: dict[str, Any]
) -> None:
    plan = sw.plan(sw.load_terrain(terrain), robot, friction=0.6)
    run = sw.rollout(plan, disturbance=deviation, seed=3)
    assert run.success, run.reason


@pytest.mark.slow
def test_the_trunk_goes_on_while_a_riser_holds_its_wheels() -> None:
    """A calf that leads its wheel was laid on the edge by it, up to 6 cm on."""
    plan = sw.plan(stair(0.176, 0.394, 4), "a1_wheeled_x", friction=0.6)
    faces = [0.03, -0.03, 0.03, 0.03]
    run = sw.rollout(plan, disturbance={"face_place_error": faces}, seed=3)
    assert run.success, run.reason


@pytest.mark.slow
def test_an_edge_that_is_left_slowly_says_nothing_of_the_next_face() -> None:
    """Its wheels took the third riser for more tread, and pushed until they slipped."""
    plan = sw.plan(sw.load_terrain("stairs-building"), "a1_wheeled", friction=0.6)
    run = sw.rollout(plan, disturbance={"face_place_error": THIRD}, seed=2)
    assert run.success, run.reason


@pytest.mark.slow
def test_a_rear_wheel_stays_off_the_front_one_on_a_short_tread() -> None:
    plan = sw.plan(stair(0.093, 0.396, 3), "go2w", friction=0.6)
    run = sw.rollout(plan, disturbance={"face_place_error": [0.03, -0.03, -0.03]}, seed=3)
    assert run.success, run.reason


@pytest.mark.slow
def test_an_edge_that_comes_early_does_not_tip_what_stands_on_it() -> None:
    """Front wheels carried all but a few newtons when they were over it, the second one down."""
    plan = sw.plan(stair(0.179, 0.3635, 3, direction="down"), "go2w", friction=0.6)
    faces = [0.03, -0.03, -0.03, -0.03, 0.03, -0.03]
    run = sw.rollout(plan, disturbance={"face_place_error": faces}, seed=4)
    assert run.success, run.reason
