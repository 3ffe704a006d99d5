"""Signed distance of points to the terrain, for colouring them."""

from __future__ import annotations

import numpy as np

from stairwright.arrays import Floats
from stairwright.terrain.profile import height_at


def nearest(vertices: Floats, points: Floats) -> Floats:
    """(k, 2) places on the profile `vertices` (n, 2) that are nearest to `points` (k, 2)."""
    # Only segments that can be near: a drawn profile may have thousands.
    reach = 0.5
    lo = np.searchsorted(vertices[:, 0], points[:, 0].min() - reach, side="left")
    hi = np.searchsorted(vertices[:, 0], points[:, 0].max() + reach, side="right")
    part = vertices[max(0, lo - 1) : hi + 1]
    if len(part) < 2:
        part = vertices
    a, d = part[:-1], np.diff(part, axis=0)
    square = np.maximum(np.sum(d * d, axis=1), 1e-18)
    share = np.clip(np.sum((points[:, None] - a) * d, axis=2) / square, 0.0, 1.0)
    feet = a + share[..., None] * d
    best = np.argmin(np.sum((points[:, None] - feet) ** 2, axis=2), axis=1)
    chosen: Floats = feet[np.arange(len(points)), best]
    return chosen


def clearance(vertices: Floats, points: Floats) -> Floats:
    """(k,) distances [m] of `points` (k, 2) from the profile; negative inside the terrain."""
    gap = points - nearest(vertices, points)
    distance = np.hypot(gap[:, 0], gap[:, 1])
    inside = points[:, 1] < height_at(vertices, points[:, 0])
    return np.where(inside, -distance, distance)
