"""The curve of wheel centres: the profile offset by the wheel radius, exact, by arc length.

The ground is everything below an x-monotone profile, so the places that a rolling wheel's centre
can take are the upper boundary of that set dilated by a disc: offset segments, arcs round convex
corners, and kinks (two contacts) at concave ones. The curve is x-monotone again.

A piece is a row ``[kind, s0, length, x, z, a, b]``: a line (kind 0) from (x, z) along the unit
tangent (a, b), or an arc (kind 1) round the corner (x, z) that starts at angle a, clockwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stairwright import _core
from stairwright.arrays import Flags, Floats
from stairwright.errors import InputError

from .profile import Terrain

LINE, ARC = 0.0, 1.0


@dataclass(frozen=True)
class WheelPath:
    """Wheel centres over a profile. Lengths in m, world frame.

    Attributes:
        radius: Wheel radius [m].
        pieces: (m, 7) lines and arcs, see the module's text.
        corners: (k,) arc lengths of concave corners, where the wheel touches two faces.
        vertices: (n, 2) the profile that it was made from.
        native: The same curve in the native core.
    """

    radius: float
    pieces: Floats
    corners: Floats
    vertices: Floats
    native: _core.WheelPath

    @property
    def length(self) -> float:
        """Arc length of the whole curve [m]."""
        return float(self.pieces[-1, 1] + self.pieces[-1, 2])

    def centres(self, s: Floats) -> Floats:
        """(n, 2) wheel centres at arc lengths `s` (n,)."""
        return self._sampled(s)[:, :2].copy()

    def normals(self, s: Floats) -> Floats:
        """(n, 2) unit normals at `s` (n,), from the terrain to the wheel centre."""
        return self._sampled(s)[:, 2:].copy()

    def on_edge(self, s: Floats) -> Flags:
        """(...) whether a wheel at arc lengths `s` (...) is round an edge."""
        piece = np.searchsorted(self.pieces[:, 1], s, side="right") - 1
        on_edge: Flags = self.pieces[piece.clip(0), 0] != LINE
        return on_edge

    def contacts(self, s: Floats) -> Floats:
        """(n, 2) contact points on the terrain at `s` (n,)."""
        rows = self._sampled(s)
        return rows[:, :2] - self.radius * rows[:, 2:]

    def normal(self, s: float) -> tuple[float, float]:
        """The unit normal (x, z) at one place."""
        _, _, x, z = self._sampled(np.array([s]))[0].tolist()
        return x, z

    def at_x(self, x: float) -> float:
        """Least arc length whose centre has this `x` (the curve never turns back)."""
        starts = self.centres(self.pieces[:, 1])[:, 0]
        k = max(0, int(np.searchsorted(starts, x - 1e-12, side="left")) - 1)
        _, s0, length, px, _, a, _ = self.pieces[k]
        if self.pieces[k, 0] == LINE:
            ahead = 0.0 if abs(a) < 1e-12 else (x - px) / a
        else:
            angle = math.acos(min(1.0, max(-1.0, (x - px) / self.radius)))
            ahead = (a - angle) * self.radius
        return float(s0 + min(length, max(0.0, ahead)))

    def project(self, point: Floats, near: float | None = None, window: float = 0.1) -> float:
        """Arc length of the centre nearest to `point` (2,); within `window` of `near` if given."""
        lo, hi = (0.0, self.length) if near is None else (near - window, near + window)
        return self.native.project(float(point[0]), float(point[1]), lo, hi)

    def _sampled(self, s: Floats) -> Floats:
        """Rows (n, 4): centre and normal."""
        return self.native.sample(np.atleast_1d(np.asarray(s, float)))


def wheel_path(terrain: Terrain, radius: float) -> WheelPath:
    """The exact wheel-centre curve of `terrain` for wheels of `radius` [m].

    Raises:
        InputError: If the profile is too short to hold a wheel.
    """
    vertices = np.ascontiguousarray(terrain.vertices)
    try:
        native = _core.WheelPath(vertices, radius)
    except ValueError as error:
        raise InputError(str(error), ("points",)) from None
    return WheelPath(radius, native.pieces, native.corners, vertices, native)
