"""Solvers of the balance QP (eqs 13-14): min F' H F / 2 + g' F subject to C F <= d.

``native`` is a dense primal-dual interior point for exactly this QP's 8 unknowns and 16
constraints, compiled so that the control loop never leaves machine code. The others are qpsolvers'
back ends; Clarabel is the reference that tests compare all of them with.
"""

from __future__ import annotations

import math
from typing import Any

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.errors import StairwrightError

Floats = NDArray[np.float64]

UNKNOWNS, WHEELS, ROWS = 8, 4, 16
_ITERATIONS = 40
_TOLERANCE = 1e-12  # of stationarity and complementarity, relative to the gradient


class SolverError(StairwrightError):
    """A QP solver returned no solution (the QP itself always has one)."""


def solve(solver: str, H: Floats, g: Floats, C: Floats, d: Floats, start: Floats) -> Floats:
    """The minimiser F (8,) of one of `Solver`'s names, started at `start` where it can.

    Raises:
        SolverError: If the solver gives up.
    """
    if solver == "native":
        force = np.empty(UNKNOWNS)
        mu, limit = -C[0, 1], d[3]
        solve_native(H, g, mu, limit, force)
        return force
    import qpsolvers  # imported here: the compiled loop does not need it
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


@nb.njit(cache=True)
def _slacks(x: Floats, mu: float, limit: float, out: Floats) -> None:
    """D - C x, per wheel: forward and backward friction, pushing, saturation."""
    for w in range(4):
        t, n = x[2 * w], x[2 * w + 1]
        out[4 * w] = mu * n - t
        out[4 * w + 1] = mu * n + t
        out[4 * w + 2] = n
        out[4 * w + 3] = limit - n


@nb.njit(cache=True)
def _pulled(z: Floats, mu: float, w: int) -> tuple[float, float]:
    """Entries of C' z that belong to wheel `w`: tangential and normal."""
    a, b, c, d = z[4 * w], z[4 * w + 1], z[4 * w + 2], z[4 * w + 3]
    return a - b, d - c - mu * (a + b)


@nb.njit(cache=True)
def solve_native(H: Floats, g: Floats, mu: float, limit: float, x: Floats) -> int:
    """Minimise into `x` (8,); returns the number of iterations (40: gave up, x is feasible).

    A feasible start is known (no traction, half the load limit), and steps keep it feasible, so
    that only stationarity and complementarity have to converge (Mehrotra's predictor-corrector).
    """
    n, m = 8, 16
    s, z = np.empty(m), np.empty(m)
    ds, dz, pull = np.empty(m), np.empty(m), np.empty(m)
    K, rhs, rd = np.empty((n, n)), np.empty(n), np.empty(n)
    scale = 1.0
    for i in range(n):
        scale = max(scale, abs(g[i]))
    for w in range(4):
        x[2 * w], x[2 * w + 1] = 0.0, 0.25 * limit
    _slacks(x, mu, limit, s)
    level = 0.1 * scale
    for i in range(m):
        z[i] = level
    for iteration in range(_ITERATIONS):
        gap = 0.0
        for i in range(m):
            gap += s[i] * z[i]
        gap /= m
        worst = 0.0
        for i in range(n):
            r = g[i]
            for j in range(n):
                r += H[i, j] * x[j]
            rd[i] = r
        for w in range(4):
            pt, pn = _pulled(z, mu, w)
            rd[2 * w] += pt
            rd[2 * w + 1] += pn
        for i in range(n):
            worst = max(worst, abs(rd[i]))
        if worst < _TOLERANCE * scale and gap < _TOLERANCE * scale:
            return iteration
        _factor(H, s, z, mu, K)
        aim = 0.0
        for phase in range(2):
            # H dx + C' dz = -rd,  ds = -C dx,  s dz + z ds = aim - s z (- ds dz of the predictor)
            for i in range(m):
                c = aim - s[i] * z[i]
                if phase == 1:
                    c -= ds[i] * dz[i]
                pull[i] = c / s[i]
            for w in range(4):
                pt, pn = _pulled(pull, mu, w)
                rhs[2 * w] = -rd[2 * w] - pt
                rhs[2 * w + 1] = -rd[2 * w + 1] - pn
            _solve_factored(K, rhs)
            _slacks(rhs, mu, 0.0, ds)
            step_s, step_z = 1.0, 1.0
            for i in range(m):
                dz[i] = pull[i] - z[i] / s[i] * ds[i]
                if ds[i] < 0.0:
                    step_s = min(step_s, -s[i] / ds[i])
                if dz[i] < 0.0:
                    step_z = min(step_z, -z[i] / dz[i])
            if phase == 0:
                reached = 0.0
                for i in range(m):
                    reached += (s[i] + step_s * ds[i]) * (z[i] + step_z * dz[i])
                aim = gap * (reached / m / gap) ** 3
        step = 0.995 * min(step_s, step_z)
        for i in range(n):
            x[i] += step * rhs[i]
        for i in range(m):
            z[i] += step * dz[i]
        _slacks(x, mu, limit, s)
        for i in range(m):
            s[i] = max(s[i], 1e-13)
    return _ITERATIONS


@nb.njit(cache=True)
def _factor(H: Floats, s: Floats, z: Floats, mu: float, K: Floats) -> None:
    """Cholesky factor (lower) of H + C' diag(z / s) C; C couples only a wheel's two forces."""
    for i in range(8):
        for j in range(i + 1):
            K[i, j] = H[i, j]
    for w in range(4):
        a, b = z[4 * w] / s[4 * w], z[4 * w + 1] / s[4 * w + 1]
        c, d = z[4 * w + 2] / s[4 * w + 2], z[4 * w + 3] / s[4 * w + 3]
        K[2 * w, 2 * w] += a + b
        K[2 * w + 1, 2 * w] += mu * (b - a)
        K[2 * w + 1, 2 * w + 1] += mu * mu * (a + b) + c + d
    for i in range(8):
        for j in range(i + 1):
            v = K[i, j]
            for k in range(j):
                v -= K[i, k] * K[j, k]
            if i == j:
                K[i, i] = math.sqrt(max(v, 1e-300))
            else:
                K[i, j] = v / K[j, j]


@nb.njit(cache=True)
def _solve_factored(K: Floats, b: Floats) -> None:
    """Solve K K' x = b in place."""
    for i in range(8):
        v = b[i]
        for k in range(i):
            v -= K[i, k] * b[k]
        b[i] = v / K[i, i]
    for i in range(7, -1, -1):
        v = b[i]
        for k in range(i + 1, 8):
            v -= K[k, i] * b[k]
        b[i] = v / K[i, i]
