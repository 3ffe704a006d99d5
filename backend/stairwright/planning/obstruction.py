"""What stops the robot: the single change that would open the way, where, and how large.

Each candidate quantity is raised alone, on the coarse lattice and with bounds that forgive what
rounding takes: that gives the least value that may do. A candidate is only asked whether it opens
the way at a smaller relative change than the best one so far. The smallest names the problem, after
planning again with it: the answer is physically true, not a guess from the search's front.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import Executor
from functools import cache, partial

import numpy as np

from .path.record import Motor
from .path.solve import QUICK, Blocked, Course, Rung
from .plan import Limit, Pose, Problem
from .relaxation import (
    AMPLE,
    CLOSE,
    LONGEST,
    Candidate,
    bold_candidates,
    candidates_of,
    motor_torque,
)
from .threads import race, search_threads

Way = tuple[list[Pose], list[int], float]  # poses, key poses, duration [s]

_ROUGH = 1.3  # relative precision of a factor before other quantities were asked
_MORE = (1.005, 1.05, 1.15, 1.3, 1.7, 2.5, 4.0)  # on the least factor: planning is tried there
_SURE = 1.15  # relative precision of a value that only whole plans can tell
_RIVALS = 2  # candidates for which planning is tried
_ASKED = 2  # times that candidates are ranked anew, without those that led nowhere


def explain(course: Course, blocked: Blocked) -> tuple[Problem, Way]:
    """Name what stops `course`, and tell how far it goes.

    Args:
        course: The question without an answer.
        blocked: What its solution attempt returned.
    """
    pool = search_threads()
    # As far as it goes: found beside the first plan that is tried, where a thread is at leisure.
    partial_way = cache(lambda: pool.submit(course.partial))
    problem = _name(course, blocked, pool, partial_way)
    return problem, partial_way().result()


def _name(
    course: Course, blocked: Blocked, pool: Executor, meanwhile: Callable[[], object]
) -> Problem:
    if blocked.weak:
        torque = _torque(course, blocked, blocked.weak)
        if torque is not None:
            return torque
    candidates = candidates_of(course)
    for _ in range(_ASKED):
        ranked = _ranked(course, candidates, pool)
        meanwhile()
        answer = _confirmed(course, ranked, pool)
        if answer is not None:
            return _problem(course, blocked, *answer)
        tried = [candidate for candidate, _ in ranked]
        candidates = [one for one in candidates if one not in tried]
        if not tried or not candidates:
            break
    return _hopeless(course, blocked, pool)


def _ranked(
    course: Course, candidates: list[Candidate], pool: Executor
) -> list[tuple[Candidate, float]]:
    """Candidates that open the way, least factor first.

    The least factor is told precisely; the others are factors that do.
    """
    first, *others = candidates
    least = _least(course, first, math.inf, _ROUGH, pool)
    low, ratio = least or (1.0, math.inf)
    ranked = [(first, ratio)] if least else []
    asked = [(one, one.highest(ratio)) for one in others if one.highest(ratio) > 1.0]
    opened = list(pool.map(lambda one: one[0].opens(course, one[1]), asked))
    able = [one for one, opens in zip(asked, opened, strict=True) if opens]
    for candidate, high in sorted(able, key=lambda one: one[1]):
        found = _least(course, candidate, ratio, 1.0 + CLOSE, pool, high)
        if found is not None:
            ratio = found[1]
            ranked.insert(0, (candidate, ratio))
        else:
            ranked.append((candidate, candidate.highest(ratio)))
    # What was told roughly is told precisely where it may be the least.
    if least is not None:
        leads = ranked[0][0] is first
        high = ratio if leads else first.highest(ratio)
        if high > low and (leads or first.opens(course, high)):
            ratio = _narrow(partial(first.opens, course), low, high, 1.0 + CLOSE, pool)[1]
            ranked = [(first, ratio), *(one for one in ranked if one[0] is not first)]
    return ranked


def _least(
    course: Course,
    candidate: Candidate,
    below: float,
    close: float,
    pool: Executor,
    known: float = math.inf,
) -> tuple[float, float] | None:
    """Factors of which the larger opens the way, if less than `below`, and the smaller does not.

    Args:
        course, candidate, pool: Who asks about what.
        below: The factor is of interest if it is less.
        close: Largest quotient of the factors.
        known: A factor that opens the way.
    """
    high = candidate.highest(below)
    if high <= 1.0:
        return None
    opens = partial(candidate.opens, course)
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


def _confirmed(
    course: Course, ranked: list[tuple[Candidate, float]], pool: Executor
) -> tuple[Candidate, float] | None:
    """The least factor with which a certified plan exists, and on which of the `ranked`.

    Factors from those told on are tried, the least first, two attempts at once.

    Args:
        course: The question.
        ranked: Candidates and factors.
        pool: Who tries.
    """
    tries = sorted(
        {(min(ratio * more, one.most), k)
         for k, (one, ratio) in enumerate(ranked[:_RIVALS]) for more in _MORE}
    )  # fmt: skip
    attempts = [(ratio, k, rung) for ratio, k in tries for rung in QUICK]
    low: dict[int, float] = {}

    def leads(attempt: tuple[float, int, Rung]) -> bool:
        ratio, k, rung = attempt
        return ranked[k][0].solves(course, ratio, (rung,))

    with race(pool, leads, attempts) as ends:
        for (ratio, k, rung), enough in zip(attempts, ends, strict=True):
            if enough:
                break
            if rung is QUICK[-1]:
                low[k] = ratio
        else:
            return None
    candidate = ranked[k][0]
    if k in low:
        ratio = _narrow(partial(candidate.solves, course), low[k], ratio, _SURE, pool)[1]
    return candidate, ratio


def _torque(course: Course, blocked: Blocked, motor: Motor) -> Problem | None:
    """The problem if the torque of one kind of motors alone stands in the way."""
    candidate = motor_torque(course.robot, motor)
    strong = candidate.change(course, candidate.limit).quick()
    if strong is None:
        return None
    if motor == "leg":
        used = max(candidate.limit - pose.margins.torque for pose in strong.poses)
    else:
        forces = np.array([pose.forces for pose in strong.poses])  # of pairs of wheels
        used = 0.5 * float(np.abs(forces[:, :, 0]).max()) * course.robot.wheel.radius
    ratio = 1.001 * used / candidate.available
    if ratio <= 1.0 or not candidate.solves(course, ratio):
        return None
    return _problem(course, blocked, candidate, ratio)


def _place(course: Course, blocked: Blocked) -> tuple[tuple[float, float], float, str]:
    """Contact point, progress and name of the wheel that is stopped."""
    begin, end = course.stands
    front, rear = blocked.reached or begin.wheels
    stopped, name = (rear, "rear") if front >= end.wheels[0] - 1e-6 else (front, "front")
    at = course.path.contacts(np.array([stopped]))[0]
    progress = 0.5 * (front + rear - sum(begin.wheels))
    return (float(at[0]), float(at[1])), max(0.0, float(progress)), name


def _problem(course: Course, blocked: Blocked, candidate: Candidate, ratio: float) -> Problem:
    value = candidate.at(ratio)
    at, progress, wheel = _place(course, blocked)
    unit = "" if candidate.unit == "1" else f" {candidate.unit}"
    message = (
        f"needs {candidate.quantity} {value:.3g}{unit}{candidate.given}, "
        f"has {candidate.available:.3g}{unit}: "
        f"the {wheel} wheels stop at x = {at[0]:.2f} m, z = {at[1]:.2f} m"
    )
    return Problem(
        kind=candidate.kind, at=at, progress=progress, message=message,
        limit=Limit(
            needed=value, available=candidate.available,
            quantity=candidate.quantity + candidate.given, unit=candidate.unit,
        ),
    )  # fmt: skip


def _hopeless(course: Course, blocked: Blocked, pool: Executor) -> Problem:
    """The problem where no single change of grip or robot is enough."""
    for bold in bold_candidates(course):
        answer = _confirmed(course, _ranked(course, [bold], pool), pool)
        if answer is not None:
            return _problem(course, blocked, *answer)
    at, progress, wheel = _place(course, blocked)
    message = (
        f"the {wheel} wheels stop at x = {at[0]:.2f} m, z = {at[1]:.2f} m, and neither legs of "
        f"{LONGEST:g} times the length with friction {AMPLE:g} nor a profile of a fiftieth of the "
        "height would change that"
    )
    return Problem(kind="reach", at=at, progress=progress, message=message)
