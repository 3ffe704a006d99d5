"""Solvers of the balance controller's QP, on problems taken from real rollouts.

    python benchmarks/qp.py [--count 10000] [--quick] [--json FILE]

8 unknowns, 16 constraints. Problems are recorded while the plain controller climbs, at the friction
of the plan and below it, where cones are active. Every solver gets the same problems one by one;
its answer must cost no more than 1e-6 relative above Clarabel's and keep the constraints to as
much. Costs are compared, not forces: some directions are so flat that Clarabel itself leaves them
open by more than that. "via qpsolvers" is that package's one call for all solvers, "direct" the
solver's own interface.
"""

from __future__ import annotations

import argparse
import importlib.util
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from report import Row, percentile, publish

import stairwright as sw
from stairwright.control import qp
from stairwright.errors import Cancelled

Floats = NDArray[np.float64]
Solve = Callable[[Floats, Floats, Floats, Floats, Floats], Floats]

AGREES = 1e-6
SLOW = 2000  # problems for solvers that take much longer than the others
CASES = (
    ("single-stair-036", "a1_wheeled", 0.6),
    ("single-stair-036", "a1_wheeled_x", 0.5),
    ("three-stairs-up-down", "a1_wheeled", 0.5),
    ("ramp-30deg-025", "a1_wheeled_x", 0.6),
)


@dataclass(frozen=True)
class Problem:
    """min F' H F / 2 + g' F subject to C F <= d; `start` is the last step's solution."""

    H: Floats
    g: Floats
    C: Floats
    d: Floats
    start: Floats

    def cost(self, x: Floats) -> float:
        """The cost of `x`."""
        return float(0.5 * x @ self.H @ x + self.g @ x)


