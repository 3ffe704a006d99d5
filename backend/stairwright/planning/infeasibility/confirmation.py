"""What searches say that it takes, confirmed by plans: with as much and with a little more there is
one, with a little less there is none.

Factors are looked at on a grid of steps of 2 %. With the one that is named, and with the next one,
planning finds a certified plan; with the one before, all of planning, every attempt of the
strategy, finds none: the verdict of the planner that is asked, not of a search that stands in for
it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from concurrent.futures import Executor
from dataclasses import dataclass

from stairwright.planning.attempt import Blocked, Solved
from stairwright.planning.infeasibility.bracket import Bracket
from stairwright.planning.infeasibility.relaxation import Candidate
from stairwright.planning.lattice.pieces import pieces
from stairwright.planning.lattice.search import Place
from stairwright.planning.path_planner import PathPlanner
from stairwright.planning.smoothing.node_margins import FIRM_TORQUE
from stairwright.planning.threads import in_this_thread, race

Ranked = list[tuple[Candidate, float]]  # candidates, and factors that open the way

_STEP = 1.02
# Planning is tried so many steps above the least factor, as far as the candidate goes.
_MORE = (0, 10, 26, 50, 70, 110, 200)
_RIVALS = 2  # candidates for which planning is tried
_RISES = 6  # times that motors are made stronger, by as much as the path lacks that came of it
_LOOKS = 30  # questions about amounts, so that an answer comes in time


@dataclass(frozen=True)
class Cause:
    """What opens the way.

    Attributes:
        candidate: The quantity.
        lower: A factor with which all of planning finds no plan.
        upper: The least factor with which it is known to find one.
    """

    candidate: Candidate
    lower: float
    upper: float


@dataclass(frozen=True)
class Beyond:
    """Where a way ends that was thought open."""

    place: Place


def confirmed(
    planner: PathPlanner, ranked: Ranked, places: list[Place], pool: Executor
) -> Cause | Beyond | None:
    """The least factor with which a certified plan exists, and of which of the `ranked`.

    Steps from those told on are tried, the least first, two at once, until one has a plan.

    Args:
        planner: The question.
        ranked: Candidates and factors.
        places: What the factors are known to lead past.
        pool: Who tries.
    """
    tries = sorted(
        {(min(_steps(ratio) + more, _steps(one.most)), k)
         for k, (one, ratio) in enumerate(ranked[:_RIVALS]) for more in _MORE},
    )  # fmt: skip
    whole = pieces(planner, places)[0].whole

    def lead(one: tuple[int, int]) -> Solved | Blocked:
        step, k = one
        candidate = ranked[k][0]
        return candidate.attempt(planner, _ratio(candidate, step))

    failed: list[tuple[int, int]] = []
    leading: tuple[int, int] | None = None
    with race(pool, lead, tries) as ends:
        for one, end in zip(tries, ends, strict=True):
            if isinstance(end, Solved):
                leading = one
                break
            if not (whole or failed or end.opened):
                return Beyond(end.reached or planner.ends[0].wheels)
            failed.append(one)
    if leading is None:
        return None
    step, k = leading
    doubted = [less for less, other in failed if other == k]
    return _settled(planner, ranked[k][0], step, doubted, pool)


def strengthened(
    planner: PathPlanner, motors: Candidate, share: float, pool: Executor
) -> Cause | None:
    """The least factor on the torque of `motors` with which a certified plan exists.

    Args:
        planner: The question, searched within torques.
        motors: The quantity.
        share: What the path takes of their torque that was found without them in mind.
        pool: Who tries.
    """
    step = _steps(share / FIRM_TORQUE)
    failed: list[int] = []
    while len(failed) < _RISES and step <= _steps(motors.most):
        end = motors.attempt(planner, _ratio(motors, step))
        if isinstance(end, Solved):
            return _settled(planner, motors, step, failed, pool)
        if motors.quantity != f"{end.weak} torque":
            break  # others are too weak, or something else is missing
        failed.append(step)
        # A path that takes more than there is tells how much it would need.
        step = max(step + 1, _steps(_ratio(motors, step) * end.share / FIRM_TORQUE))
    return None


def alone(planner: PathPlanner, candidate: Candidate, ratio: float, pool: Executor) -> Cause | None:
    """The least factor with which there is a plan, where all of planning has one with `ratio`.

    Searches that stand in for planning may have missed it.
    """
    step = _steps(ratio)
    if not candidate.feasible(planner, _ratio(candidate, step), pool):
        return None
    return _settled(planner, candidate, step, (), pool)


def alike(planner: PathPlanner, cause: Cause, pool: Executor) -> Cause | None:
    """What opens the way for another question with less of the same change, if less does."""
    if cause.lower <= 1.0:
        return None
    found = alone(planner, cause.candidate.anew(), cause.lower, pool)
    return found if found and found.upper < cause.upper else None


def _settled(
    planner: PathPlanner, candidate: Candidate, step: int, doubted: Iterable[int], pool: Executor
) -> Cause | None:
    """The step between a plan and none, looked for from one with which there is a plan.

    All of planning takes several times as long as one attempt: the attempts that had a plan with a
    little more tell where it may be, and there all of planning is asked. Steps that are `doubted`
    did not lead to a plan at the first attempt.
    """

    def works(one: tuple[int, bool]) -> bool:
        step, settles = one
        if not settles:
            return candidate.feasible_likewise(planner, _ratio(candidate, step))
        helpers = pool if len(asked) == 1 else in_this_thread()  # which is one of the pool's
        return candidate.feasible(planner, _ratio(candidate, step), helpers)

    bracket = Bracket(_steps(candidate.most))
    for less in doubted:
        bracket.tell(less, works=False, settled=False)
    bracket.tell(step, works=True)
    for _ in range(_LOOKS):
        asked = [(step, bracket.settles(step)) for step in bracket.next_steps()]
        if not asked:
            break
        with race(pool, works, asked) as answers:
            for (step, settles), found in zip(asked, answers, strict=False):
                bracket.tell(step, found, settles)
                if found:
                    break
    if bracket.high is None or bracket.low in bracket.doubted:
        return None
    return Cause(candidate, _ratio(candidate, bracket.low), _ratio(candidate, bracket.high))


def _steps(ratio: float) -> int:
    """The least number of steps whose factor is at least `ratio`."""
    return max(1, math.ceil(math.log(ratio) / math.log(_STEP) - 1e-9))


def _ratio(candidate: Candidate, step: int) -> float:
    """The factor after a number of steps; the last one may be shorter."""
    return min(_STEP**step, candidate.most)
