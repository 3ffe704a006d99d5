"""Camera presets: where to stand to see a course and a robot."""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from stairwright.errors import InputError

Floats = NDArray[np.float64]
Preset = Literal["iso", "side", "front", "follow"]
FIELD_OF_VIEW = 0.62  # rad, vertical

# Unit directions from the subject to the camera, and distances in m.
_DIRECTIONS = {
    "iso": (-0.52, -0.88, 0.58),
    "side": (0.0, -1.0, 0.10),
    "front": (0.95, -0.32, 0.34),
    "follow": (-0.45, -0.92, 0.42),
}
_DISTANCE = {"side": 2.4, "front": 2.1, "follow": 2.3}
_NEAREST, _FARTHEST = 2.7, 9.0  # m, of the view of a whole course


class View(NamedTuple):
    """Camera position and the point that it looks at (3,) [m]."""

    position: Floats
    look_at: Floats


def check(name: str) -> Preset:
    """The preset called `name`.

    Raises:
        InputError: If there is none.
    """
    if name not in get_args(Preset):
        raise InputError(
            f"unknown camera {name!r}; there are: {', '.join(get_args(Preset))}", ("camera",)
        )
    return name  # type: ignore[return-value]


def view(name: Preset, robot: Floats) -> View:
    """The view of preset `name` on the robot at `robot` (3,)."""
    place = aim(robot)
    return View(place + _DISTANCE.get(name, _NEAREST) * _direction(name), place)


def aim(robot: Floats) -> Floats:
    """Where to look: a little ahead of the trunk and below it, for the course matters too."""
    place: Floats = robot + np.array([0.10, 0.0, -0.12])
    return place


def course_view(positions: Floats) -> View:
    """The ``iso`` view that holds a whole course of trunk points (n, 3)."""
    low, high = positions.min(axis=0), positions.max(axis=0)
    span = float(np.linalg.norm(high - low))
    middle = (low + high) / 2 + np.array([0.0, 0.0, -0.12])
    distance = float(np.clip(1.05 * span + 0.9, _NEAREST, _FARTHEST))
    return View(middle + distance * _direction("iso"), middle)


def _direction(name: Preset) -> Floats:
    direction = np.array(_DIRECTIONS[name])
    unit: Floats = direction / np.linalg.norm(direction)
    return unit
