"""In which order a path is looked for: from one coarse search to finer and more forgiving ones.

1. STRICT: one coarse search with bounds that the finished path keeps. Nine of ten end here.
2. LOOSE: bounds broken by as much as rounding to the lattice takes; beside it a probe whether even
   the loosest bounds let a search through.
3. FINE: the loosest bounds, a finer lattice, wheels that may roll back, and places for them at
   the very edges of treads; the first path counts.
4. FINEST: where no coarse search comes through. Where the CoM has but a few centimetres, as down
   steep stairs with all knees back, a coarse lattice has no pose in them at all.

A path of the first two steps with little CoM margin, or motors that have next to nothing to spare,
is compared with what the next step finds. One with so little clearance that sensors' noise lets the
robot touch the ground is taken only where no attempt finds another.
Where motors are too weak for the path found, or all but so, all of it is done again with torques
looked at in the search. Which lattice then has a path that smoothing does not overload is luck: a
sixth of those refused for a torque had one on some other lattice, so three are tried. Where that
leads to none, it is done without, but with such paths repaired at all cost; where the user's
weights find none, again with the default weights. A path with little CoM margin is compared with
what the attempt that found it finds where that margin weighs ten times as much, too, and one whose
trunk nears the ground with what it finds where that is to stay farther off.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import replace

from .attempt import Attempt, Blocked, Solved
from .lattice.body_lattice import LOOSE, LOOSER, LOOSEST, STRICT
from .lattice.pieces import Piece, pieces, stops
from .lattice.search import Place
from .path_planner import PathPlanner
from .threads import race

STEADY = 0.9  # of a thin path's CoM margin that one with more clearance has to leave
HEAVY = 0.85  # of a motor's torque; a path that takes more is compared with one that spares motors
COARSE = 1.7  # lattice refinement of all but the first and the finest attempt

AT_ONCE = Attempt(2.0, STRICT)
FORGIVING = Attempt(COARSE, LOOSE)
POSSIBLE = Attempt(COARSE, LOOSEST, roll_back=True, probe=True)
MOST_FORGIVING = Attempt(COARSE, LOOSEST)
FINER = Attempt(1.4, LOOSER)
ROLLING_BACK = Attempt(COARSE, LOOSE, roll_back=True)
ON_BRINKS = Attempt(COARSE, LOOSEST, brinks=True)
FINEST = Attempt(1.0, LOOSE)
# Between them they had paths within torques in 11 of 11 cases in which one of 21 lattices had.
OTHER_LATTICES = (Attempt(1.4, STRICT), Attempt(1.4, LOOSE, brinks=True), FINEST)

Tried = dict[Attempt, Solved | Blocked]
Likely = Sequence[tuple[Attempt, bool]]  # attempts, and whether they are made within torques


def solve(
    planner: PathPlanner, pool: Executor, any_path: bool = False, likely: Likely = ()
) -> Solved | Blocked:
    """The first path that passes the certificate and is not needlessly thin, or what blocks it.

    Args:
        planner: The problem.
        pool: Who makes the attempts of one step.
        any_path: Whether a thin or heavy path will do, with which none is compared: there is one
            just where there is one without.
        likely: Attempts that found a path of a problem much like this one. Where any path will do
            they are made before others that come to nothing.
    """
    found = _search(planner, pool, any_path, likely)
    if planner.torques and isinstance(found, Blocked):
        found = _on_other_lattices(planner, pool, any_path) or found
    if isinstance(found, Solved):
        return found if any_path else _improved(planner, _lighter(planner, found, pool))
    if found.weak and not planner.torques:
        held = solve(planner.within_torques, pool, any_path, likely)
        if isinstance(held, Solved):
            return held
        if not planner.thorough:
            repaired = _search(planner.repairing_all, pool, any_path, likely)
            if isinstance(repaired, Solved):
                return repaired
            found = repaired
        return replace(held, weak=held.weak or found.weak, share=min(held.share, found.share))
    return solve(planner.unweighted, pool, any_path, likely) if planner.unweighted else found


def _on_other_lattices(planner: PathPlanner, pool: Executor, any_path: bool) -> Solved | None:
    """The path on them that spares the motors most, or the first."""
    with race(pool, planner.attempt, OTHER_LATTICES) as answers:
        paths = (one for one in answers if isinstance(one, Solved))
        if any_path:
            return next(paths, None)
        return min(paths, key=lambda path: path.torque_share, default=None)


def _lighter(planner: PathPlanner, found: Solved, pool: Executor) -> Solved:
    """The path `found`, or one that spares the motors where that one all but overloads them."""
    if planner.torques or found.torque_share <= HEAVY:
        return found
    held = _search(planner.within_torques, pool)
    if isinstance(held, Solved) and held.torque_share < found.torque_share:
        return found if held.grazes and not found.grazes else held
    return found


def _improved(planner: PathPlanner, found: Solved) -> Solved:
    """The path `found`, or what its attempt finds with more CoM margin or more room for the trunk,
    where it has little.
    """
    how, torques = planner.how(found)

    def again(changed: PathPlanner) -> Solved | None:
        other = changed.again(how, torques=torques)
        if isinstance(other, Blocked) or other.torque_share > max(found.torque_share, HEAVY):
            return None
        return other

    best = found
    if found.margin <= planner.thin and (other := again(planner.steadier)):
        best = max(found, other, key=lambda path: (not path.grazes, path.margin))
        if best is other:
            planner = planner.steadier
    if best.trunk_clearance <= planner.near and (other := again(planner.clearer)):
        steady = other.margin >= min(STEADY * best.margin, planner.thin)
        grazes = other.grazes and not best.grazes  # with a link
        if steady and other.trunk_clearance > best.trunk_clearance and not grazes:
            best = other
    return best


def quick(planner: PathPlanner) -> Solved | Blocked:
    """What two attempts lead to: enough to confirm that a changed problem has a plan.

    Where a search comes through and no path follows, a more forgiving one seldom does better.
    """
    forgiving = planner.attempt(FORGIVING)
    if isinstance(forgiving, Solved):
        return forgiving
    if forgiving.weak and not planner.torques:
        return quick(planner.within_torques)
    if forgiving.opened:
        return forgiving
    most = planner.attempt(MOST_FORGIVING)
    return most if isinstance(most, Solved) or most.opened else forgiving


def keeping_extra_margins(planner: PathPlanner) -> Solved | Blocked:
    """What the soonest attempts lead to, for a path known to exist but for extra margins.

    Where the search finds none that keeps some of them, the smoothing alone looks for it.
    """
    weak = False
    for attempt in (AT_ONCE, FORGIVING):
        found = planner.attempt(attempt)
        if isinstance(found, Solved):
            return found
        weak = found.weak is not None
        if weak and not planner.torques:
            held = keeping_extra_margins(planner.within_torques)
            if isinstance(held, Solved):
                return held
    if planner.in_search > 0.0 and not weak:
        return keeping_extra_margins(planner.with_extra_margins(planner.extra, in_search=0.0))
    return found


def _search(
    planner: PathPlanner, pool: Executor, any_path: bool = False, likely: Likely = ()
) -> Solved | Blocked:
    """The three steps."""
    tried: Tried = {}
    _make(planner, pool, [AT_ONCE], tried, lambda _: True)
    thin = planner.thin
    best = _best(tried, thin)
    enough = any_path or (
        best
        and not best.grazes
        and (_sound(best, thin) or (best.margin > thin and not planner.torques))
    )
    if best is not None and enough:
        return best  # what is heavy is searched for anew within torques
    if best is None:
        at_once = tried[AT_ONCE]
        assert isinstance(at_once, Blocked)
        if at_once.weak and not planner.torques:
            return at_once
        for attempt in [how for how, torques in likely if torques == planner.torques]:
            found = planner.attempt(attempt)
            if isinstance(found, Solved):
                return found
        obstructions, closed = _obstructions_ahead(planner, at_once, pool)
        if closed:
            blocked = Blocked(obstructions[0], False, stops=obstructions)
            return _looked_at_closely(planner, blocked)
    else:
        obstructions = ()

    second = [FORGIVING] if best else [FORGIVING, POSSIBLE]
    _make(planner, pool, second, tried, lambda _: any_path)
    best = _best(tried, thin)
    if best is not None and (any_path or not best.grazes):
        return best
    forgiving = tried[FORGIVING]
    if isinstance(forgiving, Blocked) and forgiving.weak and not planner.torques:
        return best or forgiving
    if best is not None or _opened(tried):
        # Where forgiving bounds let a search through, rolling back would be the same path again.
        opened = isinstance(forgiving, Solved) or forgiving.opened
        back = [] if opened else [ROLLING_BACK]
        last = [MOST_FORGIVING, FINER, *back, ON_BRINKS]
        _make(planner, pool, last, tried, lambda path: any_path or not path.grazes)
        best = _best(tried, thin)
        if best is not None:
            return best
    assert isinstance(forgiving, Blocked)
    blocked = _blocked(tried, obstructions or ((forgiving.reached,) if forgiving.reached else ()))
    return blocked if blocked.opened else _looked_at_closely(planner, blocked)


def _looked_at_closely(planner: PathPlanner, blocked: Blocked) -> Solved | Blocked:
    """What the finest lattice makes of a course that is closed to coarse ones."""
    around = pieces(planner, blocked.stops)
    if not around[0].whole and not all(
        planner.passes(one, FINEST.fine, FINEST.bounds) for one in around
    ):
        return blocked
    finest = planner.attempt(FINEST)
    return finest if isinstance(finest, Solved) or finest.opened else blocked


def _make(
    planner: PathPlanner, pool: Executor, attempts: Sequence[Attempt], tried: Tried,
    enough: Callable[[Solved], bool],
) -> None:  # fmt: skip
    """Make some attempts together, until one has a path that is enough.

    Whether searches come through need not be probed once one has.
    """
    with race(pool, planner.attempt, attempts) as answers:
        for attempt, answer in zip(attempts, answers, strict=False):
            tried[attempt] = answer
            if isinstance(answer, Solved) and enough(answer):
                break
            if (isinstance(answer, Solved) or answer.opened) and attempts[-1].probe:
                break


def _sound(path: Solved, thin: float) -> bool:
    """Whether a path is neither thin nor heavy and grazes nothing, so that none is compared."""
    return path.margin > thin and path.torque_share <= HEAVY and not path.grazes


def _best(tried: Tried, thin: float) -> Solved | None:
    """A sound path if there is one, with the most CoM margin; of such the one found first."""
    paths = [answer for answer in tried.values() if isinstance(answer, Solved)]
    return max(
        paths, key=lambda path: (_sound(path, thin), not path.grazes, path.margin), default=None
    )


def _opened(tried: Tried) -> bool:
    return any(isinstance(answer, Blocked) and answer.opened for answer in tried.values())


def _blocked(tried: Tried, obstructions: tuple[Place, ...]) -> Blocked:
    """What the attempts without a path say together."""
    blocked = [answer for answer in tried.values() if isinstance(answer, Blocked)]
    reached = [one for one in blocked if one.reached]
    found = [one for one in reached if one.opened] or reached  # rather where a bound is broken
    return Blocked(
        max((one.reached for one in found if one.reached), key=sum, default=None),
        _opened(tried),
        next((one.weak for one in blocked if one.weak), None),
        obstructions,
        min(one.share for one in blocked),
    )


def _obstructions_ahead(
    planner: PathPlanner, blocked: Blocked, pool: Executor
) -> tuple[tuple[Place, ...], bool]:
    """What stops loose searches from where a strict one ended; and whether no path leads past it.

    On long terrain that is sooner told than by searches from start to goal.
    """
    if blocked.opened or blocked.reached is None:
        return (), False
    here = pieces(planner, [blocked.reached])[0]
    if here.whole:
        return (), False

    def may_pass(piece: Piece) -> bool:
        return planner.passes(piece, COARSE, LOOSEST, roll_back=True)

    loose = pool.submit(stops, planner, blocked.reached, LOOSE, COARSE, planner.searches)
    passable = may_pass(here)
    found = loose.result()
    if len(found) < 2 or not passable:
        return found, bool(found) and not passable
    with race(pool, may_pass, pieces(planner, found[1:])) as answers:
        return found, not all(answers)
