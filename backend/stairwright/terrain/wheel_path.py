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

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright import _core
from stairwright.compiled import leaf
from stairwright.errors import InputError

from .profile import Terrain

Floats = NDArray[np.float64]

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
        return sample(self.pieces, self.radius, np.atleast_1d(np.asarray(s, float)))[:, :2]

    def normals(self, s: Floats) -> Floats:
        """(n, 2) unit normals at `s` (n,), from the terrain to the wheel centre."""
        return sample(self.pieces, self.radius, np.atleast_1d(np.asarray(s, float)))[:, 2:]

    def contacts(self, s: Floats) -> Floats:
        """(n, 2) contact points on the terrain at `s` (n,)."""
        rows = sample(self.pieces, self.radius, np.atleast_1d(np.asarray(s, float)))
        return rows[:, :2] - self.radius * rows[:, 2:]

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
        return float(project(self.pieces, self.radius, float(point[0]), float(point[1]), lo, hi))


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


@leaf
def piece_at(piece: Floats, r: float, d: float) -> tuple[float, float, float, float]:
    """Centre and normal (x, z, nx, nz) at distance `d` along one piece."""
    if piece[0] == 0.0:
        return piece[3] + d * piece[5], piece[4] + d * piece[6], -piece[6], piece[5]
    angle = piece[5] - d / r
    c, s = math.cos(angle), math.sin(angle)
    return piece[3] + r * c, piece[4] + r * s, c, s


@leaf
def parameter(piece: Floats, r: float, x: float, z: float) -> float:
    """Distance along `piece` of the point of its line or circle nearest to (x, z)."""
    if piece[0] == 0.0:
        return float((x - piece[3]) * piece[5] + (z - piece[4]) * piece[6])
    turn = piece[5] - math.atan2(z - piece[4], x - piece[3])
    turn -= 2 * math.pi * math.floor((turn + math.pi / 2) / (2 * math.pi))
    return float(r * turn)


@leaf
def curve_at(pieces: Floats, r: float, s: float) -> tuple[float, float, float, float]:
    """Centre and normal (x, z, nx, nz) at arc length `s`; the end pieces are continued."""
    k = int(np.searchsorted(pieces[:, 1], s, side="right")) - 1
    k = min(max(k, 0), len(pieces) - 1)
    return piece_at(pieces[k], r, s - pieces[k, 1])


@nb.njit(cache=True)
def sample(pieces: Floats, r: float, s: Floats) -> Floats:
    """Rows (x, z, nx, nz) at each arc length of `s`."""
    out = np.empty((len(s), 4))
    for i in range(len(s)):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = curve_at(pieces, r, s[i])
    return out


@leaf
def project(pieces: Floats, r: float, x: float, z: float, lo: float, hi: float) -> float:
    """Arc length in [lo, hi] whose centre is nearest to (x, z)."""
    best, found = 1e18, lo
    first = max(0, int(np.searchsorted(pieces[:, 1], lo, side="right")) - 1)
    for k in range(first, len(pieces)):
        piece = pieces[k]
        if piece[1] > hi:
            break
        d = parameter(piece, r, x, z)
        d = min(max(d, max(0.0, lo - piece[1])), min(piece[2], hi - piece[1]))
        px, pz, _, _ = piece_at(piece, r, d)
        gap = (px - x) ** 2 + (pz - z) ** 2
        if gap < best:
            best, found = gap, piece[1] + d
    return found


@leaf
def distance_to_profile(p: Floats, x: float, z: float, reach: float) -> float:
    """Distance from (x, z) to the polyline `p`, or `reach` where nothing is nearer."""
    best = reach
    first = max(0, int(np.searchsorted(p[:, 0], x - reach, side="left")) - 1)
    for i in range(first, len(p) - 1):
        if p[i, 0] > x + reach:
            break
        dx, dz = p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1]
        t = ((x - p[i, 0]) * dx + (z - p[i, 1]) * dz) / (dx * dx + dz * dz)
        t = min(1.0, max(0.0, t))
        best = min(best, math.hypot(x - p[i, 0] - t * dx, z - p[i, 1] - t * dz))
    return best


@leaf
def ground_height(p: Floats, x: float) -> float:
    """Upper height of the polyline at `x`; -inf beyond its ends."""
    best = -np.inf
    first = max(0, int(np.searchsorted(p[:, 0], x, side="left")) - 1)
    for i in range(first, len(p) - 1):
        if p[i, 0] > x:
            break
        if x <= p[i + 1, 0]:
            width = p[i + 1, 0] - p[i, 0]
            if width < 1e-12:
                best = max(best, max(p[i, 1], p[i + 1, 1]))
            else:
                best = max(best, p[i, 1] + (p[i + 1, 1] - p[i, 1]) * (x - p[i, 0]) / width)
    return best
