"""Where the ground may lie as a wheel that stands on it sees it, for the certificate.

Faces (stretches steeper than 45 degrees) stand elsewhere along, each by its own error; each makes
the step there taller or lower, which lifts all that lies behind. A wheel goes by the ground under
it: the tread that it stands on has the height, and the face that it touched last the place, that it
has from its centre as drawn. All else may be off by what lies between.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely

from stairwright.arrays import Flags, Floats, Ints

Geometry = Any  # of shapely

BOX = np.array([(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)])
STEPS = 4  # in which the room before a face ahead is told
_SIGHT = 1.0  # m; ground farther off than this, and the robot's reach, is not looked at
_BLOCK = 200_000  # wheels times segments handled at once


@dataclass(frozen=True)
class Footing:
    """What a wheel goes by.

    Attributes:
        touched: (m - 1,) segments of the profile.
        low, high: Levels of the treads that it may be taken to stand on.
        faces: Numbers of the faces whose place it knows; of the one behind it if it touches none.
        ahead: How far it is at most from an upright face ahead, which cannot be nearer than to
            touch it [m].
    """

    touched: Flags
    low: int
    high: int
    faces: frozenset[int]
    ahead: float


class VariedGround:
    """A profile whose steps and faces may each be off.

    Attributes:
        vertices: (m, 2) profile as drawn [m].
        place, height: How far faces may be off along, how much taller or lower steps may be [m].
        steep: (m - 1,) which segments belong to faces.
        face: (m - 1,) number of the face that a segment belongs to, or of the last one before it.
    """

    def __init__(self, vertices: Floats, place: float, height: float) -> None:
        self.vertices, self.place, self.height = vertices, place, height
        along, up = np.diff(vertices, axis=0).T
        self.steep: Flags = np.abs(up) > along
        begins = self.steep & ~np.append(False, self.steep[:-1])
        self.face: Ints = np.cumsum(begins)  # 1, 2, ...: none is 0

    @cached_property
    def _levels(self) -> Ints:
        """(m, 2) least and largest level of the treads that a vertex may be taken to belong to."""
        # Before the first segment and behind the last the profile goes on as a tread.
        steep = np.concatenate([[False], self.steep, [False]])
        level = np.concatenate([self.face[:1] - self.steep[:1], self.face, self.face[-1:]])
        inside = steep[:-1] & steep[1:]  # of a face of several segments: between both treads
        high = np.where(steep[:-1], level[1:], level[:-1])
        return np.stack([high - inside, high], axis=1)

    @cached_property
    def _face_at(self) -> Ints:
        """(m,) number of the face that a vertex belongs to, 0 if none."""
        of = np.where(self.steep, self.face, 0)
        found: Ints = np.maximum(np.append(of, 0), np.append(0, of))
        return found

    def touched(self, centres: Floats, second: Floats) -> Flags:
        """Which segments (n, m - 1) wheels at `centres` (n, 2) touch.

        That is the nearest one for certain, and others within `second` (n,) of the centre [m].
        """
        out = np.zeros((len(centres), len(self.steep)), np.bool_)
        step = max(1, _BLOCK // len(self.steep))
        p, d = self.vertices[:-1], np.diff(self.vertices, axis=0)
        for k in range(0, len(centres), step):
            part = slice(k, k + step)
            away = centres[part, None] - p
            t = np.clip((away * d).sum(axis=2) / (d * d).sum(axis=1), 0.0, 1.0)
            distance = np.linalg.norm(away - t[..., None] * d, axis=2)
            nearest = distance.min(axis=1, keepdims=True)
            out[part] = distance <= np.maximum(nearest + 1e-9, second[part, None])
        return out

    def ahead(self, centres: Floats, touched: Flags, radius: float) -> Ints:
        """How far wheels (n,) are from the upright face ahead, in `STEPS` of what it may be off.

        Rounded up; `STEPS` where it is farther, or no face that a wheel meets at its full height.
        """
        x, z = self.vertices.T
        upright = (np.diff(x) < 1e-9) & (np.diff(z) > 0.0)
        out = np.full(len(centres), STEPS)
        if not (upright.any() and self.place):
            return out
        last = touched.shape[1] - 1 - np.argmax(touched[:, ::-1], axis=1)
        following = np.append(np.flatnonzero(upright), len(upright))
        ahead = following[np.searchsorted(following, last, side="right")]
        met = ahead == last + 1  # on the tread of which it ends, and higher than the wheel's middle
        k = np.minimum(ahead, len(upright) - 1)
        met &= (z[k] <= centres[:, 1] - radius + 1e-3) & (z[k + 1] >= centres[:, 1])
        gap = np.maximum(x[k] - centres[:, 0] - radius, 0.0)
        steps = np.ceil(gap / (2 * self.place) * STEPS + 1e-6)
        return np.where(met, np.minimum(steps, STEPS), STEPS).astype(np.int64)

    def footing(self, touched: Flags, ahead: int, back: bool = False) -> Footing:
        """What a wheel goes by that touches some segments.

        On a face alone that is the tread that it comes from: behind, or, where it may have rolled
        `back`, either. `ahead` is how far the next face is, see there.
        """
        treads, faces = self.face[touched & ~self.steep], self.face[touched & self.steep]
        known = set(faces.tolist()) or set(treads.tolist())
        levels = treads if len(treads) else np.concatenate([faces - 1, faces[: len(faces) * back]])
        gap = 2 * self.place * ahead / STEPS
        return Footing(touched, int(levels.min()), int(levels.max()), frozenset(known - {0}), gap)

    def apart(self, front: Footing, rear: Footing) -> Floats:
        """(2,) how far the ground of one wheel may be off against that of another, x and z [m]."""
        if front.faces & rear.faces or not (front.faces or rear.faces):
            along = 0.0
        else:
            along = self.place * (2.0 if front.faces and rear.faces else 1.0)
        steps = max(front.high - rear.low, rear.high - front.low)
        return np.array([along, self.height * steps])

    def off(self, footing: Footing) -> Floats:
        """How far vertices may be off against the ground under a wheel, at least and at most.

        Returns:
            (2, m, 2) in x and z [m].
        """
        known = np.isin(self._face_at, list(footing.faces))
        own = np.where(self._face_at > 0, 1.0, 0.0) + (1.0 if footing.faces else 0.0)
        levels = self._levels
        steps = np.maximum(levels[:, 1] - footing.low, footing.high - levels[:, 0])
        most = np.stack([self.place * np.where(known, 0.0, own), self.height * steps], axis=1)
        least = -most
        following = self._face_at == max(footing.faces, default=0) + 1
        least[following, 0] = np.maximum(least[following, 0], -footing.ahead)
        return np.stack([least, most])

    def where(self, off: Floats, low: float, high: float, touched: Flags | None = None) -> Geometry:
        """All places of the ground between two abscissas.

        Args:
            off: (2, m, 2) how far vertices may be off, at least and at most, in x and z [m].
            low, high: The abscissas [m].
            touched: Segments that are on their own line, whatever their ends.
        """
        middle, half = off.mean(axis=0), 0.5 * (off[1] - off[0])
        corners = (self.vertices + middle)[:, None] + half[:, None] * BOX
        ends = np.concatenate([corners[:-1], corners[1:]], axis=1)
        if touched is not None:
            d = np.diff(self.vertices, axis=0)
            rows, axis = np.arange(len(d)), np.where(self.steep, 1, 0)
            unit = d / np.maximum(np.abs(d[rows, axis]), 1e-12)[:, None]
            most = np.abs(off).max(axis=0)
            first = self.vertices[:-1] - most[rows, axis, None] * unit
            last = self.vertices[1:] + most[rows + 1, axis, None] * unit
            line = np.stack([first, last], axis=1)
            ends[touched] = np.repeat(line[touched], 4, axis=1)
        x = ends[..., 0]
        near = (x.max(axis=1) >= low - _SIGHT) & (x.min(axis=1) <= high + _SIGHT)
        hulls = shapely.convex_hull(shapely.linestrings(ends[near]))
        ground = shapely.geometrycollections(hulls)
        shapely.prepare(ground)
        return ground


def groups(*rows: Flags) -> list[Ints]:
    """Indices of samples whose rows (n, ...) are all alike."""
    packed = np.packbits(np.concatenate(rows, axis=1), axis=1)
    _, number = np.unique(packed, axis=0, return_inverse=True)
    order = np.argsort(number.ravel(), kind="stable")
    ends = np.cumsum(np.bincount(number.ravel()))[:-1]
    return np.split(order, ends)
