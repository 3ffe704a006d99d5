"""Which end of the robot leads, where that is for the planner to say.

With the other end in front a fast plan may take little more than half the time. A steady plan gains
little, and a robot that drives backward without need is a riddle to whoever watches it.
"""

from __future__ import annotations

from collections.abc import Callable

from stairwright.robot.turning import Facing

from .plan import Plan, PlanTiming, reach

CLEARLY_SOONER = 0.9  # of the time forward; less is not worth turning about for


def better_led(led_by: Callable[[Facing], Plan], timing: PlanTiming) -> Plan:
    """Of the plans with either end in front the better one.

    A steady plan faces forward where there is such a plan. A fast one faces backward where that is
    clearly sooner and leaves the CoM no less margin; more than keeps a plan from being thin does
    not count. Where there is no plan, it is the one that comes farther.

    Args:
        led_by: Plans with that end in front.
        timing: Of the plans.
    """
    if timing == "steady":
        forward = led_by("forward")
        return forward if forward.feasible else max(forward, led_by("backward"), key=reach)
    forward, backward = led_by("forward"), led_by("backward")
    if forward.feasible and backward.feasible:
        sooner = backward.timing.total < CLEARLY_SOONER * forward.timing.total
        return backward if sooner and _room(backward) >= _room(forward) else forward
    return max(forward, backward, key=reach)


def told_of_other_end(refusal: Plan, led_by: Callable[[Facing], Plan]) -> Plan:
    """The refusal; where there is a plan with the other end in front, it says so.

    Args:
        refusal: With the end in front that was asked for there is no plan.
        led_by: Plans with that end in front.
    """
    other: Facing = "forward" if refusal.facing == "backward" else "backward"
    if refusal.problem is None or not led_by(other).feasible:
        return refusal
    return refusal.model_copy(update={"problem": refusal.problem.but_facing(other)})


def _room(plan: Plan) -> float:
    """Least CoM margin [m], as far as it matters."""
    from .path_planner import THIN
    from .smoothing.path_document import least_margins

    return min(least_margins(plan)["com"], THIN)
