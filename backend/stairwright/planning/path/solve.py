"""The ladder of attempts: from a quick coarse search to finer and bolder ones."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stairwright import _core
from stairwright.planning.certificate import judge
from stairwright.planning.motion import Motion
from stairwright.planning.plan import Certificate, Pose
from stairwright.planning.threads import race, still_wanted
from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

from .assemble import make_poses
from .course import Stand, find_stands
from .lattice import BOLD, HOPE, KEEN, STRICT, Bounds, Finding
from .mend import STAGES, mend
from .node_margins import BEYOND_REPAIR, Motor
from .pieces import Piece, passes, pieces, stops
from .question import Question
from .refine import Refined, refine
from .search import Place
from .timing import path_parameter
from .windows import Searches, find_path

Ints = NDArray[np.int64]
Way = tuple[list[Pose], list[int], float]  # poses, key poses, duration [s]


@dataclass(frozen=True)
class Rung:
    """One attempt: lattice refinement (above 1: coarser), bounds, and whether wheels may roll back.

    A coarse rung costs a tenth of one at 1 and the polish makes as good a path from it. A `probe`
    only asks whether a search comes through; where none has, nothing after it will.
    """

    fine: float
    bounds: Bounds
    roll_back: bool = False
    probe: bool = False


BACK = Rung(1.7, BOLD, roll_back=True)
LADDER = (  # rungs of one step are tried together; the first path is taken
    (Rung(2.0, STRICT),),
    (Rung(1.7, BOLD), Rung(1.7, HOPE, roll_back=True, probe=True)),
    (Rung(1.7, HOPE), Rung(1.4, KEEN), BACK),
)
_COARSE = 2  # steps of the ladder that are compared where a path is thin
THIN = 0.01  # m; CoM margin


@dataclass(frozen=True)
class Solved:
    """A path and its certificate, which has passed unless the path is still to be mended."""

    nodes: Refined
    certificate: Certificate

    @property
    def margin(self) -> float:
        """Thinnest margin of the CoM [m]."""
        return float(self.nodes.margins.firm_com_margin.min())

    @property
    def bad(self) -> Ints:
        """Nodes at which a check of the certificate is violated most."""
        progress = path_parameter(self.nodes.s, self.nodes.body)
        places = {
            int(np.abs(progress - check.progress).argmin())
            for check in self.certificate.checks
            if not check.passed and check.progress is not None
        }
        return np.array(sorted(places), np.int64)


@dataclass(frozen=True)
class Blocked:
    """No certified path.

    Attributes:
        reached: Arc lengths where the way ends, or where a found way breaks a bound worst.
        stops: Where bold searches end: the place from the start, and others farther on.
        opened: Whether a search came through at all.
        weak: Motors whose torque a found way exceeded.
    """

    reached: Place | None
    opened: bool
    weak: Motor | None = None
    stops: tuple[Place, ...] = ()


def pose_course(terrain: Terrain, robot: Robot, friction: float, weights: PathWeights) -> Course:
    """The planning question of `terrain` and `robot`.

    Raises:
        InputError: If the profile is too short for a wheel.
        NoStand: If the robot cannot stand at its start or goal.
    """
    path = wheel_path(terrain, robot.wheel.radius)
    stands = find_stands(terrain, robot, path)
    return Course(terrain, robot, path, _core.Terrain(path.vertices), stands, friction, weights)


@dataclass
class Course(Question):
    """A question and the ways to its answer."""

    searches: Searches = field(default_factory=dict)

    def find(
        self,
        fine: float,
        bounds: Bounds,
        cheap: bool = True,
        roll_back: bool = False,
        partial: bool = False,
    ) -> Finding:
        """Search once; see `Search.find`."""
        return find_path(self, bounds, fine, cheap, roll_back, partial, self.searches)

    def passes(self, piece: Piece, fine: float, bounds: Bounds, roll_back: bool = False) -> bool:
        """Whether a search leads through a piece of the course; see `pieces.passes`."""
        return passes(self, piece, bounds, fine, roll_back, self.searches)

    def solve(self, pool: Executor) -> Solved | Blocked:
        """Climb the ladder until a path passes the certificate and is not needlessly thin.

        Weights say which path, never whether: where they find none the default ones are tried.
        Where motors are too weak for what was found, the search asks for what they hold.

        Args:
            pool: Who tries the rungs of one step.
        """
        found = self._climb(pool)
        if isinstance(found, Solved):
            return found
        if found.weak and not self.torques:
            held = self.within_torques.solve(pool)
            return held if isinstance(held, Solved) else replace(held, weak=held.weak or found.weak)
        return self.unweighted.solve(pool) if self.unweighted else found

    def _climb(self, pool: Executor) -> Solved | Blocked:
        best: Solved | None = None
        blocked: list[Blocked] = []
        ends: tuple[Place, ...] = ()
        for height, rungs in enumerate(LADDER, 1):
            tried = [rung for rung in rungs if best is None or not rung.probe]
            if height > _COARSE and blocked[1].opened:
                tried.remove(BACK)  # bold wheels need not roll back: it would be the same way again
            with race(pool, self.attempt, tried) as answers:
                for answer in answers:
                    if isinstance(answer, Blocked):
                        blocked.append(answer)
                    elif best is None or answer.margin > best.margin:
                        best = answer
                    if best is not None and height > _COARSE:
                        break
            if best is not None and (height >= _COARSE or best.margin > THIN):
                return best
            weak = next((one for one in blocked if one.weak), None)
            if weak is not None and best is None and not self.torques:
                return weak  # the search has to look at torques first
            if height == 1 and best is None:
                ends, hopeless = self._ahead(blocked[0], pool)
                if hopeless:
                    return Blocked(ends[0], False, stops=ends)
            if any(rung.probe for rung in tried) and not any(one.opened for one in blocked):
                break
        bold = blocked[1].reached  # of the second step's first rung
        reached = [one for one in blocked if one.reached]
        found = [one for one in reached if one.opened] or reached  # rather where a bound is broken
        return Blocked(
            max((one.reached for one in found if one.reached), key=sum, default=None),
            any(one.opened for one in blocked),
            next((one.weak for one in blocked if one.weak), None),
            ends or ((bold,) if bold else ()),
        )  # fmt: skip

    def _ahead(self, blocked: Blocked, pool: Executor) -> tuple[tuple[Place, ...], bool]:
        """What stops bold ways from where a strict search ended; and whether no way leads past it.

        On a long course that is sooner told than by searches from start to goal.
        """
        if blocked.opened or blocked.reached is None:
            return (), False
        here = pieces(self, [blocked.reached])[0]
        if here.whole:
            return (), False
        bold = pool.submit(stops, self, blocked.reached, BOLD, 1.7, self.searches)
        hopeful = self._hopeful(here)
        ends = bold.result()
        if len(ends) < 2 or not hopeful:
            return ends, bool(ends) and not hopeful
        with race(pool, self._hopeful, pieces(self, ends[1:])) as answers:
            return ends, not all(answers)

    def _hopeful(self, piece: Piece) -> bool:
        """Whether the most forgiving search leads through `piece`."""
        return self.passes(piece, 1.7, HOPE, roll_back=True)

    def quick(self) -> Solved | Blocked:
        """What a few rungs lead to: enough to confirm that a changed problem has a plan.

        Where a search comes through and no path follows, a more forgiving one seldom does better.
        """
        bold = self.attempt(Rung(1.7, BOLD))
        if isinstance(bold, Blocked) and bold.weak and not self.torques:
            return self.within_torques.quick()
        if isinstance(bold, Solved) or bold.opened:
            return bold
        hope = self.attempt(Rung(1.7, HOPE))
        return hope if isinstance(hope, Solved) or hope.opened else bold

    def attempt(self, rung: Rung) -> Solved | Blocked:
        """What comes of one rung.

        With weights of the user's the lattice is searched for them and for the default ones, and
        the path that costs less is taken: heavy weights lead the lattice, whose costs are rougher
        than those of the smoothing, to places that the smoothing cannot make as good.
        """
        still_wanted()
        finding = self.find(rung.fine, rung.bounds, not rung.probe, rung.roll_back)
        if rung.probe:
            return Blocked(None, finding.quality > 0)
        if finding.s is None:
            return Blocked(finding.reached, False)
        answers = [self.finish(finding)]
        if self.unweighted is not None:
            usual = self.unweighted.find(rung.fine, rung.bounds, roll_back=rung.roll_back)
            if usual.s is not None:
                answers += [self.finish(usual), self.unweighted.finish(usual)]
        return min(answers, key=self.cost)

    def cost(self, answer: Solved | Blocked) -> float:
        """What the weights make of a path; infinite where there is none."""
        if isinstance(answer, Blocked):
            return np.inf
        return self._path_cost(answer.nodes)[0]

    def cost_terms(self, nodes: Refined) -> dict[str, float]:
        """The quantity that each weight makes small, by the weight's name; see `PathWeights`."""
        return self._path_cost(nodes)[1]

    def _path_cost(self, nodes: Refined) -> tuple[float, dict[str, float]]:
        return self.refine_problem.cost(np.hstack([nodes.s, nodes.body]))

    @cached_property
    def within_torques(self) -> Course:
        """The same question, asked so that every pose of the search is held by the motors."""
        return replace(self, torques=True)

    @cached_property
    def unweighted(self) -> Course | None:
        """The same question with default weights, if these are others."""
        usual = PathWeights(speed=self.weights.speed)
        return None if usual == self.weights else replace(self, weights=usual, searches={})

    def partial(self) -> tuple[Way, Place | None]:
        """The way as far as it goes, and where wheels end: nothing where they cannot even start."""
        finding = self.find(1.7, BOLD, partial=True)
        if finding.s is None or finding.body is None or len(finding.s) < 2:
            return ([], [], 0.0), finding.reached
        last = Stand((float(finding.s[-1, 0]), float(finding.s[-1, 1])), finding.body[-1])
        found = refine(self, (self.stands[0], last), finding.s, finding.body)
        found = mend(self, found, found.margins.bad, STAGES[0])
        bad = np.flatnonzero(found.margins.least_slack < 0.0)
        if len(bad):
            found = found.part(0, int(bad[0]))
        if len(found.s) < 2:
            return ([], [], 0.0), finding.reached
        return self.way(found), finding.reached

    def finish(self, finding: Finding) -> Solved | Blocked:
        """Polish, mend and certify; where that fails, the arc lengths at the worst place."""
        assert finding.s is not None
        assert finding.body is not None
        still_wanted()
        found = refine(self, self.stands, finding.s, finding.body)
        judged: Refined | None = None
        # No local repair makes motors hold much more: another way does.
        stages = () if found.margins.torque_excess > BEYOND_REPAIR else STAGES
        for stage in (*stages, None):
            still_wanted()
            if found is not judged:
                judged, bad = found, found.margins.bad
                if found.margins.worst >= 0.0:
                    solved = self._certified(found)
                    if solved.certificate.passed:
                        return solved
                    bad = solved.bad
            if stage is not None:
                found = mend(self, found, bad, stage)
        worst = found.s[int(found.margins.least_slack.argmin())]
        return Blocked((float(worst[0]), float(worst[1])), True, found.margins.overloaded)

    def _certified(self, nodes: Refined) -> Solved:
        """The path with its certificate, passed or not."""
        motion = Motion(
            self.terrain.vertices, self.robot, self.friction, nodes.body,
            nodes.margins.q, path_parameter(nodes.s, nodes.body),
        )  # fmt: skip
        return Solved(nodes, judge(motion))

    def way(self, nodes: Refined) -> Way:
        """What the plan's document says of a path."""
        return make_poses(self.path, self.robot, nodes, self.weights)
