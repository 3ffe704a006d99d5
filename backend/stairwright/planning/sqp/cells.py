"""The ground of a course as convex cells: the solid under the profile, cut at concave corners.

The reference (`planning.terrain_window`) cuts the same cells out of a window of fixed size; here
they are made once per terrain, with as many faces as they have.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.planning.terrain_window import DEPTH, SPIKE
from stairwright.terrain.wheel_path import WheelPath

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Course(NamedTuple):
    """Wheel-centre curve and ground of one terrain, for compiled code. Metres, world frame.

    Attributes:
        pieces: (m, 7) of the wheel-centre curve, see `WheelPath`.
        corners: (k,) arc lengths of its concave corners.
        radius: Of the wheel.
        vertices: (n, 2) profile.
        faces: (f, 3) unit normal and offset of the cells' faces: inside where n . p <= offset.
        points: (p, 2) corners of the cells.
        spans: (c, 4) first and last + 1 face, first and last + 1 point of each cell.
        boxes: (c, 3) least x, largest x, largest z of each cell, in order of x.
    """

    pieces: Floats
    corners: Floats
    radius: float
    vertices: Floats
    faces: Floats
    points: Floats
    spans: Ints
    boxes: Floats


def make_course(path: WheelPath) -> Course:
    """The course of a wheel-centre curve."""
    vertices = np.ascontiguousarray(path.vertices)
    return Course(path.pieces, path.corners, path.radius, vertices, *_cells(vertices, SPIKE, DEPTH))


@nb.njit(cache=True)
def _cells(p: Floats, spike: float, depth: float) -> tuple[Floats, Floats, Ints, Floats]:
    n = len(p)
    faces, points = np.empty((4 * n, 3)), np.empty((5 * n, 2))
    spans, boxes = np.empty((n, 4), np.int64), np.empty((n, 3))
    f, c, count, begin = 0, 0, 0, 0
    for i in range(1, n):
        if i < n - 1:
            turn = (p[i, 0] - p[i - 1, 0]) * (p[i + 1, 1] - p[i, 1])
            turn -= (p[i, 1] - p[i - 1, 1]) * (p[i + 1, 0] - p[i, 0])
            if turn <= 1e-12:
                continue
        chain = p[begin : i + 1]
        top, low = chain[0, 1], chain[0, 1]
        for k in range(len(chain)):
            top, low = max(top, chain[k, 1]), min(low, chain[k, 1])
        if chain[-1, 0] - chain[0, 0] < spike:
            # A spike, or a face between two concave corners: ground needs some width.
            x = chain[0, 0]
            chain = np.array([[x - spike, top], [x + spike, top]])
            low = top
        first_face, first_point = f, c
        for k in range(len(chain) - 1):
            dx, dz = chain[k + 1, 0] - chain[k, 0], chain[k + 1, 1] - chain[k, 1]
            length = math.hypot(dx, dz)
            faces[f, 0], faces[f, 1] = -dz / length, dx / length
            faces[f, 2] = faces[f, 0] * chain[k, 0] + faces[f, 1] * chain[k, 1]
            f += 1
        left, right = chain[0, 0], chain[-1, 0]
        faces[f, 0], faces[f, 1], faces[f, 2] = -1.0, 0.0, -left
        faces[f + 1, 0], faces[f + 1, 1], faces[f + 1, 2] = 1.0, 0.0, right
        f += 2
        points[c : c + len(chain)] = chain
        c += len(chain)
        points[c, 0], points[c, 1] = right, low - depth
        points[c + 1, 0], points[c + 1, 1] = left, low - depth
        c += 2
        spans[count, 0], spans[count, 1] = first_face, f
        spans[count, 2], spans[count, 3] = first_point, c
        boxes[count, 0], boxes[count, 1], boxes[count, 2] = left, right, top
        count += 1
        begin = i
    return faces[:f].copy(), points[:c].copy(), spans[:count].copy(), boxes[:count].copy()
