"""A robot with its own sensors that finds the world other than its plan believes."""

import pytest

import stairwright as sw

SLIPPERY_REAR = {"friction_rear": -0.3}
OWN = {"sensing": "robot"}


@pytest.mark.slow
def test_slippery_wheels_are_found_out_and_planned_for() -> None:
    """A plan made for 0.6 asks more of the rear wheels than the 0.3 that they have."""
    plan = sw.plan("single-stair-036", "go2w", friction=0.6)
    ideal = sw.rollout(plan, controller={"sensing": "ideal"}, disturbance=SLIPPERY_REAR)
    assert ideal.outcome != "success"
    found = sw.rollout(plan, controller=OWN, disturbance=SLIPPERY_REAR)
    assert found.outcome == "success", found.reason


def test_no_plan_for_the_grip_that_is_there_means_not_to_start() -> None:
    plan = sw.plan("single-stair-036", "a1_wheeled", friction=0.6)
    everywhere = {"friction_front": -0.48, "friction_rear": -0.48}
    found = sw.rollout(plan, controller=OWN, disturbance=everywhere)
    assert found.outcome == "stopped", found.reason
    assert "slipped at a friction of 0." in found.reason
    assert found.metrics.progress < 0.02
    assert found.metrics.link_contacts == 0
