"""Low edges, which may be none for heights are off by as much, and edges of short boxes."""

from __future__ import annotations

import pytest

import stairwright as sw


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "b2w"])
def test_a_low_edge_that_is_none_is_not_taken_for_one_that_comes_later(robot):
    points = [(-1.5, 0.0), (0.0, 0.0), (1.0, 0.1), (1.0, 0.08), (2.5, 0.08)]
    plan = sw.plan({"points": points}, robot, 0.6)
    run = sw.rollout(plan, disturbance={"step_height_error": [0.02]})
    assert run.outcome == "success", run.reason


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "a1_wheeled_x", "go2w"])
def test_a_low_edge_that_leans_may_be_lower_still(robot: str) -> None:
    """A face of 2.7 cm that is 7 mm was waited for without end, while the robot drove on."""
    points = [(-1.3, 0.0), (0.0, 0.0), (0.0166, 0.027), (0.67, 0.027), (0.687, 0.0), (2.0, 0.0)]
    plan = sw.plan({"points": points}, robot, 0.6)
    run = sw.rollout(plan, disturbance={"step_height_error": [-0.02, 0.02]})
    assert run.outcome == "success", run.reason


@pytest.mark.slow
@pytest.mark.parametrize("length", [0.4, 0.25])
def test_an_edge_higher_than_drawn_pushes_from_lower_down(length: float) -> None:
    """Its force says that the wheel is less far round it than the corner before it lets it be."""
    points = [(-1.3, 0.0), (0.0, 0.0), (length, -0.085), (length, -0.062), (1.9, -0.062)]
    plan = sw.plan({"points": points}, "a1_wheeled", 0.6)
    run = sw.rollout(plan, disturbance={"step_height_error": [0.02]})
    assert run.outcome == "success", run.reason


@pytest.mark.slow
@pytest.mark.parametrize("box", [(0.12, 0.13, 0.16), (0.10, 0.14, 0.135)], ids=str)
def test_a_riser_on_a_short_box_is_not_its_edge_once_more(box: tuple[float, ...]) -> None:
    """Floor and riser together push as an edge does that the wheel is not round yet."""
    low, length, high = box
    points = [(-1.3, 0.0), (0.0, 0.0), (0.0, low), (length, low), (length, high), (1.5, high)]
    plan = sw.plan({"points": points}, "a1_wheeled", 0.6)
    run = sw.rollout(plan, seed=1, disturbance={"face_place_error": [0.03, -0.03]})
    assert run.outcome == "success", run.reason


@pytest.mark.slow
@pytest.mark.parametrize(
    ("robot", "length", "height"), [("a1_wheeled", 0.12, 0.14), ("go2w", 0.16, 0.219)]
)
def test_front_wheels_do_not_hang_on_an_edge_that_comes_late(
    robot: str, length: float, height: float
) -> None:
    """A box 6 cm longer than drawn, up which the rear wheels climb meanwhile."""
    top = [(0.0, height), (length, height)]
    points = [(-1.3, 0.0), (0.0, 0.0), *top, (length, 0.0), (length + 1.3, 0.0)]
    plan = sw.plan({"points": points}, robot, 0.6)
    run = sw.rollout(plan, seed=1, disturbance={"face_place_error": [-0.03, 0.03]})
    assert run.outcome == "success", run.reason
