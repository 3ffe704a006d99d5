"""The terrain near one pose as vectors of fixed length: parameters of the optimisation.

Nothing is rebuilt when a vertex moves or another robot comes: only these numbers change. A window
holds, for each wheel, the pieces of the wheel-centre curve around its place, and the ground as
convex cells: the solid under the profile, cut at concave corners. Cells reach further down than
any robot; too many cells are merged into their convex hulls, which only makes the ground larger.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from stairwright.arrays import Floats
from stairwright.terrain.wheel_path import ARC, WheelPath

PIECES = 12  # of the curve, for each wheel
SIZES = (2, 3, 4, 6)  # numbers of cells that problems are built for
CELLS = SIZES[-1]
EDGES = 6  # of a cell: two sides and up to four of the profile
CORNERS = 7  # of a cell: up to five of the profile and two deep ones
DEPTH = 1.0  # m that cells reach below the profile
SPIKE = 1e-5  # m, half the width given to ground without any
FAR = 50.0  # m, where unused cells are kept


def curve_window(path: WheelPath, s: float) -> tuple[Floats, float, float]:
    """Pieces of the curve around `s`, and the arc lengths between which they are valid.

    Returns:
        Rows (PIECES, 4): arc length at the start, length, heading at the start [rad], curvature
        (0 or 1/R); then the first row's start point as a row (x, z, 0, 0): (PIECES + 1, 4) in all.
    """
    pieces = path.pieces
    here = int(np.clip(np.searchsorted(pieces[:, 1], s, side="right") - 1, 0, len(pieces) - 1))
    first = max(0, min(here - PIECES // 2, len(pieces) - PIECES))
    chosen = pieces[first : first + PIECES]
    rows = np.zeros((PIECES + 1, 4))
    rows[:, 0] = 1e3
    for k, piece in enumerate(chosen):
        if piece[0] == ARC:
            heading, curvature = piece[5] - math.pi / 2, 1.0 / path.radius
        else:
            heading, curvature = math.atan2(piece[6], piece[5]), 0.0
        rows[k] = piece[1], piece[2], heading, curvature
    low, high = float(chosen[0, 1]), float(chosen[-1, 1] + chosen[-1, 2])
    start = path.centres(np.array([low]))[0]
    rows[PIECES] = start[0], start[1], 0.0, 0.0
    return rows, low, high


def cells(vertices: Floats, x_low: float, x_high: float) -> list[Floats]:
    """Convex chains (k, 2), k < EDGES, of the profile within [x_low, x_high], left to right."""
    lo = max(0, int(np.searchsorted(vertices[:, 0], x_low)) - 1)
    hi = min(len(vertices), int(np.searchsorted(vertices[:, 0], x_high, side="right")) + 1)
    p = vertices[lo:hi]
    if len(p) < 2:
        p = vertices[-2:] if lo >= len(vertices) - 1 else vertices[:2]
    chains: list[Floats] = []
    begin = 0
    for i in range(1, len(p)):
        last = i == len(p) - 1
        full = i - begin == EDGES - 2
        if last or full or _turns_left(p[i - 1], p[i], p[i + 1]):
            chain = p[begin : i + 1]
            if np.ptp(chain[:, 0]) < SPIKE:  # a spike, or a face between two concave corners
                x, top = chain[0, 0], chain[:, 1].max()
                chain = np.array([[x - SPIKE, top], [x + SPIKE, top]])
            chains.append(chain)
            begin = i
    return _merged(chains)


def _turns_left(a: Floats, b: Floats, c: Floats) -> bool:
    return bool((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) > 1e-12)


def _merged(chains: list[Floats]) -> list[Floats]:
    """At most CELLS chains: the pair whose hull adds least ground is merged first."""
    chains = list(chains)
    while len(chains) > CELLS:
        hulls = [_upper_hull(np.concatenate(pair)) for pair in itertools.pairwise(chains)]
        added = [
            _area(hull) - _area(a) - _area(b)
            for hull, a, b in zip(hulls, chains, chains[1:], strict=False)
        ]
        k = int(np.argmin(added))
        chains[k : k + 2] = [hulls[k]]
    return chains


def _area(chain: Floats) -> float:
    return float(np.sum(np.diff(chain[:, 0]) * (chain[1:, 1] + chain[:-1, 1]) / 2))


def _upper_hull(points: Floats) -> Floats:
    """Upper convex hull of points in order of x, with at most EDGES - 1 corners (outside of it)."""
    hull: list[Floats] = []
    for point in points:
        while len(hull) > 1 and not _turns_left(point, hull[-1], hull[-2]):
            hull.pop()
        hull.append(point)
    while len(hull) > EDGES - 1:
        hull = _drop_edge(hull)
    return np.array(hull)


def _drop_edge(hull: list[Floats]) -> list[Floats]:
    """One corner less: the inner edge whose neighbours' extensions meet nearest replaces it."""
    best: tuple[float, int, Floats] | None = None
    for i in range(1, len(hull) - 2):
        a, b, c, d = hull[i - 1], hull[i], hull[i + 1], hull[i + 2]
        u, v = b - a, c - d
        det = u[0] * v[1] - u[1] * v[0]
        if abs(det) < 1e-15:
            continue
        t = ((c[0] - b[0]) * v[1] - (c[1] - b[1]) * v[0]) / det
        meet = b + t * u
        if t < 0 or not b[0] - 1e-9 <= meet[0] <= c[0] + 1e-9:
            continue
        cost = abs((meet[0] - b[0]) * (c[1] - b[1]) - (meet[1] - b[1]) * (c[0] - b[0]))
        if best is None or cost < best[0]:
            best = (cost, i, meet)
    if best is None:  # only steep neighbours: a flat lid over everything
        top = max(float(point[1]) for point in hull)
        return [np.array([hull[0][0], top]), np.array([hull[-1][0], top])]
    _, i, meet = best
    return [*hull[:i], meet, *hull[i + 2 :]]


def cell_vector(chains: list[Floats]) -> tuple[Floats, Floats, Floats]:
    """Normals (n, EDGES, 2), offsets (n, EDGES) and corners (n, CORNERS, 2) of n cells in `SIZES`.

    A point p lies in a cell where ``normals @ p <= offsets``. Unused edges repeat the first one,
    unused corners the last one; unused cells lie FAR below.
    """
    size = next(n for n in SIZES if n >= len(chains))
    normals = np.zeros((size, EDGES, 2))
    offsets = np.zeros((size, EDGES))
    corners = np.zeros((size, CORNERS, 2))
    for i in range(size):
        chain = chains[i] if i < len(chains) else np.array([[-1.0, -FAR], [1.0, -FAR]])
        left, right = chain[0, 0], chain[-1, 0]
        floor = float(chain[:, 1].min()) - DEPTH
        step = np.diff(chain, axis=0)
        n = np.stack([-step[:, 1], step[:, 0]], axis=1) / np.hypot(step[:, 0], step[:, 1])[:, None]
        faces = np.concatenate([n, [[-1.0, 0.0], [1.0, 0.0]]])
        reach = np.concatenate([np.sum(n * chain[:-1], axis=1), [-left, right]])
        points = np.concatenate([chain, [[right, floor], [left, floor]]])
        normals[i], offsets[i] = faces[0], reach[0]
        normals[i, : len(faces)], offsets[i, : len(reach)] = faces, reach
        corners[i] = points[-1]
        corners[i, : len(points)] = points
    return normals, offsets, corners
