"""Robots of the first schema in the second."""

from __future__ import annotations

from stairwright.documents import parse

from .description import Robot

LATEST = "stairwright/robot/2"


def to_latest(robot: Robot) -> Robot:
    """The same robot in the newest schema, which has a field for everything the older one says."""
    return parse(Robot, {**robot.model_dump(mode="json"), "schema": LATEST})
