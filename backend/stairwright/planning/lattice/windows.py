"""Long courses piece by piece: search a window, keep its first part, go on from there.

The robot spans less than a metre, so what lies farther ahead than a window cannot change what is
best now. Cost and memory grow with the length of the course, not with its square.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stairwright.planning.lattice.body_lattice import Bounds, LatticePath, make_lattice
from stairwright.planning.lattice.search import Search
from stairwright.planning.path_problem import PathProblem
from stairwright.planning.standing import StandingPose, scale

WINDOW = 5.0  # m, for legs of 0.4 m
_LAST = 5.5  # m; what is left of a course when the last window takes it all
_LAST_ASKED = 12.0  # m; the same where only the question is whether there is a path: no costs there
_AHEAD = 1.8  # m of a window that are searched again by the next


# Tables of earlier searches of the same course, which the next attempt or another friction can use.
Searches = dict[tuple[Any, ...], Search]
_KEPT = 8
_KEPT_FINE = 2  # of them on the finest lattice, whose tables are the largest


def find_path(
    q: PathProblem,
    bounds: Bounds,
    fine: float,
    cheap: bool = True,
    roll_back: bool = False,
    partial: bool = False,
    searches: Searches | None = None,
    brinks: bool = False,
) -> LatticePath:
    """The path from the first standing pose to the second; see `Search.find` for the arguments.

    With `brinks` wheels are sampled at edges, too. With `partial` it is the path as far as it goes
    where there is none to the end.
    """
    begin, end = q.ends
    size = scale(q.robot)
    rows_s, rows_body, quality, back = [], [], 255, False
    while True:
        stop = begin.wheels[0] + WINDOW * size
        last = end.wheels[0] - begin.wheels[0] < (_LAST if cheap else _LAST_ASKED) * size
        until = end if last else StandingPose((stop, stop - 0.2 * size), end.body)
        search = search_between(q, begin, until, bounds, fine, searches, brinks)
        found = search.find(
            q.friction, q.reserve, bounds.com, cheap or not last, roll_back, open_end=not last,
            partial=partial, torque=q.torque_share(bounds), weights=q.weights,
        )  # fmt: skip
        quality, back = min(quality, found.quality), back or found.back
        if found.quality == 0 and (not partial or found.s is None):
            return found
        if last and not cheap:
            return LatticePath(None, None, quality, None, back)
        assert found.s is not None
        assert found.body is not None
        if last or found.quality == 0:
            rows_s.append(found.s)
            rows_body.append(found.body)
            break
        keep = int(np.argmax(found.s[:, 0] >= stop - _AHEAD * size))
        rows_s.append(found.s[:keep])
        rows_body.append(found.body[:keep])
        begin = StandingPose((float(found.s[keep, 0]), float(found.s[keep, 1])), found.body[keep])
    s, body = np.concatenate(rows_s), np.concatenate(rows_body)
    return LatticePath(s, body, quality, (float(s[-1, 0]), float(s[-1, 1])), back)


def search_between(
    q: PathProblem,
    begin: StandingPose,
    end: StandingPose,
    bounds: Bounds,
    fine: float,
    searches: Searches | None,
    brinks: bool = False,
) -> Search:
    """A search between two stands; one of `searches` if it is there."""
    kept: Searches = {} if searches is None else searches
    key = (fine, bounds, brinks, begin.wheels, end.wheels, tuple(begin.body.tolist()))
    search = kept.get(key)
    if search is None:
        search = Search(q, begin, end, make_lattice(q.robot, fine), bounds, brinks)
        finest = sum(one[0] <= 1.0 for one in kept.copy())  # other threads search, too
        if len(kept) < _KEPT and (fine > 1.0 or finest < _KEPT_FINE):
            kept[key] = search
    return search
