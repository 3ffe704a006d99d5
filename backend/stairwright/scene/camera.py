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
_DISTANCE = {"iso": 2.7, "side": 2.4, "front": 2.1, "follow": 1.9}


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


def view(name: Preset, subject: Floats) -> View:
    """The view of preset `name` on the robot at `subject` (3,)."""
    direction = np.array(_DIRECTIONS[name])
    direction /= np.linalg.norm(direction)
    # A little ahead of the robot and below its trunk: the course matters as much as the robot.
    aim = subject + np.array([0.10, 0.0, -0.12])
    return View(aim + _DISTANCE[name] * direction, aim)
