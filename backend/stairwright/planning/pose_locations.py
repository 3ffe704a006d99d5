"""Where poses are needed: the obstacles of a profile, and two wheel places for each.

On the paper's terrain an obstacle is a stair or a ramp. On any profile it is what the wheel centre
climbs or descends between two treads: a tread is a stretch of the wheel-centre curve at least
`TREAD` long whose slope stays below `LEVEL`; between two treads every rise or descent of at least
`LOW` (smaller ups and downs within it ignored) is an obstacle. One that goes up and down again is
two. A flight whose treads are not level is one obstacle for each of its faces; one whose treads are
too short for a tread is one obstacle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.terrain.wheel_path import WheelPath, sample

Flags = NDArray[np.bool_]
Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TREAD = 0.10  # m
LEVEL = math.radians(3.0)
SLOPE = 0.2  # rad; ground between two faces of a flight that is no steeper is a tread too
LOW = 0.02  # m
_STEP = 0.005  # m, sampling of arcs and long lines


@dataclass(frozen=True)
class Obstacle:
    """One rise or descent of the wheel centre. Lengths in m.

    Attributes:
        begin: Arc length where the curve leaves the tread before it: the front wheel arrives at
            the face (eq 25).
        end: Arc length where the next tread is reached.
        height: Gained, or lost where negative (h of eq 26).
        face: h / sin(gamma), gamma the steepest slope of the wheel's way.
        steepest: Arc length of the last place that is as steep.
    """

    begin: float
    end: float
    height: float
    face: float
    steepest: float

    def same_as(self, other: Obstacle) -> bool:
        """Whether the other is as high and as long, to a tenth of a millimetre."""
        return (
            abs(self.height - other.height) < 1e-4
            and abs((self.end - self.begin) - (other.end - other.begin)) < 1e-4
        )


def find_obstacles(path: WheelPath, low: float, high: float) -> list[Obstacle]:
    """Obstacles between the arc lengths `low` and `high`, in order."""
    rows = _obstacles(path.pieces, path.radius, float(low), float(high))
    return [Obstacle(*row) for row in rows.tolist()]


@nb.njit(cache=True)
def _obstacles(pieces: Floats, radius: float, low: float, high: float) -> Floats:
    """Rows with the numbers of an `Obstacle`."""
    s, ends = _samples(pieces[:, 1], low, high)
    z = sample(pieces, radius, s)[:, 1].copy()
    rises, ways = np.abs(np.diff(z)), np.diff(s)
    gentle = rises <= math.sin(LEVEL) * ways + 1e-12
    sloping = rises <= math.sin(SLOPE) * ways + 1e-12
    found = np.empty((len(s), 5))
    count = 0
    for first, last in _rough_stretches(s, gentle):
        faces = _rough_stretches(s[first : last + 1], sloping[first:last])
        if len(faces) < 2:  # no flight
            faces = [(0, last - first)]
        for begin, end in faces:
            low, high = first + begin, first + end
            for a, b in _monotone_runs(z[low : high + 1]):
                found[count] = _obstacle(pieces, radius, s, z, ends, low + a, low + b)
                count += 1
    return found[:count].copy()


@nb.njit(cache=True)
def _samples(begins: Floats, low: float, high: float) -> tuple[Floats, Ints]:
    """Arc lengths at most `_STEP` apart, and which of them are ends of pieces (or `low`, `high`).

    `begins` holds where the pieces of the curve begin.
    """
    inner = begins[(begins > low) & (begins < high)]
    marks = np.concatenate((np.array([low]), inner, np.array([high])))
    s, ends = [low], [0]
    for k in range(len(marks) - 1):
        a, b = marks[k], marks[k + 1]
        n = max(1, math.ceil((b - a) / _STEP))
        for i in range(1, n):
            s.append(a + i * ((b - a) / n))
        if b > s[-1]:  # a piece may have no length
            ends.append(len(s))
            s.append(b)
    return np.array(s), np.array(ends)


@nb.njit(cache=True)
def _rough_stretches(s: Floats, gentle: Flags) -> list[tuple[int, int]]:
    """Index ranges (first, last sample) between treads."""
    out = [(0, 0) for _ in range(0)]
    first = 0
    i, n = 0, len(gentle)
    while i < n:
        if not gentle[i]:
            i += 1
            continue
        j = i
        while j < n and gentle[j]:
            j += 1
        # The ends of the course count as treads however short: the robot stands there.
        if s[j] - s[i] >= TREAD or i == 0 or j == n:
            if i > first:
                out.append((first, i))
            first = j
        i = j
    if first < n:
        out.append((first, n))
    return out


@nb.njit(cache=True)
def _monotone_runs(z: Floats) -> list[tuple[int, int]]:
    """Index ranges of rises and descents of at least `LOW`, smaller turns within them ignored."""
    out = [(0, 0) for _ in range(0)]
    start, extreme, direction = 0, 0, 0.0
    for i in range(1, len(z)):
        if direction == 0.0:
            if abs(z[i] - z[start]) >= LOW:
                direction, extreme = math.copysign(1.0, z[i] - z[start]), i
        elif direction * (z[i] - z[extreme]) > 0:
            extreme = i
        elif direction * (z[extreme] - z[i]) >= LOW:
            out.append((start, extreme))
            start, extreme, direction = extreme, i, -direction
    if direction != 0.0:
        out.append((start, extreme))
    return out


@nb.njit(cache=True)
def _obstacle(
    pieces: Floats, radius: float, s: Floats, z: Floats, ends: Ints, a: int, b: int
) -> tuple[float, float, float, float, float]:
    """The obstacle between two samples: whole arcs, without level pieces at its ends."""
    first = int(np.searchsorted(ends, a, side="right")) - 1
    last = int(np.searchsorted(ends, b, side="left"))
    marks = ends[first : last + 1]
    level = np.abs(np.diff(z[marks])) <= math.sin(LEVEL) * np.diff(s[marks]) + 1e-12
    steep = np.flatnonzero(~level)
    if len(steep):
        a, b = marks[steep[0]], marks[steep[-1] + 1]
    height = z[b] - z[a]
    # The normal (-sin, cos) of the steepest place; samples lie at pieces' ends, so look between.
    middle = (s[a:b] + s[a + 1 : b + 1]) / 2
    slope = -math.copysign(1.0, height) * sample(pieces, radius, middle)[:, 2]
    steepest = slope.max()
    place = middle[np.flatnonzero(slope >= steepest - 1e-6)[-1]]
    return s[a], s[b], height, abs(height) / max(steepest, 1e-3), place


def front_places(
    obstacles: list[Obstacle], radius: float, begin: float, end: float
) -> list[tuple[float, float]]:
    """Arc lengths of the front wheel at the two poses of each obstacle.

    The first: at the face, or where the wheel stands on it already. The second, as eq 26 has it: a
    face and a wheel radius further, at least over the edge, but never past the next face or `end`.

    Args:
        obstacles: In order.
        radius: Of the wheels [m].
        begin: Where the front wheel starts [m].
        end: Where it comes to rest [m].
    """
    places = []
    for k, obstacle in enumerate(obstacles):
        following = obstacles[k + 1].begin if k + 1 < len(obstacles) else end
        first = max(obstacle.begin, begin)
        second = max(obstacle.end, obstacle.begin + obstacle.face + radius)
        places.append((first, max(min(second, following), first + 1e-4)))
    return places
