"""What a scene shows, read from documents: terrain, robot, motion and where to look."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from stairwright.arrays import Floats
from stairwright.documents import parse
from stairwright.library import load_robot
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

from .motion import Motion, from_plan, from_rollout

Document = Mapping[str, Any]

_END = 0.05  # s before its last sample, from when on a rollout that failed is marked


class Shown:
    """A plan, a rollout, or both: the rollout moves, the plan's ghosts and paths stand.

    Attributes:
        plan: Its document, or the one that the rollout brings.
        rollout: Its document.
        terrain: What both are of; None where nothing is shown.
        robot: Whose they are.
    """

    def __init__(self, plan: Document | None = None, rollout: Document | None = None) -> None:
        if plan is None and rollout is not None:
            plan = rollout.get("plan")
        self.plan, self.rollout = plan, rollout
        source = plan or rollout
        self.terrain = None if source is None else parse(Terrain, source["terrain"])
        self.robot = None if source is None else _robot_of(source)
        self.friction = None if source is None else source.get("friction")

    @cached_property
    def planned(self) -> Motion | None:
        """The plan's motion."""
        if self.plan is None or self.robot is None:
            return None
        return from_plan(self.plan, self.robot)

    @cached_property
    def motion(self) -> Motion | None:
        """What moves: the rollout, else the plan."""
        run = None if self.rollout is None else from_rollout(self.rollout)
        return run or self.planned

    def place(self, time: float) -> Floats | None:
        """(3,) where the robot is [m]; where one should be if no pose was found."""
        if self.motion is not None:
            return self.motion.at(time).position
        if self.plan is not None and self.plan.get("problem") is not None:
            x, z = self.plan["problem"]["at"]
            return np.array([x, 0.0, z])
        return None

    def failed_by(self, time: float) -> bool:
        """Whether the rollout has ended by `time` [s] without success."""
        if self.rollout is None or self.motion is None:
            return False
        return self.rollout["outcome"] != "success" and time >= self.motion.duration - _END


def _robot_of(document: Document) -> Robot:
    """The robot that a document was made with: embedded, else by name."""
    embedded = document.get("robot_description")
    return parse(Robot, embedded) if embedded is not None else load_robot(document["robot"])
