"""Where along its curve a wheel is sampled, and the way between samples."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.planning.standing import StandingPose
from stairwright.terrain.wheel_path import ARC, WheelPath

CORNER = 0.15  # rad; concave corners with a smaller kink need no samples of their own
_APART = 5e-5  # m; samples are no closer
_MOST_CORNERS = 60  # of one lattice; memory grows with the square of its samples


def rolled(s: Floats) -> Floats:
    """Mean way (n - 1,) that the wheels roll from one node (n, 2) to the next, either way [m]."""
    way: Floats = 0.5 * np.abs(np.diff(s, axis=0)).sum(axis=1)
    return way


def sample_wheel_places(
    path: WheelPath, begin: StandingPose, end: StandingPose, step: float, size: float,
    brinks: bool = False,
) -> Floats:  # fmt: skip
    """Arc lengths (n,) of the lattice's wheel positions, rising.

    They are at most `step` apart. In a concave corner a wheel touches two faces, a tenth of a
    millimetre beside it one: samples at all three make a pose that stands on one face alone come
    before and after any that leans on both. A saw has more corners than a lattice can hold: there
    only the sharpest of those that lie close together are sampled, and what lies between is left to
    the smoothing and the certificate. With `brinks` there is one where a wheel begins to roll round
    an edge, too, and where it ends: as far ahead as a tread carries it upright.
    """
    s0, s1 = begin.wheels[1], end.wheels[0]
    marks = [begin.wheels[0], begin.wheels[1], end.wheels[0], end.wheels[1]]
    apart = 0.0
    corners = _sharp_corners(path, s0, s1, apart)
    while len(corners) > _MOST_CORNERS:
        apart = max(2 * apart, 0.008 * size)
        corners = _sharp_corners(path, s0, s1, apart)
    for corner in corners:
        marks += [corner - _core.BESIDE, corner, corner + _core.BESIDE]
    if brinks:
        marks += _brinks(path, s0, s1)
    fixed = set(marks[:4])
    kept: list[float] = []
    for mark in sorted(m for m in marks if s0 <= m <= s1):
        if kept and mark - kept[-1] < _APART:
            if mark in fixed and kept[-1] not in fixed:
                kept[-1] = mark
            elif mark not in fixed or mark - kept[-1] < 1e-12:
                continue
            else:
                kept.append(mark)
        else:
            kept.append(mark)
    out: list[float] = []
    for a, b in pairwise(kept):
        n = max(1, math.ceil((b - a) / step - 1e-6))
        out.extend(a + (b - a) * k / n for k in range(n))
    return np.array([*out, kept[-1]])


def _sharp_corners(path: WheelPath, s0: float, s1: float, apart: float) -> list[float]:
    """Concave corners between `s0` and `s1`, none within `apart` of a sharper one [m]."""
    corners = path.corners[(path.corners > s0) & (path.corners < s1)]
    kinks = np.array([kink(path, float(corner)) for corner in corners])
    kept: list[float] = []
    for i in np.argsort(-kinks, kind="stable"):
        if kinks[i] > CORNER and all(abs(corners[i] - one) >= apart for one in kept):
            kept.append(float(corners[i]))
    return kept


def _brinks(path: WheelPath, s0: float, s1: float) -> list[float]:
    """Where a wheel is about to roll round an edge, or has just done so; none on a saw."""
    arcs = path.pieces[path.pieces[:, 0] == ARC]
    arcs = arcs[arcs[:, 2] > CORNER * path.radius]
    ends = np.concatenate([arcs[:, 1], arcs[:, 1] + arcs[:, 2]])
    out: list[float] = ends[(ends > s0) & (ends < s1)].tolist()
    return out if len(out) <= 2 * _MOST_CORNERS else []


def kink(path: WheelPath, corner: float) -> float:
    """Angle between the two normals at a concave corner [rad]."""
    a, b = path.normals(np.array([corner - 1e-7, corner + 1e-7]))
    return math.atan2(a[0] * b[1] - a[1] * b[0], float(a @ b))
