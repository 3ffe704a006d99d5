"""One planning problem and the tools that solve it: search, smoothing, repair, certificate.

In which order they are tried is the strategy's (`strategy.py`).
"""

from __future__ import annotations

import math
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from stairwright import _core
from stairwright.planning.attempt import Attempt, Blocked, Outcomes, Solved
from stairwright.planning.certificate.certify import judge
from stairwright.planning.certificate.motion import Motion
from stairwright.planning.extra_margins import IN_SEARCH, ExtraMargins
from stairwright.planning.lattice.body_lattice import (
    LOOSE,
    Bounds,
    LatticePath,
)
from stairwright.planning.lattice.pieces import Piece, passes
from stairwright.planning.lattice.search import Place
from stairwright.planning.lattice.windows import Searches, find_path
from stairwright.planning.path_problem import PathProblem
from stairwright.planning.smoothing.node_margins import BEYOND_REPAIR, FIRM_TORQUE
from stairwright.planning.smoothing.path_document import PathPoses, make_plan
from stairwright.planning.smoothing.path_timing import path_parameter
from stairwright.planning.smoothing.refine import Refined, refine_with_room
from stairwright.planning.smoothing.repair import STAGES, Stage, repair
from stairwright.planning.standing import StandingPose, enlargement, find_standing_poses
from stairwright.planning.threads import still_wanted
from stairwright.planning.timing.fast import TimingProblem
from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

# For legs of 0.4 m or less [m]:
THIN = 0.015  # CoM margin up to which more of it comes first
NEAR = 0.005  # clearance of the trunk up to which more of it comes first
CLEARER = 0.006  # more of that clearance
STRAIGHTER = 3.4  # times the weight of smoothness
STEADIER = 10.0  # times that of the CoM margin
SPARING = 10.0  # times that of torque


def thin_com_margin(robot: Robot) -> float:
    """CoM margin up to which a path of the robot is compared with others [m]."""
    return THIN * enlargement(robot)


def path_planner(
    terrain: Terrain, robot: Robot, friction: float, weights: PathWeights, *, fast: bool = False
) -> PathPlanner:
    """The planner for `terrain` and `robot`; with `fast` for a path that is to be driven fast.

    Raises:
        InputError: If the profile is too short for a wheel.
        NoStandingPose: If the robot cannot stand at its start or goal.
    """
    path = wheel_path(terrain, robot.wheel.radius)
    ends = find_standing_poses(terrain, robot, path)
    ground = _core.Terrain(path.vertices)
    return PathPlanner(terrain, robot, path, ground, ends, friction, weights, fast=fast)