def record(count: int) -> list[Problem]:
    """Problems of control steps spread evenly over rollouts of all `CASES`."""
    share = -(-count // len(CASES))
    problems: list[Problem] = []
    for terrain, robot, friction in CASES:
        plan = sw.plan(terrain, robot, 0.6)
        every = max(1, int(plan.timing.total / 0.002 / share))
        own: list[Problem] = []
        steps = 0
        original = qp.solve

        def keep(solver: str, H: Floats, g: Floats, C: Floats, d: Floats, start: Floats) -> Floats:
            nonlocal steps
            if steps % every == 0:  # noqa: B023
                own.append(Problem(H, g, C, d, start.copy()))  # noqa: B023
            steps += 1
            return original(solver, H, g, C, d, start)  # noqa: B023

        def enough(_: float) -> None:
            if len(own) >= share:  # noqa: B023
                raise Cancelled("enough problems")

        qp.solve = keep
        try:
            sw.rollout(plan, friction, {"solver": "clarabel"}, progress=enough)
        except Cancelled:
            pass  # as intended
        finally:
            qp.solve = original
        problems += own[:share]
    return problems[:count]


def via(name: str) -> Solve:
    """One of the controller's settings `solver`, as the controller calls it."""
    return lambda H, g, C, d, start: qp.solve(name, H, g, C, d, start)


def direct_daqp(H: Floats, g: Floats, C: Floats, d: Floats, _: Floats) -> Floats:
    import daqp

    return np.asarray(
        daqp.solve(H, g, C, d, _NO_BOUND, _INEQUALITY, primal_tol=1e-9, dual_tol=1e-10)[0]
    )


def direct_quadprog(H: Floats, g: Floats, C: Floats, d: Floats, _: Floats) -> Floats:
    import quadprog

    return np.asarray(quadprog.solve_qp(H, -g, -C.T, -d)[0])


def direct_proxqp(H: Floats, g: Floats, C: Floats, d: Floats, _: Floats) -> Floats:
    from proxsuite import proxqp

    found = proxqp.dense.solve(H, g, None, None, C, _NO_BOUND, d, eps_abs=1e-9, eps_rel=0.0)
    return np.asarray(found.x)


def direct_piqp(H: Floats, g: Floats, C: Floats, d: Floats, _: Floats) -> Floats:
    import piqp

    solver = piqp.DenseSolver()
    solver.settings.eps_abs, solver.settings.eps_rel = 1e-10, 1e-11
    solver.setup(np.asfortranarray(H), g, G=np.asfortranarray(C), h_u=d)
    solver.solve()
    return np.asarray(solver.result.x)


def direct_osqp(H: Floats, g: Floats, C: Floats, d: Floats, _: Floats) -> Floats:
    import osqp
    from scipy.sparse import csc_matrix, triu

    solver = osqp.OSQP()
    tight = {"eps_abs": 1e-9, "eps_rel": 1e-9, "max_iter": 100_000, "verbose": False}
    solver.setup(csc_matrix(triu(H)), g, csc_matrix(C), _NO_BOUND, d, **tight)
    return np.asarray(solver.solve().x)


def direct_clarabel(H: Floats, g: Floats, C: Floats, d: Floats, _: Floats) -> Floats:
    import clarabel
    from scipy.sparse import csc_matrix, triu

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = 1e-11
    cones = [clarabel.NonnegativeConeT(16)]
    P = csc_matrix(triu(H))
    return np.array(clarabel.DefaultSolver(P, g, csc_matrix(C), d, cones, settings).solve().x)


_NO_BOUND = np.full(16, -1e30)
_INEQUALITY = np.zeros(16, np.int32)
NAMES = ("daqp", "quadprog", "proxqp", "piqp", "osqp", "clarabel")
PACKAGES = {"proxqp": "proxsuite"}
DIRECT: dict[str, Solve] = {
    "daqp": direct_daqp,
    "quadprog": direct_quadprog,
    "proxqp": direct_proxqp,
    "piqp": direct_piqp,
    "osqp": direct_osqp,
    "clarabel": direct_clarabel,
}


def measure(
    solve: Solve, problems: list[Problem], expected: list[float]
) -> tuple[list[float], int, float]:
    """Times [ms], how many agree with the `expected` costs, and the worst relative excess."""
    took, agreeing, worst = [], 0, 0.0
    for problem in problems[:20]:  # imports, first calls
        solve(problem.H, problem.g, problem.C, problem.d, problem.start)
    for problem, cost in zip(problems, expected, strict=False):
        begun = time.perf_counter()
        try:
            x = solve(problem.H, problem.g, problem.C, problem.d, problem.start)
        except Exception:  # noqa: BLE001, a solver that gives up, whatever it raises
            x = np.full(8, np.nan)
        took.append(1e3 * (time.perf_counter() - begun))
        excess = max(
            (problem.cost(x) - cost) / abs(cost),
            float(np.max(problem.C @ x - problem.d)) / float(np.abs(problem.d).max()),
        )
        agreeing += bool(excess < AGREES)
        worst = max(worst, excess) if np.isfinite(excess) else np.inf
    return took, agreeing, worst


def run(quick: bool = False, count: int | None = None) -> list[Row]:
    """All rows."""
    problems = record(count or (400 if quick else 10_000))
    solve = via("clarabel")
    expected = [p.cost(solve(p.H, p.g, p.C, p.d, p.start)) for p in problems]
    work = f"balance QP, {len(problems)} from rollouts"
    contenders: list[tuple[str, Solve]] = [("native (the default)", via("native"))]
    missing: list[str] = []
    for name in NAMES:
        if importlib.util.find_spec(PACKAGES.get(name, name)) is None:
            missing.append(name)
            continue
        contenders += [(f"{name}, direct", DIRECT[name]), (f"{name}, via qpsolvers", via(name))]
    rows: list[Row] = []
    ours: float | None = None
    for name, contender in contenders:
        slow = name.startswith(("osqp", "clarabel", "proxqp"))
        part = problems[:: max(1, len(problems) // SLOW)] if slow else problems
        costs = expected[:: max(1, len(problems) // SLOW)] if slow else expected
        took, agreeing, worst = measure(contender, part, costs)
        median = float(np.median(took))
        ours = ours or median
        note = (
            f"at most {worst:.0e} above Clarabel's cost" if worst > 0 else "never above Clarabel's"
        )
        p95, share = 1e3 * percentile(took, 0.95), f"{agreeing} of {len(part)}"
        rows.append(Row(work, name, 1e3 * median, p95, "us", median / ours, share, note))
    rows += [Row(work, name, note="not installed") for name in missing]
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int)
    parser.add_argument("--quick", action="store_true", help="400 problems")
    parser.add_argument("--json")
    given = parser.parse_args()
    warnings.filterwarnings("ignore", category=PendingDeprecationWarning)
    publish(run(given.quick, given.count), given.json)


if __name__ == "__main__":
    main()
