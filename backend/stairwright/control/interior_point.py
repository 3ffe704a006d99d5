"""Interior point of the balance QP, compiled: 8 unknowns, 16 constraints; and a Cholesky factor."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

Floats = NDArray[np.float64]

_ITERATIONS = 40
TOLERANCE = 1e-9  # of stationarity and complementarity, relative to the gradient


@nb.njit(cache=True)
def slacks(x: Floats, mu: Floats, limit: float, out: Floats) -> None:
    """D - C x, per wheel: forward and backward friction, pushing, saturation."""
    for w in range(4):
        t, n = x[2 * w], x[2 * w + 1]
        out[4 * w] = mu[w] * n - t
        out[4 * w + 1] = mu[w] * n + t
        out[4 * w + 2] = n
        out[4 * w + 3] = limit - n


@leaf
def pulled(z: Floats, mu: Floats, w: int) -> tuple[float, float]:
    """Entries of C' z that belong to wheel `w`: tangential and normal."""
    a, b, c, d = z[4 * w], z[4 * w + 1], z[4 * w + 2], z[4 * w + 3]
    return a - b, d - c - mu[w] * (a + b)


@nb.njit(cache=True)
def interior_point(H: Floats, g: Floats, mu: Floats, limit: float, x: Floats) -> int:
    """Minimise into `x` (8,) by Mehrotra's predictor-corrector; returns the iterations taken.

    A feasible start is known (no traction, half the load limit), and steps keep it feasible, so
    that only stationarity and complementarity have to converge.
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
    slacks(x, mu, limit, s)
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
            pt, pn = pulled(z, mu, w)
            rd[2 * w] += pt
            rd[2 * w + 1] += pn
        for i in range(n):
            worst = max(worst, abs(rd[i]))
        if worst < TOLERANCE * scale and gap < TOLERANCE * scale:
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
                pt, pn = pulled(pull, mu, w)
                rhs[2 * w] = -rd[2 * w] - pt
                rhs[2 * w + 1] = -rd[2 * w + 1] - pn
            solve_factored(K, rhs, 8)
            slacks(rhs, mu, 0.0, ds)
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
        slacks(x, mu, limit, s)
        for i in range(m):
            s[i] = max(s[i], 1e-10)
            z[i] = max(z[i], 1e-10)
    return _ITERATIONS


@leaf
def _factor(H: Floats, s: Floats, z: Floats, mu: Floats, K: Floats) -> None:
    """Cholesky factor (lower) of H + C' diag(z / s) C; C couples only a wheel's two forces."""
    for i in range(8):
        for j in range(i + 1):
            K[i, j] = H[i, j]
    for w in range(4):
        a, b = z[4 * w] / s[4 * w], z[4 * w + 1] / s[4 * w + 1]
        c, d = z[4 * w + 2] / s[4 * w + 2], z[4 * w + 3] / s[4 * w + 3]
        K[2 * w, 2 * w] += a + b
        K[2 * w + 1, 2 * w] += mu[w] * (b - a)
        K[2 * w + 1, 2 * w + 1] += mu[w] * mu[w] * (a + b) + c + d
    cholesky(K, 8)


@leaf
def cholesky(K: Floats, n: int) -> None:
    """Replace the lower triangle of `K` by its factor."""
    for i in range(n):
        for j in range(i + 1):
            v = K[i, j]
            for k in range(j):
                v -= K[i, k] * K[j, k]
            if i == j:
                K[i, i] = math.sqrt(max(v, 1e-300))
            else:
                K[i, j] = v / K[j, j]


@leaf
def solve_factored(K: Floats, b: Floats, n: int) -> None:
    """Solve K K' x = b in place."""
    for i in range(n):
        v = b[i]
        for k in range(i):
            v -= K[i, k] * b[k]
        b[i] = v / K[i, i]
    for i in range(n - 1, -1, -1):
        v = b[i]
        for k in range(i + 1, n):
            v -= K[k, i] * b[k]
        b[i] = v / K[i, i]
