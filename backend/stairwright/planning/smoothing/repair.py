"""Local repair: where a path breaks a bound, a piece of it is smoothed anew, or searched anew.

Most paths that smoothing cannot make good are so in one or two places of a few centimetres. There
a finer lattice costs little, and finds what a coarse one has rounded away: also other places for
the wheels, which no smoothing moves.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stairwright.arrays import Floats, Ints
from stairwright.planning.lattice.body_lattice import LOOSE, make_lattice
from stairwright.planning.lattice.search import Search
from stairwright.planning.path_problem import PathProblem
from stairwright.planning.smoothing.refine import NodeSpacing, Refined, concatenated, refine
from stairwright.planning.standing import scale
from stairwright.planning.threads import still_wanted
from stairwright.planning.wheel_samples import rolled


class Stage(NamedTuple):
    """One kind of repair.

    Attributes:
        width: Of what is laid anew on either side of a bad place, for legs of 0.4 m [m].
        fine: The search's lattice; None: no search, the piece is only smoothed anew.
        depth: By how much bounds may be broken where it is tried: it repairs no more [m].
        places: Most bad places; more are hardly ever all repaired, and each takes its time.
        longest: Largest extent of a bad place, for legs of 0.4 m [m]; a fine search of more takes
            as long as the whole course, and has repaired nothing.
    """

    width: float
    fine: float | None
    depth: float = np.inf
    places: int = 1000
    longest: float = np.inf


STAGES = (Stage(0.1, None, depth=0.008), Stage(0.15, 1.25), Stage(0.25, 1.0, places=1, longest=0.9))
_BLEND = 0.08  # m on either side of that, which are smoothed with it
_HELD = 3  # nodes at the ends of a piece stay, so that it meets the path without a kink
_SPACINGS = (NodeSpacing(0.5, 0.006, 0.6), NodeSpacing(0.15, 0.006, 0.6, thorough=True))


def repair(
    q: PathProblem, found: Refined, bad: Ints, stage: Stage, brinks: bool = False
) -> Refined:
    """The path with better pieces round its `bad` nodes; the same one if there are none.

    With `brinks` searches of pieces sample wheels at edges, too; see `Attempt`.
    """
    u = np.concatenate([[0.0], np.cumsum(rolled(found.s))])
    size = scale(q.robot)
    width, blend = stage.width * size, _BLEND * size
    parts, last = [], 0
    places = _places(u[bad], width + blend)
    for low, high in places if len(places) <= stage.places else []:
        still_wanted()
        inner = _nodes(u, low - width, high + width)
        begin, end = _nodes(u, low - width - blend, high + width + blend)
        deep = found.margins.least_slack[begin : end + 1].min() < -stage.depth
        if deep or high - low > stage.longest * size:
            continue
        begin, inner = max(begin, last), (max(inner[0], last), inner[1])
        path = _local_path(q, found, begin, end, *inner, stage.fine, brinks)
        if path is None:
            continue
        piece = _smoothed(q, found.part(begin, end + 1), path, found.s[bad])
        if piece is not None:
            parts += [found.part(last, begin), piece]
            last = end + 1
    return concatenated([*parts, found.part(last, len(found.s))]) if parts else found


def _places(u: Floats, apart: float) -> list[tuple[float, float]]:
    """Bad places by their first and last path parameter; near ones are one."""
    out: list[tuple[float, float]] = []
    for at in u.tolist():
        if out and at - out[-1][1] <= 2.0 * apart:
            out[-1] = (out[-1][0], at)
        else:
            out.append((at, at))
    return out


def _nodes(u: Floats, low: float, high: float) -> tuple[int, int]:
    """First and last node in [low, high], at most one outside."""
    return max(0, int(np.searchsorted(u, low)) - 1), min(int(np.searchsorted(u, high)), len(u) - 1)


def _local_path(
    q: PathProblem, found: Refined, begin: int, end: int, a: int, b: int, fine: float | None,
    brinks: bool,
) -> tuple[Floats, Floats] | None:  # fmt: skip
    """Arc lengths and trunk poses from node `begin` to node `end`, new ones between `a` and `b`."""
    s, body = found.s, found.body
    if fine is None:
        return s[begin : end + 1], body[begin : end + 1]
    if (s[b] < s[a]).any():
        return None
    search = Search(
        q, found.standing_pose(a), found.standing_pose(b), make_lattice(q.robot, fine), LOOSE,
        brinks,
    )  # fmt: skip
    still_wanted()
    new = search.find(q.friction, q.reserve, LOOSE.com, torque=q.torque_share(LOOSE))
    if new.s is None or new.body is None:
        return None
    return (
        np.concatenate([s[begin:a], new.s, s[b + 1 : end + 1]]),
        np.concatenate([body[begin:a], new.body, body[b + 1 : end + 1]]),
    )


def _smoothed(
    q: PathProblem, old: Refined, path: tuple[Floats, Floats], bad: Floats
) -> Refined | None:
    """The path as nodes, if they are better than the `old` ones, which are `bad` at (m, 2) arc
    lengths.
    """
    ends = (old.standing_pose(0), old.standing_pose(-1))
    pieces = []
    for spacing in _SPACINGS:
        still_wanted()
        pieces.append(refine(q, ends, *path, spacing, _HELD, as_drawn=bad))
        if not len(pieces[-1].margins.bad):
            return pieces[-1]
    best = max(pieces, key=lambda one: one.margins.worst)
    return best if best.margins.worst > old.margins.worst else None
