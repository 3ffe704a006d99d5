"""Polish: the body's poses along a fixed wheel path, by banded Gauss-Newton on hinge residuals."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Planar

from .ground import Ground
from .legs import (
    COM_X,
    LEGS,
    LINKS,
    REACH,
    RECORD,
    SLACK,
    TRUNK,
    Leg,
    evaluate,
    legs_gap,
    links_gap,
    posture,
    trunk_gap,
)

Floats = NDArray[np.float64]

TERMS = 13
# Indices of `wish`: target values, then weights of the residuals.
(
    W_MARGIN, W_RESERVE, W_LAG, W_TRUNK, W_LINKS, W_LEGS, W_SLACK, W_REACH,
    H_MARGIN, H_RESERVE, H_LAG, H_CLEAR, H_LEGS, H_SLACK, H_PITCH, H_HEIGHT, HEIGHT,
) = range(17)  # fmt: skip
WISHES = 17


HARD = 600.0  # weight of what must not be violated
_GAIN = 0.01  # cost of a quarter of a millimetre too little: a smaller gain ends the polish


@nb.njit(cache=True)
def _hinge(value: float, wish: float, least: float, weight: float) -> float:
    """Pull towards `wish`, and hard away from less than `least`."""
    return weight * max(0.0, wish - value) + HARD * max(0.0, least - value)


@nb.njit(cache=True)
def _residuals(
    record: Floats, body: Floats, wheels: Floats, spans: Floats, w: Floats, out: Floats
) -> None:
    x = record[COM_X]
    for k in range(3):
        # A narrow interval cannot give the target on both sides: aim at its middle.
        target = min(w[W_MARGIN + k], 0.45 * max(0.0, spans[2 * k + 1] - spans[2 * k]))
        weight = w[H_MARGIN + k]
        below, above = x - spans[2 * k], spans[2 * k + 1] - x
        out[2 * k], out[2 * k + 1] = (
            weight * max(0.0, target - below),
            weight * max(0.0, target - above),
        )
        if k == 0:
            out[0] += HARD * max(0.0, 0.25 * target - below)
            out[1] += HARD * max(0.0, 0.25 * target - above)
    out[6] = _hinge(record[TRUNK], w[W_TRUNK], 0.002, w[H_CLEAR])
    out[7] = _hinge(record[LINKS], w[W_LINKS], 0.004, w[H_CLEAR])
    out[8] = _hinge(record[LEGS], w[W_LEGS], 0.007, w[H_LEGS])
    out[9] = _hinge(record[SLACK], w[W_SLACK], 0.004, w[H_SLACK])
    out[10] = _hinge(record[REACH], w[W_REACH], 0.0005, w[H_CLEAR])
    slope = math.atan2(wheels[1] - wheels[3], wheels[0] - wheels[2])
    out[11] = (body[2] + 0.8 * slope) * w[H_PITCH]
    out[12] = (body[1] - 0.5 * (wheels[1] + wheels[3]) - w[HEIGHT]) * w[H_HEIGHT]


@nb.njit(cache=True)
def _solve_band(a: Floats, b: Floats, width: int) -> None:
    """In-place banded Cholesky solve; a[i, k] = H[i, i - k]. The solution is left in `b`."""
    n = len(b)
    for i in range(n):
        for j in range(max(0, i - width), i + 1):
            v = a[i, i - j]
            for k in range(max(0, i - width), j):
                if j - k <= width:
                    v -= a[i, i - k] * a[j, j - k]
            if i == j:
                a[i, 0] = math.sqrt(max(v, 1e-12))
            else:
                a[i, i - j] = v / a[j, 0]
    for i in range(n):
        v = b[i]
        for k in range(max(0, i - width), i):
            v -= a[i, i - k] * b[k]
        b[i] = v / a[i, 0]
    for i in range(n - 1, -1, -1):
        v = b[i]
        for k in range(i + 1, min(n, i + width + 1)):
            v -= a[k, k - i] * b[k]
        b[i] = v / a[i, 0]


@nb.njit(cache=True, nogil=True)
def _uneven(body: Floats, unit: Floats, slow: float, even: float) -> float:
    """Cost of first and second differences along the nodes."""
    cost = 0.0
    for a in range(3):
        for k in range(1, len(body)):
            e = (body[k, a] - body[k - 1, a]) * unit[a]
            cost += slow * e * e
        for k in range(1, len(body) - 1):
            e = (body[k - 1, a] - 2.0 * body[k, a] + body[k + 1, a]) * unit[a]
            cost += even * e * e
    return cost


@nb.njit(cache=True, nogil=True)
def _smooth_terms(
    body: Floats, unit: Floats, slow: float, even: float, h: Floats, grad: Floats
) -> None:
    """Add the derivatives of `_uneven` to the banded Hessian `h` and the gradient."""
    second = np.array([1.0, -2.0, 1.0])
    for a in range(3):
        q = unit[a]
        for k in range(1, len(body)):
            e = (body[k, a] - body[k - 1, a]) * q
            grad[3 * k + a] += slow * q * e
            grad[3 * (k - 1) + a] -= slow * q * e
            h[3 * k + a, 0] += slow * q * q
            h[3 * (k - 1) + a, 0] += slow * q * q
            h[3 * k + a, 3] -= slow * q * q
        for k in range(1, len(body) - 1):
            e = (body[k - 1, a] - 2.0 * body[k, a] + body[k + 1, a]) * q
            for u in range(3):
                grad[3 * (k - 1 + u) + a] += even * q * e * second[u]
                for v in range(u + 1):
                    h[3 * (k - 1 + u) + a, 3 * (u - v)] += even * q * q * second[u] * second[v]


@nb.njit(cache=True, nogil=True)
def polish(
    g: Ground,
    p: Planar,
    front: Leg,
    rear: Leg,
    body: Floats,
    wheels: Floats,
    spans: Floats,
    wish: Floats,
    slow: float,
    even: float,
    turn: float,
    fixed: NDArray[np.bool_],
    rounds: int,
) -> float:
    """Levenberg-Marquardt on trunk poses `body` (n, 3), changed in place; returns the cost left.

    Args:
        g, p, front, rear: Terrain and robot.
        body: Trunk x, z, pitch per node.
        wheels: (n, 4) wheel centres.
        spans: (n, 6) CoM intervals: at friction, at the reserve, with lag.
        wish: (WISHES,) targets and weights.
        slow, even: Weights of first and second differences along the nodes.
        turn: Length that one radian counts as in those differences [m].
        fixed: (n,) nodes that must not move.
        rounds: Most iterations.
    """
    n = len(body)
    look = max(wish[W_TRUNK], wish[W_LINKS])  # nothing farther away pulls
    unit = np.array([1.0, 1.0, turn])
    records, record, points = np.empty((n, RECORD)), np.empty(RECORD), np.empty((2, 3, 2))
    r, rp, jac = np.empty((n, TERMS)), np.empty(TERMS), np.empty((TERMS, 3))
    h, grad = np.zeros((3 * n, 7)), np.zeros(3 * n)
    kept_h, kept_grad, best = h.copy(), grad.copy(), body.copy()
    damping, least = 1e-3, np.inf
    x = np.empty(3)
    for _ in range(rounds):
        cost = _uneven(body, unit, slow, even)
        for k in range(n):
            evaluate(g, p, front, rear, body[k], wheels[k], look, points, records[k])
            _residuals(records[k], body[k], wheels[k], spans[k], wish, r[k])
            for m in range(TERMS):
                cost += r[k, m] * r[k, m]
            if cost >= least * (1.0 - 1e-12):
                break
        if cost < least * (1.0 - 1e-12):
            # One bad place counts little in a long course: ask for more where there are more nodes.
            settled = least - cost < max(_GAIN, 2e-3 * min(1.0, 20.0 / n) * least)
            least = cost
            best[:] = body
            damping = max(damping * 0.4, 1e-6)
            if settled:
                break
            kept_h[:] = 0.0
            kept_grad[:] = 0.0
            for k in range(n):
                if fixed[k]:
                    continue
                for v in range(3):
                    x[:] = body[k]
                    x[v] += 1e-5
                    record[:] = records[k]
                    posture(p, front, rear, x, wheels[k], points, record)
                    # What is far enough from everything stays so; most of the time goes here.
                    if r[k, 6] > 0.0:
                        record[TRUNK] = trunk_gap(g, p, x, look)
                    if r[k, 7] > 0.0:
                        record[LINKS] = links_gap(g, p, points, look)
                    if r[k, 8] > 0.0:
                        record[LEGS] = legs_gap(p, points)
                    _residuals(record, x, wheels[k], spans[k], wish, rp)
                    for m in range(TERMS):
                        jac[m, v] = (rp[m] - r[k, m]) * 1e5
                for a in range(3):
                    for m in range(TERMS):
                        kept_grad[3 * k + a] += jac[m, a] * r[k, m]
                    for b in range(a + 1):
                        for m in range(TERMS):
                            kept_h[3 * k + a, a - b] += jac[m, a] * jac[m, b]
            _smooth_terms(body, unit, slow, even, kept_h, kept_grad)
        else:
            damping *= 6.0
        if damping > 1e4:
            break
        h[:] = kept_h
        grad[:] = kept_grad
        for k in range(n):
            for a in range(3):
                i = 3 * k + a
                h[i, 0] += damping * (1.0 + h[i, 0])
                if fixed[k]:
                    h[i, 0] += 1e12
        _solve_band(h, grad, 6)
        for k in range(n):
            for a in range(3):
                body[k, a] = best[k, a] - min(0.05, max(-0.05, grad[3 * k + a]))
    body[:] = best
    return least
