"""From lattice poses to nodes of a path: resampling, smoothing, polish, dense nodes, records."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stairwright.planning.threads import still_wanted
from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

from . import polish as po
from .contacts import path_intervals
from .course import Stand, rolled, scale, stand_height
from .densify import contact_changes, densify
from .lattice import LAG
from .question import Question
from .record import Record, evaluate_path, joined

Floats = NDArray[np.float64]

_CLEAR = 0.016  # m; clearance that the polish aims at
_LEAST = 40  # nodes that are polished


@dataclass(frozen=True)
class Refined:
    """Nodes: arc lengths (n, 2), trunk poses (n, 3), and what they are worth."""

    s: Floats
    body: Floats
    record: Record

    def part(self, begin: int, end: int) -> Refined:
        """The nodes [begin, end)."""
        return Refined(self.s[begin:end], self.body[begin:end], self.record.part(begin, end))

    def stand(self, k: int) -> Stand:
        """Node `k` as the end of a piece."""
        return Stand((float(self.s[k, 0]), float(self.s[k, 1])), self.body[k])


def concatenated(parts: list[Refined]) -> Refined:
    """One path after the other."""
    s, body = np.concatenate([one.s for one in parts]), np.concatenate([one.body for one in parts])
    return Refined(s, body, joined([one.record for one in parts]))


class Grain(NamedTuple):
    """How nodes are laid for the polish.

    Attributes:
        soft: How much they are smoothed before, and bent as little as possible by it.
        spacing: Of nodes, for legs of 0.4 m [m].
        swing: How much a motion of the trunk counts against the same travel of the wheels.
    """

    soft: float
    spacing: float
    swing: float


COARSE = Grain(1.0, 0.009, 0.3)


def refine(
    q: Question,
    ends: tuple[Stand, Stand],
    s: Floats,
    body: Floats,
    grain: Grain = COARSE,
    held: int = 1,
) -> Refined:
    """Turn a way into dense, smooth nodes.

    Args:
        q: The question.
        ends: Where the way begins and ends.
        s: (n, 2) arc lengths of front and rear wheel [m].
        body: (n, 3) trunk poses.
        grain: How nodes are laid.
        held: Nodes at either end that stay where they are.
    """
    path, robot, weights = q.path, q.robot, q.weights
    s, body = s.copy(), body.copy()
    for k in range(2):
        s[-k], body[-k] = ends[k].wheels, ends[k].body
    p, size = robot.planar, scale(robot)
    u = _spacing(s, body, grain.swing)
    n = max(_LEAST, int(u[-1] / (grain.spacing * size)))
    even = np.linspace(0.0, u[-1], n)
    hop = even[1]
    laid_s = np.stack([np.interp(even, u, s[:, k]) for k in range(2)], axis=1)
    laid_body = np.stack([np.interp(even, u, body[:, k]) for k in range(3)], axis=1)
    nodes_s = _smooth(laid_s, grain.soft * 0.01 * size / hop)
    nodes_body = _smooth(laid_body, grain.soft * 0.05 * size / hop)
    if (np.diff(s, axis=0) >= 0).all():
        nodes_s = np.maximum.accumulate(np.clip(nodes_s, laid_s[held - 1], laid_s[-held]), axis=0)
    fixed = np.zeros(n, np.bool_)
    fixed[:held] = fixed[-held:] = True
    nodes_s[fixed], nodes_body[fixed] = laid_s[fixed], laid_body[fixed]
    nodes_body = np.ascontiguousarray(nodes_body)
    changes = contact_changes(path.pieces, path.corners, nodes_s)
    spans = _intervals(path, nodes_s, changes, q.friction, q.reserve)
    wheels = np.concatenate([path.centres(nodes_s[:, k]) for k in range(2)], axis=1)
    share = hop / 0.015
    still_wanted()
    po.polish(
        q.ground, p, *q.legs, nodes_body, wheels, spans, _wishes(robot, weights, share),
        20.0 * weights.smoothness / share, 600.0 * grain.soft * weights.smoothness / share**3,
        0.25 * size, fixed, 40,
    )  # fmt: skip
    still_wanted()
    dense_s, dense_body = densify(path.pieces, p, q.legs, nodes_s, nodes_body, changes)
    record = evaluate_path(path, q.ground, robot, q.legs, dense_s, dense_body, q.friction)
    return Refined(dense_s, dense_body, record)


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
    moved = np.hypot(np.diff(body[:, 0]), np.diff(body[:, 1])) + 0.25 * np.abs(np.diff(body[:, 2]))
    return np.concatenate([[0.0], np.cumsum(np.hypot(rolled(s), swing * moved) + 1e-9)])


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
