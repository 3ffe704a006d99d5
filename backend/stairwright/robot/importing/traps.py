"""What a reader of a robot file should know, though it may be right."""

from __future__ import annotations

from collections.abc import Sequence

from stairwright._core import GRAVITY
from stairwright.robot.description import Robot

from .alike import note_differences
from .report import Notes

_STRONG = 3.0  # traction of all wheels over the weight: no plan needs more


def note_traps(robot: Robot, known: Sequence[Robot], notes: Notes) -> None:
    """Weak wheels, knees that bend both ways, capsules beyond the tyre, and unlike sources."""
    pull = sum(2 * leg.wheel_motor.torque / leg.wheel.radius for leg in robot.legs)
    ratio = pull / (robot.mass * GRAVITY)
    if ratio < _STRONG:
        notes.warn(
            f"all wheels together pull {ratio:.2f} times the robot's weight: wheel torque may bind"
        )
    for where, leg in zip(("front", "rear"), robot.legs, strict=True):
        if leg.limits.both_ways:
            notes.warn(f"the {where} knees bend both ways: a plan chooses")
        low = min(min(a[1], b[1]) - r for a, b, r in leg.calf.capsules)
        beyond = -leg.calf.length - leg.wheel.radius - low
        if beyond > 1e-4:
            notes.warn(f"the {where} calves reach {1e3 * beyond:.2g} mm below the tyre")
    note_differences(robot, known, notes)
