"""How fast a rollout crosses what is not level: first contact with the first face to all wheels on
the landing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from stairwright.arrays import Flags, Floats
from stairwright.robot.description import Robot
from stairwright.robot.kinematics import forward
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

from .result import Series

LEVEL = 1e-6  # m that a wheel's centre may be off the height of the start or of the landing
TOUCH = 0.002  # m: tyres and contacts give way
_STEP = 0.001  # m between the samples of the wheel-centre curve
_SIDES = ([0, 1, 6, 7], [3, 4, 9, 10])  # thighs and calves among the joints, left and right


def speed_over_faces(series: Series, terrain: Terrain, robot: Robot) -> float | None:
    """Mean speed of the wheels along their way [m/s] while they cross the faces of `terrain`.

    The way is the arc length of the wheel-centre curve, up and down faces too, as in `speed_mean`
    and in the cost of transport; along x a wall would be crossed at no speed at all. It lasts from
    the moment in which the first wheel reaches the first face to that in which the last one is
    past the last of them. None where the ground is level or the robot does not get past.
    """
    curve = _Curve.of(terrain, robot.wheel.radius)
    span = curve.faces_span()
    if span is None or len(series) < 2:
        return None
    x, z = series.base_position[:, 0], series.base_position[:, 2]
    sides = [forward(robot, x, z, series.pitch, series.q[:, side]).wheels for side in _SIDES]
    wheels = np.concatenate([wheels[..., 0] for wheels in sides], axis=-1)
    begun = _first(wheels.max(axis=1) >= span[0] - TOUCH)
    ended = _first(wheels.min(axis=1) >= span[1] - TOUCH)
    if begun is None or ended is None or ended <= begun:
        return None
    # Before the first face and past the last one, x tells the place on the curve.
    way = np.interp(wheels[ended], curve.x, curve.s) - np.interp(wheels[begun], curve.x, curve.s)
    return float(way.mean() / (series.time[ended] - series.time[begun]))


@dataclass(frozen=True)
class _Curve:
    """Samples of the wheel-centre curve: arc length, x and z (n,) [m]."""

    s: Floats
    x: Floats
    z: Floats

    @classmethod
    def of(cls, terrain: Terrain, radius: float) -> Self:
        path = wheel_path(terrain, radius)
        s = np.arange(0.0, path.length + _STEP, _STEP)
        return cls(s, *path.centres(s).T)

    def faces_span(self) -> tuple[float, float] | None:
        """Where a wheel's centre leaves the level of the start, and where it has reached that of
        the landing, along x [m]; None on level ground.
        """
        off = np.flatnonzero(np.abs(self.z - self.z[0]) > LEVEL)
        if not len(off):
            return None
        below = np.flatnonzero(np.abs(self.z - self.z[-1]) > LEVEL)
        return float(self.x[off[0]]), float(self.x[below[-1]])


def _first(true: Flags) -> int | None:
    places = np.flatnonzero(true)
    return int(places[0]) if len(places) else None
