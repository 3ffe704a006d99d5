"""Paths that stand a tolerance: with ever larger margins until the certificate holds for it.

Everything is planned at the lowest friction. Where a finished path lacks something on a terrain of
the set, the next search and smoothing are asked to keep that much more of it; the certificate
alone decides. Where that leads to none it is done once more from a path that spares the motors,
whatever was lacking: a third of those that were refused stand their tolerance then.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from stairwright.planning.attempt import Blocked, Solved
from stairwright.planning.certificate.certify import tolerated
from stairwright.planning.certificate.tolerance.checks import NAMES
from stairwright.planning.extra_margins import NO_EXTRA, ExtraMargins
from stairwright.planning.path_planner import PathPlanner
from stairwright.planning.plan import Check
from stairwright.planning.problem import Limit, Problem, ProblemKind
from stairwright.planning.strategy import keeping_extra_margins, solve
from stairwright.planning.tolerance import Tolerance

_ROUNDS = 8  # of planning; most that succeed do within four
_STEPS = (1.0, 0.5, 0.2)
_IDLE = 1  # of them that may come no nearer
_MORE = {  # margin per unit that a check lacks, and at least so much more [m]
    "trunk": (1.5, 0.004),
    "links": (0.6, 0.003),
    "legs": (1.0, 0.002),
    "reach": (0.08, 0.001),
}
_ASKED_OF = {"trunk": "trunk", "links": "links", "legs": "legs", "joints": "reach"}
_WHAT: dict[str, tuple[ProblemKind, str]] = {
    "trunk": ("clearance", "the trunk may touch the ground"),
    "links": ("clearance", "a leg may touch the ground"),
    "legs": ("clearance", "front and rear leg may come too close to each other"),
    "joints": ("joint_limit", "a leg may run out of its range"),
    "com": ("statics", "the robot may lose its balance"),
    "torque": ("torque", "motors may be too weak"),
}
_SHARES = 5  # halvings by which the share of the tolerance that is stood is told


@dataclass(frozen=True)
class Fallen:
    """The path that came nearest to standing the tolerance, and what it lacks."""

    planner: PathPlanner
    found: Solved
    checks: Sequence[Check]


def within_tolerance(
    planner: PathPlanner, first: Solved, tolerance: Tolerance, pool: Executor
) -> Solved | Fallen:
    """A path that stands `tolerance`, with the checks that say so in its certificate.

    Args:
        planner: The problem at the lowest friction.
        first: A path of it.
        tolerance: What it shall stand.
        pool: Who makes attempts.
    """
    outcome = _with_margins(planner, first, tolerance)
    if isinstance(outcome, Solved):
        return outcome
    sparing = solve(planner.sparing, pool)
    if isinstance(sparing, Blocked):
        return outcome
    other = _with_margins(planner.sparing, sparing, tolerance)
    if isinstance(other, Solved):
        return other
    return min(outcome, other, key=lambda fallen: _lacking(fallen.checks))


def _with_margins(planner: PathPlanner, first: Solved, tolerance: Tolerance) -> Solved | Fallen:
    """The same, with margins alone to change."""
    found, extra, nearest, idle = first, NO_EXTRA, None, 0
    off = float(np.hypot(tolerance.height, tolerance.place))
    usual = ExtraMargins(trunk=off, links=0.5 * off, legs=off, reach=off)
    for _ in range(_ROUNDS):
        checks = _checks(planner, found, tolerance)
        if all(check.passed for check in checks):
            return replace(found, certificate=found.certificate.with_checks(checks))
        better = nearest is None or _lacking(checks) < _lacking(nearest.checks)
        nearest = Fallen(planner, found, checks) if better or nearest is None else nearest
        idle = 0 if better else idle + 1
        if idle > _IDLE:
            break
        wider = usual if extra == NO_EXTRA else _widened(extra, checks)
        answer: Solved | Blocked = Blocked(None, False)
        for share in _STEPS:  # too much of it leaves no way: then less of the step
            wide = ExtraMargins(*(a + share * (b - a) for a, b in zip(extra, wider, strict=True)))
            answer = keeping_extra_margins(planner.with_extra_margins(wide))
            if isinstance(answer, Solved):
                break
        if not isinstance(answer, Solved) or wide == extra:
            break
        found, extra = answer, wide
    assert nearest is not None
    return nearest


def tolerance_problem(fallen: Fallen, tolerance: Tolerance) -> Problem:
    """What keeps the path that came nearest from standing `tolerance`, where, and by how much."""
    planner, checks = fallen.planner, {check.name: check for check in fallen.checks}
    what = max(NAMES, key=lambda key: _lack(checks[NAMES[key]]))
    check = checks[NAMES[what]]
    low, high = 0.0, 1.0
    for _ in range(_SHARES):
        share = 0.5 * (low + high)
        part = Tolerance(**{name: share * value for name, value in tolerance.asked.items()})
        passed = all(c.passed for c in _checks(planner, fallen.found, part))
        low, high = (share, high) if passed else (low, share)
    asked = ", ".join(f"{name} {value:g}" for name, value in tolerance.asked.items())
    kind, words = _WHAT[what]
    nodes = fallen.found.nodes
    progress = check.progress or 0.0
    motion = planner.motion(nodes)
    k = int(np.abs(motion.progress - progress).argmin())
    x, z = planner.path.contacts(nodes.s[k : k + 1, 0])[0].tolist()
    limit = Limit(needed=1.0, available=low, quantity="share of the tolerance", unit="1")
    what = f"with no tolerance there is a plan, with {asked} {words}"
    return Problem.told(kind, (x, z), progress, what, limit)


def _checks(planner: PathPlanner, found: Solved, tolerance: Tolerance) -> list[Check]:
    # The planner has the lowest friction already: what the certificate takes off is put on.
    motion = planner.motion(found.nodes)
    least = replace(motion, friction=motion.friction + tolerance.friction)
    return tolerated(least, tolerance)


def _widened(extra: ExtraMargins, checks: Sequence[Check]) -> ExtraMargins:
    """Larger margins where the checks lack something."""
    more = dict.fromkeys(ExtraMargins._fields, 0.0)
    by_name: Mapping[str, Check] = {check.name: check for check in checks}
    for key, field in _ASKED_OF.items():
        check = by_name[NAMES[key]]
        if not check.passed:
            gain, least = _MORE[field]
            more[field] = max(gain * (check.bound - check.value), least)
    return ExtraMargins(
        *(value + more[name] for name, value in zip(ExtraMargins._fields, extra, strict=True))
    )


def _lack(check: Check) -> float:
    """By how much a check fails, in comparable sizes; zero where it passes."""
    if check.passed:
        return 0.0
    lack = abs(check.value - check.bound)
    return min(lack * (0.1 if check.unit in ("rad", "1") else 1.0), 1.0)


def _lacking(checks: Sequence[Check]) -> float:
    return sum(_lack(check) for check in checks)
