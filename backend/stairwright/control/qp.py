"""Solvers of the balance QP (eqs 11-12): min F' H F / 2 + g' F subject to C F <= d.

``native`` is written for exactly this QP's 8 unknowns and 16 constraints and compiled, so that the
control loop never leaves machine code: a guess of the active faces, started at the last solution's,
is solved exactly and checked (nearly always right); else an interior point finds the faces. The
others are qpsolvers' back ends; Clarabel is the reference that tests compare all of them with.
"""

from __future__ import annotations

import math
from typing import Any

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.errors import StairwrightError

from .interior_point import cholesky, interior_point, solve_factored

Floats = NDArray[np.float64]

_GUESSES = 6  # active sets that are tried before the interior point
_FACE = 1e-9  # of the load limit: this near a face counts as on it
# What holds a wheel's force: nothing, a friction edge, no load, full load, full load and an edge.
_FREE, _FORWARD, _BACKWARD, _ZERO, _FULL, _FULL_FORWARD, _FULL_BACKWARD = range(7)


class SolverError(StairwrightError):
    """A QP solver returned no solution (the QP itself always has one)."""


def solve(solver: str, H: Floats, g: Floats, C: Floats, d: Floats, start: Floats) -> Floats:
    """The minimiser F (8,) of one of `Solver`'s names, started at `start` where it can.

    Raises:
        SolverError: If the solver gives up.
    """
    if solver == "native":
        force = start.copy()
        friction = np.array([-C[4 * w, 2 * w + 1] for w in range(4)])
        solve_native(H, g, friction, float(d[3]), force)
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
def solve_native(H: Floats, g: Floats, mu: Floats, limit: float, x: Floats) -> int:
    """Minimise into `x` (8,), which holds a guess; returns the interior point's iterations or 0.

    `mu` (4,) is the friction that each wheel may use, `limit` the largest normal force.
    """
    faces = np.empty(4, np.int64)
    work = np.empty(8)
    tolerance = _FACE * limit
    _faces_of(x, mu, limit, tolerance, faces)
    for _ in range(_GUESSES):
        if _on_faces(H, g, mu, limit, faces, work) and _next_faces(H, g, mu, limit, faces, work):
            x[:] = work
            return 0
    iterations = interior_point(H, g, mu, limit, x)
    # Sharpen: solve exactly on the faces that the interior point has come close to.
    for near in (1e-7, 1e-5):
        _faces_of(x, mu, limit, near * limit, faces)
        for _ in range(_GUESSES):
            if not _on_faces(H, g, mu, limit, faces, work):
                break
            if _next_faces(H, g, mu, limit, faces, work):
                x[:] = work
                return iterations
    return iterations


@leaf
def _faces_of(x: Floats, mu: Floats, limit: float, near: float, faces: NDArray[np.int64]) -> None:
    """The faces on which the wheels' forces lie."""
    for w in range(4):
        t, n = x[2 * w], x[2 * w + 1]
        face = _FREE
        if n <= near:
            face = _ZERO
        else:
            if t >= mu[w] * n - near:
                face = _FORWARD
            elif t <= near - mu[w] * n:
                face = _BACKWARD
            if n >= limit - near:
                face += _FULL
        faces[w] = face


@nb.njit(cache=True)
def _on_faces(
    H: Floats, g: Floats, mu: Floats, limit: float, faces: NDArray[np.int64], x: Floats
) -> bool:
    """The exact minimiser on the given faces, into `x`; False if the numbers break down."""
    Z = np.zeros((8, 8))
    m = 0
    for w in range(4):
        face = faces[w]
        t, n = 2 * w, 2 * w + 1
        x[t] = x[n] = 0.0
        if face == _FREE:
            Z[t, m] = Z[n, m + 1] = 1.0
            m += 2
        elif face in (_FORWARD, _BACKWARD):
            Z[t, m] = mu[w] if face == _FORWARD else -mu[w]
            Z[n, m] = 1.0
            m += 1
        elif face == _FULL:
            Z[t, m] = 1.0
            x[n] = limit
            m += 1
        elif face != _ZERO:
            x[n] = limit
            x[t] = mu[w] * limit if face == _FULL_FORWARD else -mu[w] * limit
    if m == 0:
        return True
    gradient, HZ = np.empty(8), np.zeros((8, 8))
    for i in range(8):
        r = g[i]
        for j in range(8):
            r += H[i, j] * x[j]
        gradient[i] = r
        for a in range(m):
            v = 0.0
            for j in range(8):
                v += H[i, j] * Z[j, a]
            HZ[i, a] = v
    K, rhs = np.empty((8, 8)), np.empty(8)
    for a in range(m):
        v = 0.0
        for i in range(8):
            v -= Z[i, a] * gradient[i]
        rhs[a] = v
        for b in range(a + 1):
            v = 0.0
            for i in range(8):
                v += Z[i, a] * HZ[i, b]
            K[a, b] = v
    cholesky(K, m)
    solve_factored(K, rhs, m)
    for i in range(8):
        for a in range(m):
            x[i] += Z[i, a] * rhs[a]
        if not math.isfinite(x[i]):
            return False
    return True


@leaf
def _next_faces(
    H: Floats, g: Floats, mu: Floats, limit: float, faces: NDArray[np.int64], x: Floats
) -> bool:
    """True if `x` is the optimum; else the faces to try next.

    A force beyond a face goes onto it; a face whose multiplier pulls the wrong way is left.
    """
    optimal = True
    scale = 1.0
    for i in range(8):
        scale = max(scale, abs(g[i]))
    slack, pull = _FACE * limit, 1e-10 * scale
    for w in range(4):
        t, n, face = x[2 * w], x[2 * w + 1], faces[w]
        gt, gn = g[2 * w], g[2 * w + 1]
        for j in range(8):
            gt += H[2 * w, j] * x[j]
            gn += H[2 * w + 1, j] * x[j]
        new = face
        if face == _ZERO:
            if gn < mu[w] * abs(gt) - pull:
                new = _BACKWARD if gt > 0.0 else _FORWARD
                if abs(gt) < abs(gn) * mu[w]:
                    new = _FREE
        elif n < -slack:
            new = _ZERO
        else:
            forward = face in (_FORWARD, _FULL_FORWARD)
            backward = face in (_BACKWARD, _FULL_BACKWARD)
            full = face >= _FULL
            edge = -gt if forward else gt  # the multiplier of the friction edge, if on one
            if (forward or backward) and full:
                if edge < -pull:
                    forward = backward = False
                elif mu[w] * edge - gn < -pull:
                    full = False
            elif forward or backward:
                if edge < -pull:
                    forward = backward = False
            elif full and gn > pull:
                full = False
            if not (forward or backward):
                forward, backward = t > mu[w] * n + slack, -t > mu[w] * n + slack
            full = full or n > limit + slack
            new = _FORWARD if forward else (_BACKWARD if backward else _FREE)
            if full:
                new += _FULL
        if new != face:
            faces[w] = new
            optimal = False
    return optimal
