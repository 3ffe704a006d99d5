"""From lattice poses to the final nodes: resampling, smoothing, polish, dense nodes, records."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

from . import polish as po
from .contacts import path_intervals
from .course import Stand, scale, stand_height
from .densify import contact_changes, densify
from .ground import Ground
from .lattice import LAG
from .legs import Leg
from .record import Record, evaluate_path

Floats = NDArray[np.float64]

_CLEAR = 0.016  # m; clearance that the polish aims at
# Of one attempt after the other: smoothing, metres of path per node, and how much the trunk moving
# counts as path against the wheels' travel.
_TRIES = ((1.0, 0.009, 0.3), (0.5, 0.006, 0.6), (0.15, 0.006, 0.6))
_LOST = -0.004  # m; a second attempt that breaks a bound by more is not mended by a third


@dataclass(frozen=True)
class Refined:
    """Final nodes: arc lengths (n, 2), trunk poses (n, 3), and what they are worth."""

    s: Floats
    body: Floats
    record: Record

    def until(self, count: int) -> Refined:
        """The first `count` nodes."""
        return Refined(self.s[:count], self.body[:count], self.record.until(count))


def refine(
    path: WheelPath,
    ground: Ground,
    robot: Robot,
    legs: tuple[Leg, Leg],
    stands: tuple[Stand, Stand],
    s: Floats,
    body: Floats,
    friction: float,
    reserve: float,
    weights: PathWeights,
) -> Iterator[Refined]:
    """Turn lattice poses into dense, smooth ones: one attempt after the other, the smoothest first.

    Args:
        path, ground, robot, legs: The terrain and the robot.
        stands: Where the path begins and ends.
        s: (n, 2) arc lengths of front and rear wheel [m].
        body: (n, 3) trunk poses.
        friction: Coulomb friction.
        reserve: Lower friction that is kept where the terrain allows it.
        weights: What to trade off.
    """
    body = body.copy()
    for k in range(2):
        body[-k] = stands[k].body
    p, size = robot.planar, scale(robot)
    for tries, (soft, spacing, swing) in enumerate(_TRIES):
        u = _spacing(s, body, swing)
        n = max(40, int(u[-1] / (spacing * size)))
        even = np.linspace(0.0, u[-1], n)
        hop = even[1]
        nodes_s = np.stack([np.interp(even, u, s[:, k]) for k in range(2)], axis=1)
        nodes_body = np.stack([np.interp(even, u, body[:, k]) for k in range(3)], axis=1)
        nodes_s = _smooth(nodes_s, soft * 0.01 * size / hop)
        nodes_body = _smooth(nodes_body, soft * 0.05 * size / hop)
        if (np.diff(s, axis=0) >= 0).all():
            nodes_s = np.maximum.accumulate(nodes_s, axis=0)
        for k in range(2):
            nodes_s[-k], nodes_body[-k] = stands[k].wheels, stands[k].body
        nodes_body = np.ascontiguousarray(nodes_body)
        changes = contact_changes(path.pieces, path.corners, nodes_s)
        spans = _intervals(path, nodes_s, changes, friction, reserve)
        wheels = np.concatenate([path.centres(nodes_s[:, k]) for k in range(2)], axis=1)
        fixed = np.zeros(n, np.bool_)
        fixed[0] = fixed[-1] = True
        share = hop / 0.015
        po.polish(
            ground, p, *legs, nodes_body, wheels, spans, _wishes(robot, weights, share),
            20.0 * weights.smoothness / share, 600.0 * soft * weights.smoothness / share**3,
            0.25 * size, fixed, 40,
        )  # fmt: skip
        dense_s, dense_body = densify(path.pieces, p, legs, nodes_s, nodes_body, changes)
        record = evaluate_path(path, ground, robot, legs, dense_s, dense_body, friction)
        yield Refined(dense_s, dense_body, record)
        if tries > 0 and record.worst < _LOST:
            break


def best_of(attempts: Iterable[Refined]) -> Refined:
    """The first that keeps all bounds, else the one that breaks them least."""
    found: list[Refined] = []
    for attempt in attempts:
        if attempt.record.good:
            return attempt
        found.append(attempt)
    return max(found, key=lambda one: one.record.worst)


def _intervals(
    path: WheelPath, s: Floats, changes: Floats, friction: float, reserve: float
) -> Floats:
    """CoM intervals (n, 6) of nodes, see `path_intervals`, each also good to the next ones.

    Where contacts change between two nodes both keep what holds there: the CoM moves linearly.
    """
    n = len(s)
    between = np.stack([np.interp(changes, np.arange(n), s[:, k]) for k in range(2)], axis=1)
    spans = np.empty((n + len(changes), 6))
    path_intervals(
        path.pieces, path.corners, path.radius, np.concatenate([s, between]), friction, reserve,
        LAG, spans,
    )  # fmt: skip
    nodes, there = spans[:n], spans[n:]
    for k in (np.floor(changes).astype(int), np.ceil(changes).astype(int)):
        np.maximum.at(nodes[:, ::2], k, there[:, ::2])
        np.minimum.at(nodes[:, 1::2], k, there[:, 1::2])
    return nodes


def _spacing(s: Floats, body: Floats, swing: float) -> Floats:
    """Path parameter (n,) of lattice poses: wheel travel and `swing` times the trunk's."""
    rolled = 0.5 * np.abs(np.diff(s, axis=0)).sum(axis=1)
    moved = np.hypot(np.diff(body[:, 0]), np.diff(body[:, 1])) + 0.25 * np.abs(np.diff(body[:, 2]))
    return np.concatenate([[0.0], np.cumsum(np.hypot(rolled, swing * moved) + 1e-9)])


def _smooth(a: Floats, sigma: float) -> Floats:
    """Gaussian smoothing along axis 0 with point-mirrored ends, which stay in place."""
    if sigma < 0.3:
        return a
    k = min(int(4 * sigma) + 1, len(a) - 1)
    before, after = 2 * a[0] - a[k:0:-1], 2 * a[-1] - a[-2 : -k - 2 : -1]
    w = np.exp(-0.5 * (np.arange(-k, k + 1) / sigma) ** 2)
    w /= w.sum()
    padded = np.vstack([before, a, after])
    return np.stack([np.convolve(padded[:, i], w, "valid") for i in range(a.shape[1])], axis=1)


def _wishes(robot: Robot, weights: PathWeights, share: float) -> Floats:
    """Targets and weights of the polish; `share` scales weights with the nodes' spacing."""
    size = scale(robot)
    wish = np.zeros(po.WISHES)
    wish[po.W_MARGIN], wish[po.W_RESERVE], wish[po.W_LAG] = 0.02, 0.02 * size, 0.06 * size
    wish[po.W_TRUNK] = wish[po.W_LINKS] = _CLEAR
    wish[po.W_LEGS], wish[po.W_SLACK], wish[po.W_REACH] = 0.011, 0.05, 0.006 * size
    root = share**0.5
    wish[po.H_MARGIN] = 100.0 * root
    wish[po.H_RESERVE] = 50.0 * root * weights.com_margin**0.5
    wish[po.H_LAG] = 15.0 * root * weights.com_margin**0.5
    wish[po.H_CLEAR] = 150.0 * root * weights.clearance**0.5
    wish[po.H_LEGS] = 150.0 * root
    wish[po.H_SLACK] = 30.0 * root
    wish[po.H_PITCH] = 0.05 * root * weights.pitch**0.5
    wish[po.H_HEIGHT] = 0.3 * root
    wish[po.HEIGHT] = stand_height(robot)
    return wish
