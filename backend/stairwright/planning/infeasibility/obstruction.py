"""What stops the robot: the single change that would open the way, where, and how large.

Each candidate quantity is raised alone, on the coarse lattice and with bounds that forgive what
rounding takes: that gives the least value that may do. A candidate is only asked whether it opens
the way at a smaller relative change than the best one so far. The smallest names the problem, after
planning again with it: the answer is physically true, not a guess from the search's front.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from functools import cached_property, partial

import numpy as np

from stairwright.planning.attempt import Blocked
from stairwright.planning.infeasibility.confirmation import (
    Beyond,
    Cause,
    Ranked,
    alike,
    alone,
    confirmed,
    strengthened,
)
from stairwright.planning.infeasibility.relaxation import (
    AMPLE,
    CLOSE,
    FARTHEST,
    LONGEST,
    WIDE,
    Candidate,
    candidates_of,
    large_changes,
    leads_past,
)
from stairwright.planning.lattice.pieces import pieces
from stairwright.planning.lattice.search import Place
from stairwright.planning.path_planner import PathPlanner
from stairwright.planning.problem import Limit, Problem
from stairwright.planning.smoothing.path_document import PathPoses
from stairwright.planning.threads import race, search_threads

_ROUGH = 1.3  # relative precision of a factor before other quantities were asked
_ASKED = 2  # times that candidates are ranked anew, without those that led nowhere


def explain(
    ways: Sequence[tuple[PathPlanner, Blocked]],
) -> tuple[PathPlanner, Problem, PathPoses | None]:
    """Name what stops the robot, and tell how far it goes.

    Args:
        ways: The question with the knees bent in every way that they bend, and what its solution
            attempt returned; first the one that comes farthest.

    Returns:
        The question with the knees that need the least of what is named, the problem, and the poses
        up to there.
    """
    pool = search_threads()
    asked = [_Obstructed(*way, pool) for way in ways]
    causes = ((one, _cause(one, pool)) for one in asked)
    one, cause = next((found for found in causes if found[1]), (asked[0], None))
    others = [other for other in asked if other is not one]
    while cause and others:
        other = others.pop(0)
        less = alike(other.planner, cause, pool)
        if less:  # who had no plan with more may have one: in narrow places searches need luck
            one, cause = other, less
            others = [other for other in asked if other is not one]
    return one.planner, _problem(one.planner, one.reached, cause), one.way


class _Obstructed:
    """A question without an answer, and how far it goes.

    Args:
        planner: The question.
        blocked: What its solution attempt returned.
        pool: Who searches.
    """

    def __init__(self, planner: PathPlanner, blocked: Blocked, pool: Executor) -> None:
        self.planner = planner.within_torques if blocked.weak else planner
        self.blocked = blocked
        self._pool = pool

    @cached_property
    def ahead(self) -> Future[tuple[PathPoses | None, Place | None]]:
        """As far as it goes: found beside the first plan that is tried, where a thread rests."""
        return self._pool.submit(self.planner.partial)

    @property
    def way(self) -> PathPoses | None:
        """The poses up to where it ends."""
        return self.ahead.result()[0]

    @property
    def reached(self) -> Place | None:
        """Where it ends."""
        ended = self.ahead.result()[1]
        return self.blocked.reached if self.blocked.opened or not ended else ended


def _cause(obstructed: _Obstructed, pool: Executor) -> Cause | None:
    """The single change that opens the way, if one does."""
    planner, blocked = obstructed.planner, obstructed.blocked

    def meanwhile() -> object:
        return obstructed.ahead

    candidates = candidates_of(planner)
    motors = [one for one in candidates if one.quantity == f"{blocked.weak} torque"]
    if motors and blocked.opened:
        # A search came through: a little more torque is what its path most likely lacks.
        cause = strengthened(planner, motors[0], blocked.share, pool)
        if cause is not None:
            return cause
    places = list(blocked.stops)
    if not _whole(planner, places) and leads_past(planner, places):
        places.clear()  # some poses there lead on, but no way leads to them
    if blocked.opened and leads_past(planner, places):
        # Searches come through with whatever is changed, and as it is: plans alone tell what lacks.
        meanwhile()
        grip, *candidates = candidates
        answer = confirmed(planner, [(grip, 1.0 + CLOSE)], places, pool)
        if isinstance(answer, Cause):
            return answer
    for _ in range(_ASKED):
        ranked, answer = _answered(planner, candidates, places, pool, meanwhile)
        if answer is not None:
            return answer
        tried = [candidate for candidate, _ in ranked]
        candidates = [one for one in candidates if one not in tried]
        if not tried or not candidates:
            break
    if motors and not blocked.opened:
        # Much more torque: what searches told of a little led to no plan.
        cause = strengthened(planner, motors[0], blocked.share, pool)
        if cause is not None:
            return cause
    if planner.friction < AMPLE:
        answer = alone(planner, candidates_of(planner)[0], AMPLE / planner.friction, pool)
        if answer is not None:
            return answer
    for change in large_changes(planner):  # where no single change of grip or robot is enough
        _, answer = _answered(planner, [change], places, pool, meanwhile)
        if answer is not None:
            return answer
    return None


def _answered(
    planner: PathPlanner,
    candidates: list[Candidate],
    places: list[Place],
    pool: Executor,
    meanwhile: Callable[[], object],
) -> tuple[Ranked, Cause | None]:
    """Candidates in their order, and the one that opens the way with its least factor.

    Candidates are asked whether they lead past `places`; where one does that stops elsewhere, that
    place is added and all are asked again. Without places all of the course is asked.
    """
    while True:
        ranked = _ranked(planner, candidates, places, pool)
        meanwhile()
        answer = confirmed(planner, ranked, places, pool)
        if not isinstance(answer, Beyond):
            return ranked, answer
        if any(piece.has(planner, answer.place) for piece in pieces(planner, places)):
            places.clear()  # what happens there depends on more than was asked
        else:
            places.append(answer.place)


def _ranked(
    planner: PathPlanner, candidates: list[Candidate], places: list[Place], pool: Executor
) -> Ranked:
    """Candidates that open the way past `places`, least factor first.

    The least factor is told precisely; the others are factors that do.
    """
    first, *others = candidates
    least = _least(planner, first, places, math.inf, _ROUGH, pool)
    low, ratio = least or (1.0, math.inf)
    ranked = [(first, ratio)] if least else []
    asked = [(one, one.highest(ratio)) for one in others if one.highest(ratio) > 1.0]
    opened = list(pool.map(lambda one: one[0].opens(planner, places, one[1]), asked))
    able = [one for one, opens in zip(asked, opened, strict=True) if opens]
    for candidate, high in sorted(able, key=lambda one: one[1]):
        found = _least(planner, candidate, places, ratio, 1.0 + CLOSE, pool, high)
        if found is not None:
            ratio = found[1]
            ranked.insert(0, (candidate, ratio))
        else:
            ranked.append((candidate, candidate.highest(ratio)))
    # What was told roughly is told precisely where it may be the least.
    if least is not None:
        leads = ranked[0][0] is first
        high = ratio if leads else first.highest(ratio)
        if high > low and (leads or first.opens(planner, places, high)):
            opens = partial(first.opens, planner, places)
            ratio = _narrow(opens, low, high, 1.0 + CLOSE, pool)[1]
            ranked = [(first, ratio), *(one for one in ranked if one[0] is not first)]
    return ranked


def _least(
    planner: PathPlanner,
    candidate: Candidate,
    places: list[Place],
    below: float,
    close: float,
    pool: Executor,
    known: float = math.inf,
) -> tuple[float, float] | None:
    """Factors of which the larger opens the way, if less than `below`, and the smaller does not.

    Args:
        course, candidate, places, pool: Who asks about what.
        below: The factor is of interest if it is less.
        close: Largest quotient of the factors.
        known: A factor that opens the way.
    """
    high = candidate.highest(below)
    if high <= 1.0:
        return None
    opens = partial(candidate.opens, planner, places)
    if known <= high:
        return _narrow(opens, 1.0, known, close, pool)
    middle = math.sqrt(high)
    with race(pool, opens, (middle, high)) as answers:
        ends = (1.0, middle) if next(answers) else (middle, high) if next(answers) else None
    return ends and _narrow(opens, *ends, close, pool)


def _narrow(
    enough: Callable[[float], bool], low: float, high: float, close: float, pool: Executor
) -> tuple[float, float]:
    """Bring together a factor that is not enough and one that is; two are asked at once.

    Args:
        enough: Asked about factors.
        low, high: The factors.
        close: Largest quotient of those that are returned.
        pool: Who asks.
    """
    while high / low > close:
        a, b = (low ** (1 - k / 3) * high ** (k / 3) for k in (1, 2))
        with race(pool, enough, (a, b)) as answers:
            if next(answers):
                high = a
            elif next(answers):
                low, high = a, b
            else:
                low = b
    return low, high


def _whole(planner: PathPlanner, places: list[Place]) -> bool:
    """Whether questions about `places` are asked of all of the course."""
    return pieces(planner, places)[0].whole


def undiagnosed(planner: PathPlanner, blocked: Blocked) -> Problem:
    """Where the wheels end, without looking for what would open the way."""
    at, progress, stop = _end(planner, blocked.reached)
    return Problem.told("reach", at, progress, f"not looked into: {stop}")


def _end(planner: PathPlanner, reached: Place | None) -> tuple[tuple[float, float], float, str]:
    """Where the wheels end: the place (x, z) and the progress up to there [m], and which do."""
    begin, end = planner.ends
    front, rear = reached or begin.wheels
    stopped, wheel = (rear, "rear") if front >= end.wheels[0] - 1e-6 else (front, "front")
    x, z = planner.path.contacts(np.array([stopped]))[0].tolist()
    progress = max(0.0, 0.5 * (front + rear - sum(begin.wheels)))
    return (x, z), progress, f"the {wheel} wheels stop"


def _problem(planner: PathPlanner, reached: Place | None, cause: Cause | None) -> Problem:
    """What stops the wheels where they end, and what would be enough."""
    at, progress, stop = _end(planner, reached)
    if cause is None:
        what = (
            f"neither legs of {LONGEST:g} times the length with friction {AMPLE:g}, a profile of a "
            f"fiftieth of the height, joints that turn {WIDE:g} rad farther nor hips {FARTHEST:g} "
            f"times as far apart would do: {stop}"
        )
        return Problem.told("reach", at, progress, what)
    candidate = cause.candidate
    limit = Limit(
        needed=candidate.at(cause.upper), available=candidate.available,
        quantity=candidate.quantity, unit=candidate.unit, given=dict(candidate.given),
        confirmed=(candidate.at(cause.lower), candidate.at(cause.upper)),
    )  # fmt: skip
    return Problem.told(candidate.kind, at, progress, stop, limit)
