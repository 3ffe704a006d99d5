"""From lattice poses to the nodes of a path: smoothed, dense, and what they are worth.

The work is done by the native core (native/include/stairwright/smoothing/refine.hpp).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.planning.path_problem import PathProblem
from stairwright.planning.smoothing.node_margins import NodeMargins, joined
from stairwright.planning.standing import StandingPose
from stairwright.planning.threads import still_wanted


@dataclass(frozen=True)
class Refined:
    """Nodes: arc lengths (n, 2), trunk poses (n, 3), and what they are worth."""

    s: Floats
    body: Floats
    margins: NodeMargins

    def part(self, begin: int, end: int) -> Refined:
        """The nodes [begin, end)."""
        return Refined(self.s[begin:end], self.body[begin:end], self.margins.part(begin, end))

    def standing_pose(self, k: int) -> StandingPose:
        """Node `k` as the end of a piece."""
        return StandingPose((float(self.s[k, 0]), float(self.s[k, 1])), self.body[k])


def concatenated(parts: list[Refined]) -> Refined:
    """One path after the other."""
    s, body = np.concatenate([one.s for one in parts]), np.concatenate([one.body for one in parts])
    return Refined(s, body, joined([one.margins for one in parts]))


class NodeSpacing(NamedTuple):
    """How nodes are laid for the smoothing.

    Attributes:
        softness: How much they are smoothed before, and bent as little as possible by it.
        spacing: Of nodes, for legs of 0.4 m [m].
        swing: How much a motion of the trunk counts against the same travel of the wheels.
        thorough: Whether nodes settle each by itself, and wheels stop in every corner.
    """

    softness: float
    spacing: float
    swing: float
    thorough: bool = False


COARSE = NodeSpacing(1.0, 0.009, 0.3)
NOWHERE: Floats = np.empty((0, 2))


def refine_with_room(
    q: PathProblem, ends: tuple[StandingPose, StandingPose], s: Floats, body: Floats
) -> Refined:
    """Smooth a lattice path so that it keeps room for ground that is not as drawn, but not at the
    cost of a bound: where one is violated it keeps none.
    """
    found = refine(q, ends, s, body)
    if found.margins.worst >= 0.0:
        return found
    return refine(q, ends, s, body, as_drawn=found.s[found.margins.bad])


def refine(
    q: PathProblem,
    ends: tuple[StandingPose, StandingPose],
    s: Floats,
    body: Floats,
    spacing: NodeSpacing = COARSE,
    held: int = 1,
    as_drawn: Floats = NOWHERE,
) -> Refined:
    """Turn a lattice path into dense, smooth nodes.

    Args:
        q: The problem.
        ends: Where the path begins and ends.
        s: (n, 2) arc lengths of front and rear wheel [m].
        body: (n, 3) trunk poses.
        spacing: How nodes are laid.
        held: Nodes at either end that stay where they are.
        as_drawn: (m, 2) arc lengths of the wheels round which no room is kept for ground that is
            not as drawn.
    """
    still_wanted()
    both = np.array([[*end.wheels, *end.body] for end in ends])
    laid = _core.NodeSpacing(*spacing)
    nodes, margins = q.refine_problem.refine(both, np.hstack([s, body]), laid, held, as_drawn)
    still_wanted()
    wheels = np.ascontiguousarray(nodes[:, :2])
    return Refined(wheels, np.ascontiguousarray(nodes[:, 2:]), _named(q, wheels, margins))


def node_margins(q: PathProblem, s: Floats, body: Floats) -> NodeMargins:
    """What poses are worth: arc lengths (n, 2) and trunk poses (n, 3)."""
    return _named(q, s, q.refine_problem.margins(np.hstack([s, body])))


def _named(q: PathProblem, s: Floats, margins: dict[str, Floats]) -> NodeMargins:
    return NodeMargins(q.friction, q.robot.torque_limits, q.robot.legs[0].reach, s, **margins)
