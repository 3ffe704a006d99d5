"""How far trials deviate from what the plan believes: ranges, and named bundles of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import Field, model_validator

from stairwright.arguments import as_model
from stairwright.documents import Model, parse
from stairwright.errors import InputError

from .disturbance import Disturbance

Bound = Annotated[float, Field(ge=-5.0, le=500.0)]
Range = tuple[Bound, Bound]

_DEGREE = math.pi / 180
_UNIFORM = 1 / math.sqrt(3)  # standard deviation of what is uniform, by its limit
_FIRST = 7  # fields from friction to delay


def _none(text: str) -> Any:
    return Field((0.0, 0.0), description=text)


class Ranges(Model):
    """Ranges (low, high) from which each trial draws its deviations; see `Disturbance`."""

    friction: Range = Field((-0.1, 0.1), description="added to the true friction")
    mass: Range = Field((-0.1, 0.1), description="share of the robot's mass, on the trunk")
    com_x: Range = Field((-0.02, 0.02), description="CoM forward [m]")
    com_z: Range = Field((-0.02, 0.02), description="CoM up [m]")
    height: Range = Field((-0.01, 0.01), description="added to the terrain's rise [m]")
    noise: Range = Field((1.0, 1.0), description="sensor noise, in units of the sensors' own")
    delay: Range = Field((0.004, 0.004), description="from sensing to torque [s]")

    friction_front: Range = _none("added to that, at the front wheels")
    friction_rear: Range = _none("added to that, at the rear wheels")
    payload: Range = _none("on top of the trunk's middle [kg]")
    step_height_error: Range = _none("of each rise or descent, standard deviation [m]")
    face_place_error: Range = _none("of each face's place, standard deviation [m]")
    heading: Range = _none("the robot starts turned to the left of the course [rad]")
    cross_slope: Range = _none("the terrain rises to the left [rad]")
    x_offset: Range = _none("the robot believes to start farther ahead than it does [m]")
    odometry_scale: Range = _none("share by which a way seems longer than it is")
    pitch_bias: Range = _none("the IMU is mounted pitched [rad]")
    bandwidth: Range = _none("of the torques [Hz]; 0: they act at once")
    torque_scale: Range = _none("share by which motors give more than asked for")
    stiction: Range = _none("dry friction of each leg joint and wheel [Nm]")

    @model_validator(mode="after")
    def _check_order(self) -> Ranges:
        for name in type(self).model_fields:
            low, high = getattr(self, name)
            if low > high:
                raise InputError(f"the low end {low:g} lies above the high end {high:g}", (name,))
            for end in (low, high):
                try:
                    parse(Disturbance, {name: end})
                except InputError as error:
                    raise InputError(error.message, (name,)) from None
        return self


def _bundle(start: float, delay: float, bandwidth: float, steps: float, turn: float) -> Ranges:
    """Deviations around none: place of the start [m], loop, steps [m], heading [degrees]."""
    tilt, steps = turn / 3 * _DEGREE, steps * _UNIFORM
    return Ranges(
        friction=(-0.05, 0.05),
        mass=(-0.05, 0.05),
        com_x=(-0.005, 0.005),
        com_z=(-0.005, 0.005),
        height=(0.0, 0.0),
        delay=(delay, delay),
        step_height_error=(steps, steps),
        heading=(-turn * _DEGREE, turn * _DEGREE),
        cross_slope=(-tilt, tilt),
        x_offset=(-start, start),
        odometry_scale=(-start, start),
        pitch_bias=(-tilt, tilt),
        bandwidth=(bandwidth, bandwidth),
    )


# What trials can be asked for by name.
BUNDLES = {
    "usual": Ranges(),
    "laboratory": _bundle(0.01, 0.006, 40.0, 0.005, 1.5),
    "field": _bundle(0.02, 0.008, 25.0, 0.015, 3.0).model_copy(
        update={"face_place_error": (0.03 * _UNIFORM, 0.03 * _UNIFORM)}
    ),
}


def chosen_ranges(
    ranges: Mapping[str, Any] | Ranges | None = None, bundle: str | None = None
) -> Ranges:
    """Ranges with defaults filled in, or those of a bundle.

    Raises:
        InputError: For an unknown name, a bad range, or where both are given.
    """
    if bundle is None:
        return as_model(Ranges, ranges, "ranges")
    if ranges is not None:
        raise InputError("is instead of ranges: give one of them", ("bundle",))
    if bundle not in BUNDLES:
        raise InputError(f"must be one of: {', '.join(BUNDLES)}", ("bundle",))
    return BUNDLES[bundle]


def draw(ranges: Ranges, n: int, seed: int) -> list[Disturbance]:
    """`n` deviations, each uniform in its range."""
    names = list(Ranges.model_fields)
    low, high = np.array([getattr(ranges, name) for name in names]).T
    # The first ones have had their own numbers before there were others.
    parts = [slice(0, _FIRST), slice(_FIRST, len(names))]
    rows = np.hstack(
        [
            np.random.default_rng([seed, k] if k else seed).uniform(
                low[part], high[part], (n, len(low[part]))
            )
            for k, part in enumerate(parts)
        ]
    )
    return [Disturbance(**dict(zip(names, map(float, row), strict=True))) for row in rows]
