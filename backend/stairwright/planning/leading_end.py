"""Which end of the robot leads, where that is for the planner to say, and what to say of the other.

With the other end in front a fast plan may take little more than half the time, and one whose CoM
margin or clearance is thin may have five times as much: robots whose knees point one way go down
stairs rear first. Otherwise a robot that drives backward is a riddle to whoever watches it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from stairwright.robot.turning import Facing

from .plan import Plan, PlanTiming, Quantity, SaferFacing, reach

Margin = Literal["com", "clearance"]

CLEARLY_SOONER = 0.9  # of the time forward; less is not worth turning about for
CLEARLY_SAFER = 1.5  # times a thin margin
# Robots of any size know where they and the ground are to two or three millimetres.
THIN_CLEARANCE = 0.005  # m


def better_led(led_by: Callable[[Facing], Plan], timing: PlanTiming) -> Plan:
    """Of the plans with either end in front the better one.

    A plan faces backward where forward its CoM margin or clearance is thin and backward clearly
    more, and a fast one also where that is clearly sooner and leaves no less of either; more than
    keeps a plan from being thin does not count. Where there is no plan, it is the one that comes
    farther.

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
    return backward if _safer_by(backward, forward) else forward


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
    margin = _safer_by(other, found)
    if margin is None:
        return found
    least = _least(other)
    safer = SaferFacing(
        facing=other.facing, by=margin, com_margin=least["com"], clearance=least["clearance"]
    )
    return found.model_copy(update={"safer_facing": safer})


def sound(plan: Plan) -> bool:
    """Whether there is a plan with margins such that the other end need not be tried."""
    return plan.feasible and not _thin(plan)


def _safer_by(one: Plan, other: Plan) -> Margin | None:
    """Which margin is thin in the other plan and clearly more in one, the CoM's before clearance.

    A plan is no safer by its clearance where its own margins are thin.
    """
    thin = _thin(other)

    def clearly(margin: Margin) -> bool:
        return margin in thin and _least(one)[margin] > CLEARLY_SAFER * _least(other)[margin]

    if clearly("com"):
        return "com"
    return "clearance" if clearly("clearance") and not _thin(one) else None


def _sooner(one: Plan, other: Plan) -> bool:
    """Whether one is clearly sooner than the other, and its margins no less or not thin."""
    if one.timing.total >= CLEARLY_SOONER * other.timing.total:
        return False
    return all(_least(one)[margin] >= _least(other)[margin] for margin in _thin(one))


def _thin(plan: Plan) -> set[Margin]:
    """Which margins are so small that the plan with the other end in front may be safer."""
    from .path_planner import thin_com_margin

    enough: dict[Margin, float] = {
        "com": thin_com_margin(plan.robot_description), "clearance": THIN_CLEARANCE
    }  # fmt: skip
    least = _least(plan)
    return {margin for margin, bound in enough.items() if least[margin] < bound}


def _least(plan: Plan) -> dict[Quantity, float]:
    """Least margins by name [m]."""
    from .smoothing.path_document import least_margins

    return least_margins(plan)
