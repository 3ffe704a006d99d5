"""Robots whose knees bend both ways: which way is planned with, front and rear.

The plan says it (`Plan.knees`), and its robot's description has the ranges of that side alone:
whoever follows the plan has no choice left.
"""

from __future__ import annotations

from collections.abc import Iterator

from stairwright.planning.plan import Bend, Knees
from stairwright.robot.description import Robot

_WAYS: dict[float, Bend] = {-1.0: "back", 1.0: "forward"}
# In this order: knees towards each other, as such robots' makers stand them; both back; the rest.
_ORDER = ((-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0))


def configurations(robot: Robot) -> Iterator[Robot]:
    """The robot with its knees bent every way they can; the robot itself if none straightens."""
    front, rear = robot.joints.front, robot.joints.rear
    if not (front.straightens or rear.straightens):
        yield robot
        return
    for one, other in _ORDER:
        if one in front.ways and other in rear.ways:
            yield robot.with_knees(one, other)


def knees_of(robot: Robot) -> Knees:
    """Which way the knees of a robot bend that bend one way each."""
    front, rear = (_WAYS[leg.knee] for leg in robot.legs)
    return Knees(front=front, rear=rear)
