"""One planning question: what is asked, and what follows from that alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from stairwright import _core
from stairwright.planning.extra_margins import IN_SEARCH, NO_EXTRA, ExtraMargins
from stairwright.planning.lattice.body_lattice import Bounds
from stairwright.planning.standing import StandingPose, standing_height
from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath

_RESERVE = 0.1  # friction that a plan does without where the terrain allows it
LAG = 0.02  # m; how late a wheel may arrive at a corner


@dataclass
class PathProblem:
    """Terrain and robot, from where to where, with what friction and weights."""

    terrain: Terrain
    robot: Robot
    path: WheelPath
    ground: _core.Terrain
    ends: tuple[StandingPose, StandingPose]
    friction: float
    weights: PathWeights
    torques: bool = False  # whether the search asks that motors hold every pose
    extra: ExtraMargins = NO_EXTRA  # what paths keep beyond their bounds
    in_search: float = IN_SEARCH  # share of it that lattice poses keep

    @property
    def reserve(self) -> float:
        """The lower friction at which poses shall still hold where that is possible."""
        return self.friction - min(_RESERVE, 0.25 * self.friction)

    def torque_share(self, bounds: Bounds) -> float | None:
        """Largest share of the motors' torques that lattice poses may take; None: any."""
        return bounds.torque if self.torques else None

    @cached_property
    def refine_problem(self) -> _core.RefineProblem:
        """What the native core needs for smoothing."""
        w = self.weights
        return _core.RefineProblem(
            self.ground,
            self.path.native,
            self.robot_model,
            self.friction,
            self.reserve,
            LAG,
            standing_height(self.robot),
            _core.PathWeights(w.com_margin, w.clearance, w.torque, w.smoothness, w.pitch),
            self.torques,
            self.extra.native,
        )

    @cached_property
    def robot_model(self) -> _core.RobotModel:
        """The robot, with what planning derives from it once."""
        return _core.RobotModel(self.robot.native)
