"""What uneven motion along the nodes of a path costs, and the banded systems that come of it."""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

Floats = NDArray[np.float64]

BAND = 6  # second differences tie an unknown to those of two nodes further


@leaf
def solve_band(a: Floats, b: Floats) -> None:
    """Solve H x = b in place for a banded H, a[i, k] = H[i, i + k]; `b` becomes x.

    Both have `BAND` more rows than there are unknowns.
    """
    n = len(b) - BAND
    for i in range(n):
        a[i, 0] = 1.0 / max(a[i, 0], 1e-12)
        for u in range(1, BAND + 1):
            share = a[i, u] * a[i, 0]
            b[i + u] -= share * b[i]
            for v in range(u, BAND + 1):
                a[i + u, v - u] -= share * a[i, v]
    b[n:] = 0.0
    for i in range(n - 1, -1, -1):
        v = b[i]
        for u in range(1, BAND + 1):
            v -= a[i, u] * b[i + u]
        b[i] = v * a[i, 0]


@leaf
def unevenness(body: Floats, unit: Floats, slow: float, even: float, grad: Floats) -> float:
    """Cost of first and second differences along the nodes; `grad` becomes half its gradient."""
    cost = 0.0
    grad[:] = 0.0
    for a in range(3):
        q = unit[a]
        for k in range(1, len(body)):
            e = (body[k, a] - body[k - 1, a]) * q
            cost += slow * e * e
            grad[3 * k + a] += slow * q * e
            grad[3 * (k - 1) + a] -= slow * q * e
        for k in range(1, len(body) - 1):
            e = (body[k - 1, a] - 2.0 * body[k, a] + body[k + 1, a]) * q
            cost += even * e * e
            grad[3 * (k - 1) + a] += even * q * e
            grad[3 * k + a] -= 2.0 * even * q * e
            grad[3 * (k + 1) + a] += even * q * e
    return cost


@nb.njit(cache=True)
def stiffness(n: int, unit: Floats, slow: float, even: float) -> Floats:
    """Half the second derivatives of `unevenness` for `n` nodes, as `solve_band` takes them."""
    h = np.zeros((3 * n + BAND, BAND + 1))
    second = np.array([1.0, -2.0, 1.0])
    for a in range(3):
        first, bend = slow * unit[a] ** 2, even * unit[a] ** 2
        for k in range(1, n):
            h[3 * (k - 1) + a, 0] += first
            h[3 * k + a, 0] += first
            h[3 * (k - 1) + a, 3] -= first
        for k in range(1, n - 1):
            for u in range(3):
                for v in range(u, 3):
                    h[3 * (k - 1 + u) + a, 3 * (v - u)] += bend * second[u] * second[v]
    return h
