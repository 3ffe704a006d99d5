"""Camera presets: where to stand to see a course and a robot."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError
from stairwright.terrain.profile import height_at

from .shapes import HALF_WIDTH

Preset = Literal["iso", "side", "front", "follow"]
FIELD_OF_VIEW = 0.62  # rad, vertical

# Unit directions from the subject to the camera, and distances in m.
_DIRECTIONS = {
    "iso": (-0.52, -0.88, 0.58),
    "side": (0.0, -1.0, 0.10),
    "front": (0.95, -0.32, 0.34),
    "follow": (-0.45, -0.92, 0.42),
}
# From where to follow, the usual first; where the ground hides the robot, rather from the side.
_FOLLOWING = (_DIRECTIONS["follow"], (-0.2, -1.0, 0.35), (0.0, -1.0, 0.25), _DIRECTIONS["side"])
_DISTANCE = {"side": 2.4, "front": 2.1, "follow": 2.3}
_ABOVE = 0.05  # m, of the camera over the lowest ground
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


def view(name: Preset, robot: Floats, direction: Floats | None = None) -> View:
    """The view of preset `name` on the robot at `robot` (3,), or from another unit `direction`."""
    place = aim(robot)
    towards = _direction(name) if direction is None else direction
    return View(place + _DISTANCE.get(name, _NEAREST) * towards, place)


def following_direction(course: Floats, ground: Floats) -> Floats:
    """From where to follow, as a unit vector (3,): where the ground hides the robot least.

    Args:
        course: (n, 3) trunk points [m].
        ground: (m, 2) the profile's corners [m].
    """
    directions = [_unit(each) for each in _FOLLOWING]
    return min(directions, key=lambda direction: _hidden(course, direction, ground))


def _hidden(course: Floats, direction: Floats, ground: Floats) -> int:
    """How many of the points (n, 3) the ground hides from a camera in `direction` (3,)."""
    beside = HALF_WIDTH / abs(direction[1])
    rays = course[:, None] + np.linspace(0.0, beside, 20)[:, None] * direction
    below = rays[..., 2].ravel() < height_at(ground, rays[..., 0].ravel())
    return int(below.reshape(rays.shape[:2]).any(axis=1).sum())


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


def keep_in_view(clients: Iterable[Any], robot: Floats) -> None:
    """Aim every viewer's camera at `robot` (3,) from where its user has turned it to."""
    place = aim(robot)
    for client in clients:
        # From the viewer's last report both points are equally old: their difference holds.
        _move(client, View(place + client.camera.position - client.camera.look_at, place))


def keep_above(client: Any, floor: float) -> None:
    """Lift a viewer's camera that went below the ground at height `floor` [m]; its aim stays."""
    place, aimed = np.array(client.camera.position), np.array(client.camera.look_at)
    if place[2] < floor + _ABOVE - 1e-3:  # the viewer reports it back in single precision
        place[2] = floor + _ABOVE
        _move(client, View(place, aimed))


def point(client: Any, view: View) -> None:
    """Give a viewer's camera a view."""
    with client.atomic():
        client.camera.fov = FIELD_OF_VIEW
        _move(client, view)


def _move(client: Any, view: View) -> None:
    with client.atomic():
        client.camera.position, client.camera.look_at = view.position, view.look_at


def _direction(name: Preset) -> Floats:
    return _unit(_DIRECTIONS[name])


def _unit(direction: tuple[float, float, float]) -> Floats:
    unit: Floats = np.array(direction) / np.linalg.norm(direction)
    return unit
