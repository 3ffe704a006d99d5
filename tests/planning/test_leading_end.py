"""Which end leads where the planner chooses: forward unless backward is clearly sooner or safer."""

from __future__ import annotations

import pytest

import stairwright as sw
from stairwright.planning.leading_end import better_led, told_of_other_end
from stairwright.planning.plan import FacingChoice, Plan, PlanTiming
from stairwright.planning.smoothing.path_document import least_margins
from stairwright.robot.turning import Facing
from stairwright.simulation.replanning import plan_anew
from stairwright.terrain.stairs import stair

DROP = {"points": [[-1.2, 0.25], [0.0, 0.25], [0.0, 0.0], [1.2, 0.0]]}
WALL = {"points": [[-1.2, 0.0], [0.0, 0.0], [0.0, 1.0], [1.2, 1.0]]}


@pytest.fixture(scope="module")
def backward() -> Plan:
    return sw.plan(DROP, timing="fast")


@pytest.mark.slow
def test_a1_wheeled_goes_down_with_its_rear_in_front(backward: Plan) -> None:
    ways: tuple[Facing, ...] = ("forward", "backward")
    forward, asked = (sw.plan(DROP, timing="fast", facing=way) for way in ways)
    assert backward.facing == "backward"
    assert (backward.id, backward.poses) == (asked.id, asked.poses)
    assert backward.timing.total < 0.9 * forward.timing.total
    assert backward.certificate is not None
    assert backward.certificate.passed


def test_it_stays_forward_where_that_is_as_good() -> None:
    assert sw.plan("curb-015", "go2w", timing="fast").facing == "forward"


def test_steady_plans_face_forward_where_that_is_safe() -> None:
    asked: tuple[FacingChoice | None, ...] = (None, "either", "forward")
    assert len({sw.plan("curb-015", facing=facing).id for facing in asked}) == 1


def test_a_thin_plan_tells_of_a_safer_one_with_the_other_end_in_front() -> None:
    flight = stair(0.18, 0.28, 3, direction="down")
    thin = sw.plan(flight)
    safer = sw.plan(flight, facing="backward")
    assert thin.safer_facing is not None
    assert thin.safer_facing.facing == "backward"
    assert thin.safer_facing.com_margin == least_margins(safer)["com"]
    assert thin.safer_facing.com_margin > 1.5 * least_margins(thin)["com"]
    assert thin.safer_facing.by == "com"
    assert safer.safer_facing is None
    assert sw.plan(flight, facing="either").id == safer.id
    assert sw.plan(flight, diagnose=False).safer_facing is None


@pytest.mark.slow
def test_a_refusal_is_that_of_the_end_that_comes_farther() -> None:
    refused = sw.plan(WALL, facing="either")
    ways: tuple[Facing, ...] = ("forward", "backward")
    each = [sw.plan(WALL, facing=way) for way in ways]
    farther = max(each, key=lambda plan: plan.problem.progress if plan.problem else 0.0)
    assert not refused.feasible
    assert (refused.facing, refused.problem) == (farther.facing, farther.problem)
    assert refused.problem is not None
    assert refused.problem.limit is not None


@pytest.mark.slow
def test_a_refusal_tells_of_a_plan_with_the_other_end_in_front() -> None:
    refused = sw.plan(DROP, friction=0.4)
    bare = sw.plan(DROP, friction=0.4, diagnose=False)
    assert refused.problem is not None
    assert bare.problem is not None
    assert refused.problem.limit is not None
    assert refused.problem.feasible_facing == "backward"
    assert refused.problem.message.endswith("; there is a plan rear first (facing backward)")
    assert (refused.id, refused.facing) == (bare.id, "forward")
    assert bare.problem.feasible_facing is None
    assert sw.plan(DROP, friction=0.4, facing="backward").feasible


@pytest.mark.slow
def test_and_of_one_with_its_front_in_front() -> None:
    up = {"points": [[-x, z] for x, z in reversed(DROP["points"])]}
    refused = sw.plan(up, friction=0.4, facing="backward")
    assert refused.problem is not None
    assert refused.problem.feasible_facing == "forward"
    assert refused.problem.message.endswith("; there is a plan front first (facing forward)")
    assert sw.plan(up, friction=0.4).feasible


@pytest.mark.slow
def test_another_plan_on_the_way_keeps_the_end_that_leads() -> None:
    step = {"points": [[-1.2, 0.0], [0.0, 0.0], [0.0, 0.25], [1.2, 0.25]]}
    old = sw.plan(step, timing="fast", facing="backward")
    new = plan_anew(old, old.terrain, 0.5)
    assert new is not None
    assert (new.facing, new.robot_description) == ("backward", old.robot_description)


