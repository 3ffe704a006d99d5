"""Questions about a piece of a course: a path to the goal leads through it, or there is none.

A piece is longer than any two places of the wheels are apart. On a long course it tells sooner that
nothing leads past an obstruction, and whether a change would.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from stairwright.planning.lattice.body_lattice import Bounds
from stairwright.planning.lattice.search import Place
from stairwright.planning.lattice.windows import WINDOW, Searches, find_path, search_between
from stairwright.planning.path_problem import PathProblem
from stairwright.planning.standing import StandingPose, scale

_BEHIND, _BEYOND = 0.3, 1.0  # m; behind the rear and ahead of the front wheel, for legs of 0.4 m
_EDGE = 0.2  # m; a path that ends this near to a piece's open end ends where nobody has asked
_MOST = 0.6  # of a course; larger pieces are not sooner asked than all of it


class Piece(NamedTuple):
    """From arc length `low` of the rear wheel to `high` of the front wheel [m].

    At an open end any pose will do that the robot can have there; others are ends of the course.
    """

    low: float
    high: float
    open_start: bool
    open_end: bool

    @property
    def whole(self) -> bool:
        """Whether it is all of a course."""
        return not (self.open_start or self.open_end)

    def has(self, q: PathProblem, place: Place) -> bool:
        """Whether what happens at a place has been asked with this piece."""
        edge = _EDGE * scale(q.robot) if self.open_end else 0.0
        return place[1] >= self.low and place[0] <= self.high - edge


def pieces(q: PathProblem, places: Iterable[Place]) -> list[Piece]:
    """Pieces round `places` that do not overlap; all of the course where they are most of it."""
    begin, end = q.ends
    whole = Piece(begin.wheels[1], end.wheels[0], False, False)
    most = _MOST * (whole.high - whole.low)
    if most < (_BEHIND + _BEYOND) * scale(q.robot):
        return [whole]
    found: list[Piece] = []
    for one in sorted(_round(q, place) for place in places):
        if found and one.low <= found[-1].high:
            last = max(found[-1], one, key=lambda piece: piece.high)
            found[-1] = found[-1]._replace(high=last.high, open_end=last.open_end)
        else:
            found.append(one)
    length = sum(one.high - one.low for one in found)
    return found if found and length < most else [whole]


def passes(
    q: PathProblem,
    piece: Piece,
    bounds: Bounds,
    fine: float,
    roll_back: bool = False,
    searches: Searches | None = None,
) -> bool:
    """Whether a path leads through `piece`.

    Args:
        q: The question.
        piece: Of its course.
        bounds, fine, roll_back, searches: See `find_path`.
    """
    if piece.whole:
        found = find_path(q, bounds, fine, False, roll_back, searches=searches)
    else:
        search = search_between(q, *_ends(q, piece), bounds, fine, searches)
        found = search.find(
            q.friction, q.reserve, bounds.com, False, roll_back, piece.open_start, piece.open_end,
            torque=q.torque_share(bounds),
        )  # fmt: skip
    return found.quality > 0


def stops(
    q: PathProblem, place: Place, bounds: Bounds, fine: float, searches: Searches | None = None
) -> tuple[Place, ...]:
    """Where paths end that begin at any pose behind `place`, and so on from there.

    Returns:
        Arc lengths of front and rear wheel, in order, as far as a window of the course reaches;
        empty where a path leads to its end.
    """
    end = q.ends[1]
    piece = _round(q, place)
    high = piece.low + WINDOW * scale(q.robot)
    open_end = high < end.wheels[0]
    piece = piece._replace(high=high if open_end else end.wheels[0], open_end=open_end)
    search = search_between(q, *_ends(q, piece), bounds, fine, searches)
    return tuple(search.stops(q.friction, bounds.com, open_end, q.torque_share(bounds)))


def _round(q: PathProblem, place: Place) -> Piece:
    """The piece round `place`."""
    begin, end = q.ends
    size = scale(q.robot)
    low = max(place[1] - _BEHIND * size, begin.wheels[1])
    s = np.arange(place[0] + _BEYOND * size, end.wheels[0], 0.05)
    gaps = np.hypot(*(q.path.centres(s) - q.path.centres(np.array([low]))).T)
    far = np.flatnonzero(gaps > q.robot_model.most_wheel_distance)
    high = float(s[far[0]]) if len(far) else end.wheels[0]
    return Piece(low, high, low > begin.wheels[1], high < end.wheels[0])


def _ends(q: PathProblem, piece: Piece) -> tuple[StandingPose, StandingPose]:
    """Stands at the ends; of those at open ends only the wheels' arc length has a meaning."""
    begin, end = q.ends
    return (
        StandingPose((piece.low, piece.low), begin.body) if piece.open_start else begin,
        StandingPose((piece.high, piece.high), end.body) if piece.open_end else end,
    )
