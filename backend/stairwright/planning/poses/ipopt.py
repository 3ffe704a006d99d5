"""Solving the pose problem: a ladder of solvers, from the fastest to the most patient."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.poses.extra_terms import NONE, ExtraTerms
from stairwright.planning.poses.nlp import EXTRA, GROUND, HIP, SELF, WHEEL, Layout, Problem, build
from stairwright.planning.poses.solution import Solution

_SQP = {
    "max_iter": 30,
    "tol_pr": 1e-8,
    "tol_du": 1e-6,
    "convexify_strategy": "eigen-clip",
    "print_header": False,
    "print_iteration": False,
    "print_status": False,
    "print_time": False,
    "error_on_fail": False,
}
_OPTIONS: dict[str, tuple[str, dict[str, Any]]] = {
    "daqp": ("sqpmethod", {**_SQP, "qpsol": "daqp", "qpsol_options": {"error_on_fail": False}}),
    # qpOASES would be a second attempt, but prints its licence to the standard output, where plans
    # go; proxqp and qrqp solved nothing that daqp did not, and took up to a second.
    "ipopt": (
        "ipopt",
        {
            "print_time": False,
            "error_on_fail": False,
            "ipopt.print_level": 0,
            "ipopt.sb": "yes",
            "ipopt.max_iter": 200,
            "ipopt.tol": 1e-7,
            "ipopt.constr_viol_tol": 1e-8,
            "ipopt.acceptable_tol": 1e-5,
        },
    ),
}


@dataclass(frozen=True)
class Bounds:
    """Bounds of one solve. SI units.

    Attributes:
        lower, upper: (9,) of the variables.
        clearance: Least distance of links (or points) from the terrain [m].
        apart: Least distance of the front leg from the rear one [m].
        hip: Least distance by which the rear contact lies behind the rear hip (eq 20) [m].
    """

    lower: Floats
    upper: Floats
    clearance: float
    apart: float
    hip: float


class PoseSolver:
    """The problem of one collision layout with its solvers, which are made when first needed."""

    def __init__(
        self, layout: Layout, links: bool, cells: int, extra: ExtraTerms, first: str
    ) -> None:
        self.problem: Problem = build(layout, links, cells, extra)
        self._first = first
        self._kinds = np.array(self.problem.rows)
        self._solvers: dict[str, Any] = {}

    def solve(
        self, parameters: Floats, bounds: Bounds, starts: list[Floats], patient: bool = True
    ) -> Solution:
        """The first solution that a solver finds from one of `starts`, else the least violated.

        Args:
            parameters: (p,) made by `poses.parameters`.
            bounds: Of variables and constraints.
            starts: First guesses (9,), best first.
            patient: Whether to go on to perturbed starts and IPOPT where the first solver fails.
        """
        lower, upper = self._constraint_bounds(bounds)
        best: Solution | None = None
        for name, start in self._ladder(starts, patient):
            result = self._solver(name)(
                x0=np.clip(start, bounds.lower, bounds.upper),
                p=parameters,
                lbx=bounds.lower,
                ubx=bounds.upper,
                lbg=lower,
                ubg=upper,
            )
            x = np.asarray(result["x"], float).ravel()
            g = np.asarray(result["g"], float).ravel()
            worst = max(
                np.max(lower - g),
                np.max(g - upper),
                np.max(bounds.lower - x),
                np.max(x - bounds.upper),
            )
            worst = float(worst) if np.all(np.isfinite(x)) and np.isfinite(worst) else np.inf
            found = Solution(x, float(result["f"]), max(0.0, worst), name)
            if best is None or found.violation < best.violation:
                best = found
            if best.solved:
                break
        assert best is not None
        return best

    def _ladder(self, starts: list[Floats], patient: bool) -> Iterator[tuple[str, Floats]]:
        for start in starts:
            yield self._first, start
        if not patient:
            return
        random = np.random.default_rng(0)
        spread = np.array([0.08, 0.08, 0.35, 0.4, 0.3, 0.4, 0.3, 0.03, 0.03])
        for _ in range(3):
            yield self._first, starts[0] + spread * random.standard_normal(9)
        if self._first != "ipopt":
            yield "ipopt", starts[0]

    def _solver(self, name: str) -> Any:
        if name not in self._solvers:
            plugin, options = _OPTIONS[name]
            self._solvers[name] = ca.nlpsol(name, plugin, self.problem.nlp, dict(options))
        return self._solvers[name]

    def _constraint_bounds(self, bounds: Bounds) -> tuple[Floats, Floats]:
        least = {WHEEL: 0.0, HIP: bounds.hip, GROUND: bounds.clearance, SELF: bounds.apart}
        least[EXTRA] = 0.0
        lower = np.array([least[kind] for kind in self.problem.rows])
        upper = np.where(self._kinds == WHEEL, 0.0, np.inf)
        return lower, upper


@lru_cache(maxsize=16)
def pose_solver(
    layout: Layout,
    links: bool,
    cells: int,
    extra: ExtraTerms = NONE,
    first: str = "daqp",
) -> PoseSolver:
    """The process's solver for a collision layout and a number of ground cells: built once.

    Args:
        layout, links, cells, extra: See `nlp.build`.
        first: Tried first: ``daqp`` (an SQP with it, then IPOPT) or ``ipopt``.
    """
    return PoseSolver(layout, links, cells, extra, first)