class Ends:
    """Plans with either end in front, of given times [s] and least CoM margins [m], and with
    clearances [m].
    """

    def __init__(
        self,
        like: Plan,
        forward: tuple[float, float],
        backward: tuple[float, float],
        clearances: tuple[float, float] = (0.02, 0.02),
    ) -> None:
        self.plans = {
            "forward": _altered(like, "forward", *forward, clearances[0]),
            "backward": _altered(like, "backward", *backward, clearances[1]),
        }
        self.asked: list[Facing] = []

    def __call__(self, facing: Facing) -> Plan:
        self.asked.append(facing)
        return self.plans[facing]


def _altered(like: Plan, facing: Facing, total: float, com: float, clearance: float) -> Plan:
    first, *rest = like.poses
    least = {"com": com, "clearance": clearance}
    thin = first.model_copy(update={"margins": first.margins.model_copy(update=least)})
    timing = like.timing.model_copy(update={"total": total})
    return like.model_copy(update={"facing": facing, "timing": timing, "poses": [thin, *rest]})


@pytest.mark.parametrize(
    ("time", "com", "leads"),
    [
        (8.0, 0.016, "backward"),
        (9.5, 0.03, "forward"),
        (8.0, 0.01, "forward"),
    ],
    ids=["clearly sooner", "hardly sooner", "sooner but thin"],
)
def test_it_turns_about_for_time_and_with_room(
    backward: Plan, time: float, com: float, leads: Facing
) -> None:
    assert better_led(Ends(backward, (10.0, 0.02), (time, com)), "fast").facing == leads


def test_of_thin_plans_the_sooner_may_not_be_the_thinner(backward: Plan) -> None:
    for margin, leads in ((0.007, "backward"), (0.004, "forward")):
        ends = Ends(backward, (10.0, 0.005), (8.0, margin))
        assert better_led(ends, "fast").facing == leads


@pytest.mark.parametrize("timing", ["steady", "fast"])
def test_what_is_feasible_goes_before_what_is_not(backward: Plan, timing: PlanTiming) -> None:
    ends = Ends(backward, (10.0, 0.02), (20.0, 0.001))
    ends.plans["forward"] = sw.plan(WALL, diagnose=False)
    assert better_led(ends, timing).facing == "backward"


@pytest.mark.parametrize("timing", ["steady", "fast"])
@pytest.mark.parametrize(
    ("forward", "backward_com", "leads"),
    [(0.008, 0.013, "backward"), (0.008, 0.011, "forward"), (0.016, 0.05, "forward")],
    ids=["clearly safer", "hardly safer", "not thin"],
)
def test_it_turns_about_where_forward_is_thin(
    backward: Plan, timing: PlanTiming, forward: float, backward_com: float, leads: Facing
) -> None:
    ends = Ends(backward, (10.0, forward), (12.0, backward_com))
    assert better_led(ends, timing).facing == leads
    told = told_of_other_end(ends.plans["forward"], ends).safer_facing
    assert (told.facing if told else "forward") == leads


@pytest.mark.parametrize("timing", ["steady", "fast"])
@pytest.mark.parametrize(
    ("forward", "behind", "com", "leads"),
    [
        (0.002, 0.03, 0.02, "backward"),
        (0.002, 0.004, 0.02, "forward"),
        (0.006, 0.03, 0.02, "forward"),
        (0.002, 0.03, 0.01, "forward"),
    ],
    ids=["clearly safer", "still thin", "not thin", "the CoM thinner there"],
)
def test_it_turns_about_where_forward_hardly_clears_the_ground(
    backward: Plan, timing: PlanTiming, forward: float, behind: float, com: float, leads: Facing
) -> None:
    """Go2-W and D1 go down stairs with 2 mm between the calves and the edges, or with 40."""
    ends = Ends(backward, (10.0, 0.02), (12.0, com), (forward, behind))
    assert better_led(ends, timing).facing == leads
    told = told_of_other_end(ends.plans["forward"], ends).safer_facing
    assert (told.facing if told else "forward") == leads
    assert told is None or (told.by, told.clearance) == ("clearance", behind)


def test_no_second_plan_is_made_where_a_steady_one_faces_forward(backward: Plan) -> None:
    ends = Ends(backward, (10.0, 0.02), (5.0, 0.02))
    assert better_led(ends, "steady").facing == "forward"
    assert ends.asked == ["forward"]


@pytest.mark.slow
def test_a_go2w_goes_down_stairs_with_its_rear_in_front() -> None:
    flight = stair(0.18, 0.28, 3, direction="down")
    near = sw.plan(flight, "go2w")
    assert near.safer_facing is not None
    assert near.safer_facing.by == "clearance"
    clear = sw.plan(flight, "go2w", facing="either")
    assert clear.facing == "backward"
    assert least_margins(clear)["clearance"] == near.safer_facing.clearance