@dataclass
class PathPlanner(PathProblem):
    """A problem and the ways to its answer."""

    fast: bool = False  # whether the path is to be driven fast
    thorough: bool = False  # whether to repair what overloads motors, searched without regard to it
    searches: Searches = field(default_factory=dict)
    # Read in copies: attempts that are abandoned may still end.
    tried: Outcomes = field(default_factory=dict, init=False)

    def find(
        self,
        fine: float,
        bounds: Bounds,
        cheap: bool = True,
        roll_back: bool = False,
        partial: bool = False,
        brinks: bool = False,
    ) -> LatticePath:
        """Search once; see `Search.find`."""
        return find_path(self, bounds, fine, cheap, roll_back, partial, self.searches, brinks)

    def passes(self, piece: Piece, fine: float, bounds: Bounds, roll_back: bool = False) -> bool:
        """Whether a search leads through a piece of the terrain; see `pieces.passes`."""
        return passes(self, piece, bounds, fine, roll_back, self.searches)

    def attempt(self, how: Attempt) -> Solved | Blocked:
        """What comes of one attempt, which is made once."""
        key = (how, self.torques)
        if key not in self.tried:
            self.tried[key] = self._attempt(how)
        return self.tried[key]

    def _attempt(self, how: Attempt) -> Solved | Blocked:
        """Make an attempt.

        With weights of the user's the lattice is searched for them and for the default ones, and
        the path that costs less is taken: heavy weights lead the lattice, whose costs are rougher
        than those of the smoothing, to places that the smoothing cannot make as good. Where a path
        is to be driven fast, each is smoothed in two ways, and the soonest is taken.
        """
        still_wanted()
        finding = self.search_of(how)
        if how.probe:
            return Blocked(None, finding.quality > 0)
        if self.unweighted is None or not finding.leads_on:
            return self.finish(finding, how.brinks)
        usual = self.unweighted.search_of(how)
        found = [finding, usual] if usual.leads_on else [finding]
        answers = [self.finish(path, how.brinks) for path in found]
        if self.fast:
            answers += [self.straighter.finish(path, how.brinks) for path in found]
            return min(answers, key=self._slowness)
        answers += [self.unweighted.finish(path, how.brinks) for path in found[1:]]
        return min(answers, key=self.cost)

    def search_of(self, how: Attempt) -> LatticePath:
        """What the search of an attempt finds."""
        return self.find(how.fine, how.bounds, not how.probe, how.roll_back, brinks=how.brinks)

    def cost(self, answer: Solved | Blocked) -> float:
        """What the weights make of a path; infinite where there is none."""
        if isinstance(answer, Blocked):
            return np.inf
        return self._path_cost(answer.nodes)[0]

    def _slowness(self, answer: Solved | Blocked) -> tuple[bool, float]:
        """Orders paths that are to be driven fast: by their least time [s], behind all others thin
        ones by their cost, for it is margin that they lack and not time.
        """
        if isinstance(answer, Blocked) or answer.margin <= THIN:
            return True, self.cost(answer)
        poses, begun = self.poses(answer.nodes), clock.perf_counter()
        plan = make_plan(self.terrain, self.robot, self.friction, self.weights, begun, poses)
        return False, TimingProblem.of(plan, self.weights.aggressiveness).least_time()

    def cost_terms(self, nodes: Refined) -> dict[str, float]:
        """The quantity that each weight makes small, by the weight's name; see `PathWeights`."""
        return self._path_cost(nodes)[1]

    def _path_cost(self, nodes: Refined) -> tuple[float, dict[str, float]]:
        return self.refine_problem.cost(np.hstack([nodes.s, nodes.body]))

    @cached_property
    def within_torques(self) -> PathPlanner:
        """The same problem, searched so that every pose of the search is held by the motors."""
        return self._searched(torques=True)

    @cached_property
    def repairing_all(self) -> PathPlanner:
        """The same problem, which also repairs what overloads motors; to be asked after this one.

        What came of other attempts is as it was, and of those that are beyond repair.
        """
        other = replace(self, thorough=True)
        for how, end in self.tried.copy().items():
            if isinstance(end, Solved) or end.weak is None or self._beyond_repair(end):
                other.tried[how] = end
        return other

    def _beyond_repair(self, end: Blocked) -> bool:
        """Whether thorough repair would leave a path as it is. Of several paths that an attempt has
        made the others are not known.
        """
        return end.share > FIRM_TORQUE + BEYOND_REPAIR and self.unweighted is None

    @cached_property
    def regardless(self) -> PathPlanner:
        """The same problem, searched without regard to torques, as every question is at first."""
        return self._searched(torques=False)

    def _searched(self, *, torques: bool) -> PathPlanner:
        if torques == self.torques:
            return self
        other = replace(self, torques=torques)
        other.tried = self.tried
        return other

    def with_extra_margins(self, extra: ExtraMargins, in_search: float = IN_SEARCH) -> PathPlanner:
        """The same problem, of which paths keep more than their bounds, poses of the search a share
        of that.
        """
        return replace(self, extra=extra, in_search=in_search, searches={})

    @property
    def thin(self) -> float:
        """CoM margin up to which a path is compared with others [m]."""
        return thin_com_margin(self.robot)

    @property
    def near(self) -> float:
        """Clearance of the trunk up to which a path is compared with another [m]."""
        return NEAR * enlargement(self.robot)

    @cached_property
    def straighter(self) -> PathPlanner:
        """The same problem with more smoothness, for paths that are to be driven fast: whether less
        bent is sooner, too, depends on the margin that it costs.
        """
        smoothness = STRAIGHTER * self.weights.smoothness
        return replace(self, weights=self.weights.model_copy(update={"smoothness": smoothness}))

    @cached_property
    def steadier(self) -> PathPlanner:
        """The same problem, in which the CoM margin weighs much more."""
        weights = self.weights.model_copy(update={"com_margin": STEADIER * self.weights.com_margin})
        return replace(self, weights=weights)

    @cached_property
    def sparing(self) -> PathPlanner:
        """The same problem, in which torque weighs much more."""
        weights = self.weights.model_copy(update={"torque": SPARING * self.weights.torque})
        return replace(self, weights=weights, searches={})

    @cached_property
    def clearer(self) -> PathPlanner:
        """The same problem, in which the smoothing keeps the trunk farther from the ground: its
        searches are those of this one.
        """
        extra = self.extra._replace(trunk=self.extra.trunk + CLEARER * enlargement(self.robot))
        return replace(self, extra=extra, in_search=0.0)

    def how(self, found: Solved) -> tuple[Attempt, bool]:
        """The attempt that found a path, and whether it was made within torques."""
        return next(key for key, end in self.tried.copy().items() if end is found)

    def again(self, how: Attempt, *, torques: bool) -> Solved | Blocked:
        """What comes of an attempt that another planner of the same terrain and robot has made."""
        other = self._searched(torques=torques)
        return other.finish(other.search_of(how), how.brinks)

    @cached_property
    def unweighted(self) -> PathPlanner | None:
        """The same problem with default weights, if these are others."""
        kept = self.weights.model_dump(include={"speed", "aggressiveness"})
        usual = PathWeights(**kept)
        return None if usual == self.weights else replace(self, weights=usual, searches={})

    def partial(self) -> tuple[PathPoses | None, Place | None]:
        """The path as far as it goes, and where wheels end; nothing where they cannot start."""
        finding = self.find(1.7, LOOSE, partial=True)
        if finding.s is None or finding.body is None or len(finding.s) < 2:
            return None, finding.reached
        last = StandingPose((float(finding.s[-1, 0]), float(finding.s[-1, 1])), finding.body[-1])
        found = refine_with_room(self, (self.ends[0], last), finding.s, finding.body)
        found = repair(self, found, found.margins.bad, STAGES[0])
        bad = np.flatnonzero(found.margins.least_slack < 0.0)
        if len(bad):
            found = found.part(0, int(bad[0]))
        if len(found.s) < 2:
            return None, finding.reached
        return self.poses(found), finding.reached

    def finish(self, finding: LatticePath, brinks: bool = False) -> Solved | Blocked:
        """Smooth, repair and certify; where that fails, the arc lengths at the worst place, and
        where the search leads nowhere, those at its end.
        """
        if not finding.leads_on:
            return Blocked(finding.reached, False)
        assert finding.s is not None
        assert finding.body is not None
        still_wanted()
        found = refine_with_room(self, self.ends, finding.s, finding.body)
        judged: Refined | None = None
        for stage in (*self._stages(found), None):
            still_wanted()
            if found is not judged:
                judged, bad = found, found.margins.bad
                if found.margins.worst >= 0.0:
                    solved = self._certified(found)
                    if solved.good:
                        return solved
                    bad = solved.bad
            if stage is not None:
                found = repair(self, found, bad, stage, brinks)
        worst = found.s[int(found.margins.least_slack.argmin())]
        weak = found.margins.overloaded
        share = found.margins.torque_share if weak else math.inf
        return Blocked((float(worst[0]), float(worst[1])), True, weak, share=share)

    def _stages(self, found: Refined) -> Sequence[Stage]:
        """The kinds of repair that are tried.

        No local repair makes motors hold much more: another path does. Pieces that are searched
        without regard to torques seldom make them hold a little more, and take longer than a path
        within torques.
        """
        excess = found.margins.torque_excess
        if excess > BEYOND_REPAIR:
            return ()
        return STAGES if excess <= 0.0 or self.torques or self.thorough else STAGES[:1]

    def _certified(self, nodes: Refined) -> Solved:
        """The path with its certificate, passed or not."""
        return Solved(nodes, judge(self.motion(nodes)))

    def motion(self, nodes: Refined) -> Motion:
        """What the certificate judges of a path."""
        return Motion(
            self.terrain.vertices, self.robot, self.friction, nodes.body,
            nodes.margins.q, path_parameter(nodes.s, nodes.body),
        )  # fmt: skip

    def poses(self, nodes: Refined) -> PathPoses:
        """What the plan's document says of a path."""
        return PathPoses.of(self.path, self.robot, nodes, self.weights)
