"""Solvers of the balance QP (eqs 11-12): min F' H F / 2 + g' F subject to C F <= d.

``native`` is the native core's, written for exactly this QP's 8 unknowns and 16 constraints, so
that the control loop never leaves machine code. The others are qpsolvers' back ends; Clarabel is
the reference that tests compare all of them with.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.errors import StairwrightError


class SolverError(StairwrightError):
    """A QP solver returned no solution (the QP itself always has one)."""


def solve(solver: str, H: Floats, g: Floats, C: Floats, d: Floats, start: Floats) -> Floats:
    """The minimiser F (8,) of one of `Solver`'s names, started at `start` where it can.

    Raises:
        SolverError: If the solver gives up.
    """
    if solver == "native":
        friction = np.array([-C[4 * w, 2 * w + 1] for w in range(4)])
        return _core.balance_forces(H, g, friction, float(d[3]), start)
    import qpsolvers  # imported here: the native loop does not need it
    from scipy.sparse import csc_matrix

    sparse = solver in ("clarabel", "osqp")
    P, G = (csc_matrix(H), csc_matrix(C)) if sparse else (H, C)
    options = _OPTIONS.get(solver, {})
    problem = qpsolvers.Problem(P, g, G, d)
    found = qpsolvers.solve_problem(problem, solver, initvals=None, **options)
    if not found.found or found.x is None or not np.isfinite(found.x).all():
        raise SolverError(f"{solver} found no solution of the balance QP near {start.round(1)}")
    solution: Floats = found.x
    return solution


# First-order and interior-point back ends stop early by default.
_OPTIONS: dict[str, dict[str, Any]] = {
    "clarabel": {"tol_gap_abs": 1e-11, "tol_gap_rel": 1e-11, "tol_feas": 1e-11},
    "osqp": {"eps_abs": 1e-9, "eps_rel": 1e-9, "max_iter": 100_000},
    "proxqp": {"eps_abs": 1e-9, "eps_rel": 0.0},
    "piqp": {"eps_abs": 1e-10, "eps_rel": 1e-11},
    "daqp": {"primal_tol": 1e-9, "dual_tol": 1e-10},
}
