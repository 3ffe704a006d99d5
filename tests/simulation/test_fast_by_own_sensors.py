"""Fast plans, carried out by a robot that has only its own sensors."""

import pytest

import stairwright as sw
from stairwright.simulation.ranges import BUNDLES, draw
from stairwright.terrain.stairs import stair


@pytest.fixture(scope="module", params=["up", "down"])
def plan(request: pytest.FixtureRequest) -> sw.Plan:
    """The mass centre has 7 to 14 mm of margin there."""
    flight = stair(0.18, 0.28, 5, direction=request.param, approach=1.18, platform=1.18)
    return sw.plan(flight, "a1_wheeled", 0.6, timing="fast")


@pytest.mark.slow
def test_wheels_that_hop_off_a_riser_do_not_stop_it(plan: sw.Plan) -> None:
    """Nothing deviates; a wheel that meets a riser at 0.4 m/s is in the air for a moment."""
    down = plan.poses[-1].z_c < plan.poses[0].z_c
    assert plan.facing == ("backward" if down else "forward")
    run = sw.rollout(plan, controller={"sensing": "robot"})
    assert run.outcome == "success", run.reason
    assert run.metrics.speed_stairs > 0.3
    ideal = sw.rollout(plan, controller={"sensing": "ideal"})
    assert run.metrics.speed_stairs > 0.9 * ideal.metrics.speed_stairs


@pytest.mark.slow
def test_steps_that_are_off_do_not_stop_it_in_the_middle(plan: sw.Plan) -> None:
    """It finds treads 6 to 15 mm off and goes on, for a plan in motion cannot stand anywhere."""
    deviation = draw(BUNDLES["laboratory"], 1, 2)[0]
    run = sw.rollout(plan, controller={"sensing": "robot"}, disturbance=deviation, seed=2)
    assert run.outcome == "success", run.reason
