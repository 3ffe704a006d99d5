"""Robots whose knees bend both ways: which way is planned with, front and rear.

The plan says it (`Plan.knees`), and its robot's description has the ranges of that side alone:
whoever follows the plan has no choice left.
"""

from __future__ import annotations

from collections.abc import Iterator

from stairwright.robot.description import Robot

from .plan import Bend, Knees

_WAYS: dict[float, Bend] = {-1.0: "back", 1.0: "forward"}
# In this order: knees towards each other, as such robots' makers stand them; both back; the rest.
_ORDER = ((-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0))


def configurations(robot: Robot) -> Iterator[Robot]:
    """The robot with its knees bent every way they can; the robot itself where there is one."""
    front, rear = robot.joints.front, robot.joints.rear
    if not (front.both_ways or rear.both_ways):
        yield robot
        return
    for ways in _ORDER:
        fixed = ((leg.knee, way) for leg, way in zip((front, rear), ways, strict=True))
        if all(
            leg.both_ways or knee == way
            for leg, (knee, way) in zip((front, rear), fixed, strict=True)
        ):
            yield robot.with_knees(*ways)


def knees_of(robot: Robot) -> Knees:
    """Which way the knees of a robot bend that bend one way each."""
    front, rear = (_WAYS[leg.knee] for leg in robot.legs)
    return Knees(front=front, rear=rear)
