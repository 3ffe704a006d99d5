"""An attempt at a path, and what came of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Ints
from stairwright.planning.certificate.certify import LINKS_CLEARANCE, ROOM, TRUNK_CLEARANCE
from stairwright.planning.lattice.body_lattice import Bounds
from stairwright.planning.lattice.search import Place
from stairwright.planning.plan import Certificate, Check
from stairwright.planning.smoothing.node_margins import LEAST_CLEARANCE, Motor
from stairwright.planning.smoothing.path_timing import path_parameter
from stairwright.planning.smoothing.refine import Refined


@dataclass(frozen=True)
class Attempt:
    """One attempt at a path.

    Attributes:
        fine: Lattice refinement; above 1 coarser. At 2 a search costs a tenth of one at 1, and the
            smoothing makes as good a path from it.
        bounds: What lattice poses keep.
        roll_back: Whether wheels may roll back.
        brinks: Whether wheels are sampled where they begin and end to roll round an edge, too. Down
            steep stairs the rear wheels have to stand there, to a centimetre, while the front ones
            land: farther back the legs are too short, farther on the edge is too slippery.
        probe: Only ask whether a search comes through.
    """

    fine: float
    bounds: Bounds
    roll_back: bool = False
    probe: bool = False
    brinks: bool = False


@dataclass(frozen=True)
class Solved:
    """A path and its certificate, which has passed unless the path is still to be repaired."""

    nodes: Refined
    certificate: Certificate

    @property
    def margin(self) -> float:
        """Thinnest margin of the CoM [m]."""
        return float(self.nodes.margins.firm_com_margin.min())

    @property
    def trunk_clearance(self) -> float:
        """Least clearance of the trunk [m]."""
        checks = self.certificate.checks
        return next(check.value for check in checks if check.name == TRUNK_CLEARANCE)

    @property
    def torque_share(self) -> float:
        """Largest static torque of any motor, over its limit."""
        return self.nodes.margins.torque_share

    @property
    def good(self) -> bool:
        """Whether it has passed, with as much clearance between its nodes as at them."""
        return self.certificate.passed and not self._nearer(LEAST_CLEARANCE)

    @property
    def grazes(self) -> bool:
        """Whether trunk or links come so near to the ground that sensors' noise lets them touch."""
        return bool(self._nearer(ROOM))

    @property
    def bad(self) -> Ints:
        """Nodes at which a check of the certificate is violated most, or clearance is least."""
        failed = [check for check in self.certificate.checks if not check.passed]
        progress = path_parameter(self.nodes.s, self.nodes.body)
        places = {
            int(np.abs(progress - check.progress).argmin())
            for check in failed + self._nearer(LEAST_CLEARANCE)
            if check.progress is not None
        }
        return np.array(sorted(places), np.int64)

    def _nearer(self, least: float) -> list[Check]:
        """What of trunk and links comes nearer to the ground than that [m]."""
        clearances = (TRUNK_CLEARANCE, LINKS_CLEARANCE)
        return [c for c in self.certificate.checks if c.name in clearances and c.value < least]


@dataclass(frozen=True)
class Blocked:
    """No certified path.

    Attributes:
        reached: Arc lengths where the path ends, or where a found path breaks a bound worst.
        stops: Where loose searches end: the place from the start, and others farther on.
        opened: Whether a search came through at all.
        weak: Motors whose torque a found path exceeded.
        share: What that path takes of a motor's torque, at most.
    """

    reached: Place | None
    opened: bool
    weak: Motor | None = None
    stops: tuple[Place, ...] = ()
    share: float = math.inf


# What came of attempts, by them and whether they were made within torques.
Outcomes = dict[tuple[Attempt, bool], Solved | Blocked]
