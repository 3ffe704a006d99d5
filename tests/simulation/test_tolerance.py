"""Plans with a tolerance, carried out at corners of the set that their certificate holds for."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright.simulation.plan_change import PlanChange

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


@pytest.mark.slow
def test_where_the_map_is_wrong_by_no_more_than_that_the_plan_is_followed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    told, without = [], sw.plan(STAIRS, "a1_wheeled_x")
    plan = sw.plan(STAIRS, "a1_wheeled_x", tolerance={"height": 0.012})
    decide = PlanChange.decide

    def listen(change: PlanChange) -> str:
        told.append((change._loop.map_error is not None, change.followed))
        return decide(change)

    monkeypatch.setattr(PlanChange, "decide", listen)
    for one, anew in ((plan, False), (without, True)):
        told.clear()
        world = {"step_height_error": [0.012, 0.012, -0.012]}
        assert sw.rollout(one, disturbance=world).success
        assert any(wrong for wrong, _ in told) == anew
        assert any(followed is not one for _, followed in told) == anew


def flight(rise: float, tread: float, count: int) -> dict[str, list[tuple[float, float]]]:
    points = [(-2.0, 0.0)]
    for k in range(count):
        points += [(k * tread, k * rise), (k * tread, (k + 1) * rise)]
    return {"points": [*points, ((count - 1) * tread + 2.2, count * rise)]}


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_a_robot_whose_front_wheels_come_off_a_higher_riser_rights_itself(seed: int) -> None:
    """It stood on its rear wheels, which were held in their places, and then pushed on ahead."""
    plan = sw.plan(flight(0.2003, 0.3808, 4), "a1_wheeled", 0.455, tolerance={"height": 0.02})
    higher = {"step_height_error": [0.02, -0.02, -0.02, 0.02]}
    run = sw.rollout(plan, disturbance=higher, seed=seed)
    assert run.success, run.reason


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_a_robot_that_finds_the_map_wrong_while_its_trunk_swings_does_not_tip(seed: int) -> None:
    """It stopped within hundredths of a second, its mass centre moving back by 0.2 m/s."""
    plan = sw.plan(flight(0.17185, 0.4741, 3), "d1", 0.477)
    world = {
        "step_height_error": [-0.01, -0.01, 0.01],
        "face_place_error": [0.005, 0.005, -0.005],
    }
    run = sw.rollout(plan, disturbance=world, seed=seed)
    assert run.success, run.reason


@pytest.mark.slow
def test_a_fast_robot_whose_front_wheels_drop_off_an_edge_too_soon_does_not_tip() -> None:
    """They hung in the air for 0.1 s while its trunk moved on, and it sat down backward."""
    asked = {"height": 0.02, "place": 0.01, "friction": 0.1}
    plan = sw.plan(flight(-0.1767, 0.6378, 2), "d1", 0.472, timing="fast", tolerance=asked)
    assert plan.feasible, plan.problem
    world = {
        "step_height_error": [-0.02, 0.02],
        "face_place_error": [-0.01, 0.01],
        "friction": -0.1,
    }
    run = sw.rollout(plan, disturbance=world)
    assert run.success, run.reason


@pytest.mark.slow
def test_forces_keep_to_the_least_friction() -> None:
    """Front wheels slipped on the second riser, which is 4 cm higher."""
    asked = {"height": 0.02, "place": 0.005, "friction": 0.1}
    plan = sw.plan(flight(0.1784, 0.5723, 3), "b2w", 0.508, tolerance=asked)
    assert plan.feasible, plan.problem
    assert plan.least_friction == pytest.approx(0.408)
    world = {"step_height_error": [-0.02, 0.02, -0.02], "friction": -0.1}
    run = sw.rollout(plan, disturbance=world)
    assert run.success, run.reason


@pytest.mark.slow
def test_wheels_do_not_slip_off_an_edge_that_is_higher_than_drawn() -> None:
    """By forces within the cone of the edge as it was drawn: in both worlds."""
    plan = sw.plan(flight(0.218, 0.64, 4), "b2w", 0.575, tolerance={"height": 0.02})
    assert plan.feasible, plan.problem
    for first in (-0.02, 0.02):
        world = {"step_height_error": [first, -first, 0.02, 0.02]}
        run = sw.rollout(plan, disturbance=world)
        assert run.success, run.reason


@pytest.mark.slow
def test_a_flight_that_is_too_low_by_what_is_tolerated_at_each_step_is_climbed() -> None:
    """Its last treads are 14 cm from where the map has them."""
    plan = sw.plan(flight(0.14, 0.32, 7), "d1", 0.6, tolerance={"height": 0.02})
    assert plan.feasible, plan.problem
    run = sw.rollout(plan, disturbance={"step_height_error": [-0.02] * 7})
    assert run.success, run.reason
