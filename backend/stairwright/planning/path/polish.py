"""Polish: the body's poses along a fixed wheel path, by banded Gauss-Newton on hinge residuals."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.robot.description import Planar

from .evenness import BAND, solve_band, stiffness, unevenness
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
    joints,
    legs_gap,
    links_gap,
    posture,
    trunk_gap,
)

Floats = NDArray[np.float64]

TERMS, HINGES = 13, 11  # residuals of a node; the first of them are never negative
# Indices of `wish`: target values, then weights of the residuals.
(
    W_MARGIN, W_RESERVE, W_LAG, W_TRUNK, W_LINKS, W_LEGS, W_SLACK, W_REACH,
    H_MARGIN, H_RESERVE, H_LAG, H_CLEAR, H_LEGS, H_SLACK, H_PITCH, H_HEIGHT, HEIGHT,
) = range(17)  # fmt: skip
WISHES = 17


HARD = 600.0  # weight of what must not be violated
_STEP = 1e-5  # m and rad; of finite differences
_LINEAR = 1e-4  # m and rad; a node that has moved by less is extrapolated
_FIXED = 1e12  # stiffness that no node moves against
_GAIN = 0.01  # cost of a quarter of a millimetre too little: a smaller gain ends the polish


@nb.njit(cache=True)
def _hinge(value: float, wish: float, least: float, weight: float) -> float:
    """Pull towards `wish`, and hard away from less than `least`."""
    return weight * max(0.0, wish - value) + HARD * max(0.0, least - value)


@leaf
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
def _differentiate(
    g: Ground,
    p: Planar,
    front: Leg,
    rear: Leg,
    which: NDArray[np.bool_],
    body: Floats,
    wheels: Floats,
    spans: Floats,
    w: Floats,
    look: float,
    records: Floats,
    r: Floats,
    jac: Floats,
    own: Floats,
) -> None:
    """Fill derivatives `jac` (n, 3, TERMS) of residuals `r` of some nodes, and their part of H."""
    x, record, points, moved = np.empty(3), np.empty(RECORD), np.empty((2, 3, 2)), np.empty(TERMS)
    for k in np.flatnonzero(which):
        x[:], record[:] = body[k], records[k]
        for a in range(3):
            x[a] = body[k, a] + _STEP
            posture(p, front, rear, x, wheels[k], points, record)
            # What is far enough from its limits stays so; most of the time goes here.
            if r[k, 9] > 0.0:
                joints(p, front, rear, x[2], points, record)
            if r[k, 6] > 0.0:
                record[TRUNK] = trunk_gap(g, p, x, look)
            if r[k, 7] > 0.0:
                record[LINKS] = links_gap(g, p, points, look)
            if r[k, 8] > 0.0:
                record[LEGS] = legs_gap(p, points)
            _residuals(record, x, wheels[k], spans[k], w, moved)
            for m in range(TERMS):
                jac[k, a, m] = (moved[m] - r[k, m]) * (1.0 / _STEP)
            x[a] = body[k, a]
        for a in range(3):
            for b in range(a, 3):
                total = 0.0
                for m in range(TERMS):
                    total += jac[k, a, m] * jac[k, b, m]
                own[k, a, b - a] = total


@leaf
def _extrapolate(base: Floats, jac: Floats, body: Floats, seen: Floats, r: Floats) -> None:
    """Residuals `r` of a node near to where it was looked at (`seen`: there, `base`)."""
    x, z, pitch = body[0] - seen[0], body[1] - seen[1], body[2] - seen[2]
    for m in range(TERMS):
        r[m] = base[m] + jac[0, m] * x + jac[1, m] * z + jac[2, m] * pitch
    for m in range(HINGES):
        r[m] = max(0.0, r[m])


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

    A node that has hardly moved since it was looked at is not looked at again: its residuals are
    extrapolated. In most rounds few nodes move.

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
    even_h = stiffness(n, unit, slow, even)
    # Of each node: its record, its residuals, and what it was like when it was last looked at.
    records, r, points = np.empty((n, RECORD)), np.empty((n, TERMS)), np.empty((2, 3, 2))
    fresh, seen, base = np.empty(n, np.bool_), np.full((n, 3), np.inf), np.empty((n, TERMS))
    jac, own = np.zeros((n, 3, TERMS)), np.zeros((n, 3, 3))
    h, step, uneven = even_h.copy(), np.zeros(3 * n + BAND), np.zeros(3 * n)
    best, kept_h, grad = body.copy(), even_h.copy(), np.zeros(3 * n)
    damping, least = 1e-3, np.inf
    for _ in range(rounds):
        cost = unevenness(body, unit, slow, even, uneven)
        for k in range(n):
            moved = max(abs(body[k, 0] - seen[k, 0]), abs(body[k, 1] - seen[k, 1]))
            fresh[k] = max(moved, abs(body[k, 2] - seen[k, 2])) > _LINEAR
            if fresh[k]:
                evaluate(g, p, front, rear, body[k], wheels[k], look, points, records[k])
                _residuals(records[k], body[k], wheels[k], spans[k], wish, r[k])
            else:
                _extrapolate(base[k], jac[k], body[k], seen[k], r[k])
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
            _differentiate(
                g, p, front, rear, fresh & ~fixed, body, wheels, spans, wish, look, records, r,
                jac, own,
            )  # fmt: skip
            kept_h[:] = even_h
            grad[:] = uneven
            for k in range(n):
                if fresh[k]:
                    seen[k], base[k] = body[k], r[k]
                if fixed[k]:
                    kept_h[3 * k : 3 * k + 3, 0] += _FIXED
                for a in range(3):
                    for b in range(3 - a):
                        kept_h[3 * k + a, b] += own[k, a, b]
                    for m in range(TERMS):
                        grad[3 * k + a] += jac[k, a, m] * r[k, m]
        else:
            damping *= 6.0
        if damping > 1e4:
            break
        h[:] = kept_h
        step[: 3 * n] = grad
        h[: 3 * n, 0] += damping * (1.0 + h[: 3 * n, 0])
        solve_band(h, step)
        for k in range(n):
            for a in range(3):
                body[k, a] = best[k, a] - min(0.05, max(-0.05, step[3 * k + a]))
    body[:] = best
    return least
