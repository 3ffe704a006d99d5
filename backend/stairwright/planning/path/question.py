"""One planning question: what is asked, and what follows from that alone."""

from __future__ import annotations

from dataclasses import dataclass

from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath

from .course import Stand
from .ground import Ground
from .legs import Leg, make_legs

_RESERVE = 0.1  # friction that a plan does without where the terrain allows it


@dataclass
class Question:
    """Terrain and robot, from where to where, with what friction and weights."""

    terrain: Terrain
    robot: Robot
    path: WheelPath
    ground: Ground
    stands: tuple[Stand, Stand]
    friction: float
    weights: PathWeights

    @property
    def reserve(self) -> float:
        """The lower friction at which poses shall still hold where that is possible."""
        return self.friction - min(_RESERVE, 0.25 * self.friction)

    @property
    def legs(self) -> tuple[Leg, Leg]:
        """Front and rear leg."""
        return make_legs(self.robot.planar)
