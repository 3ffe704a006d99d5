"""Ranges from which randomised trials draw their deviations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, model_validator

from stairwright.arguments import as_model
from stairwright.documents import Model, parse
from stairwright.errors import InputError

from .disturbance import Disturbance

Bound = Annotated[float, Field(ge=-5.0, le=5.0)]
Range = tuple[Bound, Bound]


class Ranges(Model):
    """Ranges (low, high) from which each trial draws its deviations; see `Disturbance`."""

    friction: Range = Field((-0.1, 0.1), description="added to the true friction")
    mass: Range = Field((-0.1, 0.1), description="share of the robot's mass, on the trunk")
    com_x: Range = Field((-0.02, 0.02), description="CoM forward [m]")
    com_z: Range = Field((-0.02, 0.02), description="CoM up [m]")
    height: Range = Field((-0.01, 0.01), description="added to the terrain's rise [m]")
    noise: Range = Field((1.0, 1.0), description="sensor noise, in units of the sensors' own")
    delay: Range = Field((0.004, 0.004), description="from sensing to torque [s]")

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


def parse_ranges(ranges: Mapping[str, Any] | Ranges | None) -> Ranges:
    """Ranges with defaults filled in.

    Raises:
        InputError: For an unknown name or a bad range.
    """
    return as_model(Ranges, ranges, "ranges")
