"""Which end of the robot leads, where that is for the planner to say, and what to say of the other.

With the other end in front a fast plan may take little more than half the time, and one whose CoM
margin is thin may have five times as much: robots whose knees point one way go down stairs rear
first. Otherwise a robot that drives backward is a riddle to whoever watches it.
"""

from __future__ import annotations

from collections.abc import Callable

from stairwright.robot.turning import Facing

from .plan import Plan, PlanTiming, SaferFacing, reach

CLEARLY_SOONER = 0.9  # of the time forward; less is not worth turning about for
CLEARLY_SAFER = 1.5  # times a thin CoM margin


def better_led(led_by: Callable[[Facing], Plan], timing: PlanTiming) -> Plan:
    """Of the plans with either end in front the better one.

    A plan faces backward where forward its CoM margin is thin and backward clearly more, and a fast
    one also where that is clearly sooner and leaves the CoM no less margin; more than keeps a plan
    from being thin does not count. Where there is no plan, it is the one that comes farther.

    Args:
        led_by: Plans with that end in front.
        timing: Of the plans.
    """
    forward = led_by("forward")
    if timing == "steady" and sound(forward):
        return forward
    backward = led_by("backward")
    if not (forward.feasible and backward.feasible):
        return max(forward, backward, key=reach)
    if timing == "fast" and _sooner(backward, forward):
        return backward
    return backward if _safer(backward, forward) else forward


def told_of_other_end(found: Plan, led_by: Callable[[Facing], Plan]) -> Plan:
    """The plan, which says so where only the other end in front has one, or a clearly safer one.

    Args:
        found: With the end in front that was asked for: a refusal, or a plan that is not `sound`.
        led_by: Plans with that end in front.
    """
    other = led_by("forward" if found.facing == "backward" else "backward")
    if not other.feasible:
        return found
    if found.problem is not None:
        return found.model_copy(update={"problem": found.problem.but_facing(other.facing)})
    if not _safer(other, found):
        return found
    safer = SaferFacing(facing=other.facing, com_margin=_com_margin(other))
    return found.model_copy(update={"safer_facing": safer})


def sound(plan: Plan) -> bool:
    """Whether there is a plan, with so much CoM margin that the other end need not be tried."""
    return plan.feasible and not _thin(plan)


def _safer(one: Plan, other: Plan) -> bool:
    """Whether one leaves the CoM clearly more margin than the other, whose margin is thin."""
    return _thin(other) and _com_margin(one) > CLEARLY_SAFER * _com_margin(other)


def _sooner(one: Plan, other: Plan) -> bool:
    """Whether one is clearly sooner than the other, and its CoM's margin no less or not thin."""
    if one.timing.total >= CLEARLY_SOONER * other.timing.total:
        return False
    return not _thin(one) or _com_margin(one) >= _com_margin(other)


def _thin(plan: Plan) -> bool:
    from .path_planner import thin_com_margin

    return _com_margin(plan) < thin_com_margin(plan.robot_description)


def _com_margin(plan: Plan) -> float:
    """Least CoM margin [m]."""
    from .smoothing.path_document import least_margins

    return least_margins(plan)["com"]
