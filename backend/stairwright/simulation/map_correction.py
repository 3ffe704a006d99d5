"""A map on which a face or a tread is where the robot found it, and where on a new plan it is."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Flags, Floats
from stairwright.control.setpoint import JOINTS, PITCH, WHEELS
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath

from .governor import Track

_STEEP = 1.0  # slope beyond which a stretch is a face, else a tread
_ROOM = 0.7  # of a tread beside a face that the face may move by
_WHEELS_OFF = 0.05  # m that a plan may be from where the wheels are
_JOINTS_OFF = 0.5  # rad that legs may have to move for another plan
_WHEELS_NEAR, _JOINTS_NEAR = 0.01, 0.15  # that make no difference
_RADIAN = 0.1  # m of wheels that count as much as one of joints


def corrected(terrain: Terrain, path: WheelPath, s: float, *, face: bool, off: Floats) -> Terrain:
    """The map without an error that was found.

    Args:
        terrain: The map.
        path: Its wheel-centre curve.
        s: Where on it the face or the tread was found [m].
        face: Whether a face was found elsewhere along, else a tread higher or lower.
        off: (2,) the map less what was found [m].
    """
    x, z = np.array(terrain.points).T
    x, z = x.copy(), z.copy()
    steep = np.abs(np.diff(z)) > _STEEP * np.diff(x)
    at = path.contacts(np.array([s]))[0, 0]
    runs = [(is_face, list(k)) for is_face, k in itertools.groupby(range(len(steep)), steep.item)]
    nearest = min(
        (r for r in runs if r[0] == face),
        key=lambda r: max(x[r[1][0]] - at, at - x[r[1][-1] + 1], 0.0),
        default=None,
    )
    if nearest is None:
        return terrain
    first, last = nearest[1][0], nearest[1][-1] + 1
    if face:
        before = x[first] - x[_begin(steep, first)]
        after = x[_end(steep, last)] - x[last]
        x[first : last + 1] += np.clip(-off[0], -_ROOM * before, _ROOM * after)
    else:
        z[first:] -= off[1]
    return Terrain(
        name=terrain.name,
        points=list(zip(np.maximum.accumulate(x).tolist(), z.tolist(), strict=True)),
        friction=terrain.friction,
        start=terrain.start,
        goal=terrain.goal,
    )


def _begin(steep: Flags, k: int) -> int:
    """First point of the tread that ends at point `k`."""
    while k > 0 and not steep[k - 1]:
        k -= 1
    return k


def _end(steep: Flags, k: int) -> int:
    """Last point of the tread that begins at point `k`."""
    while k < len(steep) and not steep[k]:
        k += 1
    return k


@dataclass(frozen=True)
class Row:
    """A row of a plan: its number, and whether a robot near to it can be called there."""

    number: int
    near: bool


def nearest_row(line: Track, target: Floats) -> Row | None:
    """The row of a new plan that is nearest to what the robot does, None if all are far off.

    Args:
        line: The new plan.
        target: (41,) what is asked for now, but for the wheels: where they are.
    """
    wheels = np.abs(line.rows[:, WHEELS] - target[WHEELS]).max(axis=1)
    turned = np.abs(line.rows[:, JOINTS] - target[JOINTS]).max(axis=1)
    turned = np.maximum(turned, np.abs(line.rows[:, PITCH] - target[PITCH]))
    best = int(np.argmin(wheels + _RADIAN * turned))
    if wheels[best] >= _WHEELS_OFF or turned[best] >= _JOINTS_OFF:
        return None
    return Row(best, bool(wheels[best] < _WHEELS_NEAR and turned[best] < _JOINTS_NEAR))
