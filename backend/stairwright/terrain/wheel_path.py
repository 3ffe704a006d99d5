"""The curve of wheel centres: the profile offset by the wheel radius, exact, by arc length.

The ground is everything below an x-monotone profile, so the places that a rolling wheel's centre
can take are the upper boundary of that set dilated by a disc: offset segments, arcs round convex
corners, and kinks (two contacts) at concave ones. The curve is x-monotone again.

A piece is a row ``[kind, s0, length, x, z, a, b]``: a line (kind 0) from (x, z) along the unit
tangent (a, b), or an arc (kind 1) round the corner (x, z) that starts at angle a, clockwise.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.errors import InputError

from .profile import Terrain

Floats = NDArray[np.float64]

LINE, ARC = 0.0, 1.0
_SHORTEST = 1e-9  # m; shorter pieces are dropped
_KINK = 1e-3  # rad; a larger jump of the normal towards the wheel is a concave corner


@dataclass(frozen=True)
class WheelPath:
    """Wheel centres over a profile. Lengths in m, world frame.

    Attributes:
        radius: Wheel radius [m].
        pieces: (m, 7) lines and arcs, see the module's text.
        corners: (k,) arc lengths of concave corners, where the wheel touches two faces.
        vertices: (n, 2) the profile that it was made from.
    """

    radius: float
    pieces: Floats
    corners: Floats
    vertices: Floats

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
    pieces = _trim(_raw_pieces(vertices, radius), vertices, radius)
    if len(pieces) == 0:
        raise InputError("the profile is too short for the wheel", ("points",))
    return WheelPath(radius, pieces, _concave_corners(pieces, radius), vertices)


@nb.njit(cache=True)
def _raw_pieces(p: Floats, r: float) -> Floats:
    """Offset segments and the arcs between them, untrimmed; their arc lengths are still 0."""
    out = np.zeros((2 * len(p), 7))
    count, ux, uz = 0, 0.0, 0.0  # direction of the segment before
    for i in range(len(p) - 1):
        ax, az = p[i, 0], p[i, 1]
        length = math.hypot(p[i + 1, 0] - ax, p[i + 1, 1] - az)
        tx, tz = (p[i + 1, 0] - ax) / length, (p[i + 1, 1] - az) / length
        turn = math.atan2(ux * tz - uz * tx, ux * tx + uz * tz) if i > 0 else 0.0
        if abs(abs(turn) - math.pi) < 1e-9:
            turn = -math.pi  # the tip of a zero-width spike (slits are closed beforehand)
        if turn < -1e-12:
            out[count, 0], out[count, 2] = ARC, -turn * r
            out[count, 3], out[count, 4], out[count, 5] = ax, az, math.atan2(ux, -uz)
            count += 1
        out[count, 0], out[count, 2] = LINE, length
        out[count, 3], out[count, 4] = ax - r * tz, az + r * tx
        out[count, 5], out[count, 6] = tx, tz
        count += 1
        ux, uz = tx, tz
    return out[:count].copy()


def _concave_corners(pieces: Floats, r: float) -> Floats:
    found = []
    for before, after in itertools.pairwise(pieces):
        _, _, ax, az = piece_at(before, r, before[2])
        _, _, bx, bz = piece_at(after, r, 0.0)
        if ax * bz - az * bx > _KINK:  # the normal jumps anticlockwise: a dent
            found.append(after[1])
    return np.array(found, dtype=float)


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


@leaf
def _bounds(piece: Floats, r: float) -> tuple[float, float]:
    if piece[0] == 1.0:
        return piece[3] - r, piece[3] + r
    end = piece[3] + piece[2] * piece[5]
    return min(piece[3], end), max(piece[3], end)


@leaf
def _crossings(a: Floats, b: Floats, r: float, out: Floats) -> int:
    """Intersections of the full line or circle of `a` with those of `b`; returns their number."""
    if a[0] == 0.0 and b[0] == 0.0:
        det = a[5] * b[6] - a[6] * b[5]
        if abs(det) < 1e-12:
            return 0
        u = ((b[3] - a[3]) * b[6] - (b[4] - a[4]) * b[5]) / det
        out[0, 0], out[0, 1] = a[3] + u * a[5], a[4] + u * a[6]
        return 1
    if a[0] == 1.0 and b[0] == 1.0:
        dx, dz = b[3] - a[3], b[4] - a[4]
        gap = math.hypot(dx, dz)
        if gap < 1e-12 or gap >= 2 * r:
            return 0
        h = math.sqrt(r * r - gap * gap / 4)
        for k in range(2):
            side = h if k == 0 else -h
            out[k, 0] = (a[3] + b[3]) / 2 - side * dz / gap
            out[k, 1] = (a[4] + b[4]) / 2 + side * dx / gap
        return 2
    line, arc = (a, b) if a[0] == 0.0 else (b, a)
    ox, oz = line[3] - arc[3], line[4] - arc[4]
    along = ox * line[5] + oz * line[6]
    disc = along * along - (ox * ox + oz * oz - r * r)
    if disc <= 0:
        return 0
    for k in range(2):
        u = -along + (math.sqrt(disc) if k == 0 else -math.sqrt(disc))
        out[k, 0], out[k, 1] = line[3] + u * line[5], line[4] + u * line[6]
    return 2


@nb.njit(cache=True)
def _trim(raw: Floats, p: Floats, r: float) -> Floats:
    """Cut every raw piece at every crossing; keep the parts that are `r` away from the terrain."""
    n = len(raw)
    lo, hi = np.empty(n), np.empty(n)
    for i in range(n):
        lo[i], hi[i] = _bounds(raw[i], r)
    # Raw order follows x up to the wheel's diameter: a running maximum bounds the search.
    reach, ahead = hi.copy(), lo.copy()
    for i in range(1, n):
        reach[i] = max(reach[i], reach[i - 1])
    for i in range(n - 2, -1, -1):
        ahead[i] = min(ahead[i], ahead[i + 1])
    out = np.empty((4 * n + 8, 7))
    count, s = 0, 0.0
    points = np.empty((2, 2))
    cuts = np.empty(4 * n + 2)
    for i in range(n):
        cuts[0], cuts[1], k = 0.0, raw[i, 2], 2
        for j in range(int(np.searchsorted(reach, lo[i] - 1e-9)), n):
            if ahead[j] > hi[i] + 1e-9:
                break
            if j == i or lo[j] > hi[i] + 1e-9 or hi[j] < lo[i] - 1e-9:
                continue
            for m in range(_crossings(raw[i], raw[j], r, points)):
                u = parameter(raw[i], r, points[m, 0], points[m, 1])
                v = parameter(raw[j], r, points[m, 0], points[m, 1])
                if _SHORTEST < u < raw[i, 2] - _SHORTEST and -1e-9 <= v <= raw[j, 2] + 1e-9:
                    cuts[k] = u
                    k += 1
        order = np.sort(cuts[:k])
        begin = -1.0
        for m in range(k):
            kept = False
            if m + 1 < k and order[m + 1] - order[m] > _SHORTEST:
                x, z, _, _ = piece_at(raw[i], r, 0.5 * (order[m] + order[m + 1]))
                near = distance_to_profile(p, x, z, r + 1e-6)
                kept = near > r - 1e-7 and z > ground_height(p, x)
            elif m + 1 < k:
                continue
            if kept and begin < 0:
                begin = order[m]
            elif not kept and begin >= 0:
                x, z, _, _ = piece_at(raw[i], r, begin)
                out[count] = raw[i]
                out[count, 1], out[count, 2] = s, order[m] - begin
                if raw[i, 0] == 0.0:
                    out[count, 3], out[count, 4] = x, z
                else:
                    out[count, 5] = raw[i, 5] - begin / r
                s += order[m] - begin
                count += 1
                begin = -1.0
    return out[:count].copy()
