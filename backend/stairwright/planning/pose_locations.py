"""Where poses are needed: the obstacles of a profile, and two wheel places for each.

On the paper's terrain an obstacle is a stair or a ramp. On any profile it is what the wheel centre
climbs or descends between two treads: a tread is a stretch of the wheel-centre curve at least
`TREAD` long whose slope stays below `LEVEL`; between two treads every rise or descent of at least
`LOW` (smaller ups and downs within it ignored) is an obstacle. One that goes up and down again is
two. A flight whose treads are too short for a tread is one obstacle.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stairwright.terrain.wheel_path import WheelPath

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TREAD = 0.10  # m
LEVEL = math.radians(3.0)
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
    s = _samples(path, low, high)
    z = path.centres(s)[:, 1]
    step = np.diff(s)
    gentle = np.abs(np.diff(z)) <= math.sin(LEVEL) * step + 1e-12
    # Samples at the ends of pieces, and the first and the last one.
    ends = np.unique([0, len(s) - 1, *np.flatnonzero(np.isin(s, path.pieces[:, 1]))])
    found: list[Obstacle] = []
    for first, last in _rough_stretches(s, gentle.tolist()):
        for a, b in _monotone_runs(z[first : last + 1].tolist()):
            found.append(_obstacle(path, s, z, ends, first + a, first + b))
    return found


def _samples(path: WheelPath, low: float, high: float) -> Floats:
    ends = path.pieces[:, 1]
    marks = np.concatenate([[low], ends[(ends > low) & (ends < high)], [high]])
    parts = [
        np.linspace(a, b, max(1, int(np.ceil((b - a) / _STEP))), endpoint=False)
        for a, b in itertools.pairwise(marks)
    ]
    return np.unique(np.concatenate([*parts, [high]]))


def _rough_stretches(s: Floats, gentle: list[bool]) -> list[tuple[int, int]]:
    """Index ranges (first, last sample) between treads."""
    out: list[tuple[int, int]] = []
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


def _monotone_runs(z: list[float]) -> list[tuple[int, int]]:
    """Index ranges of rises and descents of at least `LOW`, smaller turns within them ignored."""
    out: list[tuple[int, int]] = []
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


def _obstacle(path: WheelPath, s: Floats, z: Floats, ends: Ints, a: int, b: int) -> Obstacle:
    """The obstacle between two samples: whole arcs, without level pieces at its ends."""
    first = int(np.searchsorted(ends, a, side="right")) - 1
    last = int(np.searchsorted(ends, b, side="left"))
    marks = ends[first : last + 1]
    level = np.abs(np.diff(z[marks])) <= math.sin(LEVEL) * np.diff(s[marks]) + 1e-12
    steep = np.flatnonzero(~level)
    if len(steep):
        a, b = int(marks[steep[0]]), int(marks[steep[-1] + 1])
    height = float(z[b] - z[a])
    # The normal (-sin, cos) of the steepest place; samples lie at pieces' ends, so look between.
    middle = (s[a:b] + s[a + 1 : b + 1]) / 2
    slope = -math.copysign(1.0, height) * path.normals(middle)[:, 0]
    steepest = float(slope.max())
    place = float(middle[np.flatnonzero(slope >= steepest - 1e-6)[-1]])
    return Obstacle(float(s[a]), float(s[b]), height, abs(height) / max(steepest, 1e-3), place)


def front_places(obstacles: list[Obstacle], radius: float, end: float) -> list[tuple[float, float]]:
    """Arc lengths of the front wheel at the two poses of each obstacle.

    The first: at the face. The second, as eq 26 has it: a face and a wheel radius further, at
    least over the edge, but never past the next face or `end`.
    """
    places = []
    for k, obstacle in enumerate(obstacles):
        following = obstacles[k + 1].begin if k + 1 < len(obstacles) else end
        second = max(obstacle.end, obstacle.begin + obstacle.face + radius)
        places.append((obstacle.begin, max(min(second, following), obstacle.begin + 1e-4)))
    return places
