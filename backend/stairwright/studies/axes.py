"""The axes of a study: which quantity varies, and over which values."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from stairwright.documents import Model
from stairwright.errors import InputError

MOST_VALUES = 10_000  # of one axis
_DIGITS = 12  # decimals of values between two ends: 0.3 is 0.3 on a longer axis too

Value = float | str


def _form(value: Any) -> str:
    return "~word" if isinstance(value, str) else "~number"


Number = Annotated[float, Field(strict=True, ge=-1e9, le=1e9)]
_Value = Annotated[
    Annotated[Annotated[str, Field(min_length=1, max_length=100)], Tag("~word")]
    | Annotated[Number, Tag("~number")],
    Discriminator(_form),
]


class Axis(Model):
    """One axis: `values`, or `from`, `to` and `count`, or `boundary` and `tolerance`.

    A boundary axis is searched for where the outcome changes instead of filled: by bisection over
    the values that divide its range into equal parts of at most `tolerance`.
    """

    name: str = Field(
        min_length=1,
        max_length=100,
        description="what varies: stairs.rise, stairs.run, step.height, ramp.slope, friction, "
        "payload, speed, weights.NAME, robot, or a number of the robot's file as robot.calf.length",
    )
    values: list[_Value] | None = Field(None, min_length=1, max_length=MOST_VALUES)
    from_: Number | None = Field(None, alias="from")
    to: Number | None = None
    count: int | None = Field(None, strict=True, ge=1, le=MOST_VALUES)
    boundary: tuple[Number, Number] | None = Field(
        None, description="range in which the outcome changes once"
    )
    tolerance: float | None = Field(
        None, strict=True, gt=0.0, le=1e9, description="of the place where it changes"
    )

    @model_validator(mode="after")
    def _check_form(self) -> Axis:
        forms = {
            "values": self.values is not None,
            "from": any(each is not None for each in (self.from_, self.to, self.count)),
            "boundary": self.boundary is not None or self.tolerance is not None,
        }
        given = [name for name, there in forms.items() if there]
        if len(given) != 1:
            raise InputError(
                "give either values, or from, to and count, or boundary and tolerance",
                (given[1],) if given else ("values",),
            )
        if self.values is not None:
            self._check_values(self.values)
        elif self.boundary is not None or self.tolerance is not None:
            self._check_boundary()
        else:
            self._check_range()
        return self

    def _check_values(self, values: list[Value]) -> None:
        if len({type(value) for value in values}) > 1:
            raise InputError("must be all numbers or all words", ("values",))
        if len(set(values)) < len(values):
            raise InputError("each value may be there once", ("values",))

    def _check_range(self) -> None:
        for name, value in (("from", self.from_), ("to", self.to), ("count", self.count)):
            if value is None:
                raise InputError("Field required: from, to and count go together", (name,))
        if self.count == 1 and self.from_ != self.to:
            raise InputError("must be at least 2 between two different ends", ("count",))
        if self.count != 1 and self.from_ == self.to:
            raise InputError("must differ from `from`", ("to",))

    def _check_boundary(self) -> None:
        if self.boundary is None or self.tolerance is None:
            missing = "boundary" if self.boundary is None else "tolerance"
            raise InputError("Field required: boundary and tolerance go together", (missing,))
        low, high = self.boundary
        if low >= high:
            raise InputError(f"the low end {low:g} must lie below the high end {high:g}",
                             ("boundary",))  # fmt: skip
        if (high - low) / self.tolerance > MOST_VALUES:
            raise InputError(
                f"divides the range into more than {MOST_VALUES:,} parts", ("tolerance",)
            )

    @cached_property
    def points(self) -> tuple[Value, ...]:
        """All values, in order; of a boundary axis those that may be asked about."""
        if self.values is not None:
            return tuple(self.values)
        if self.boundary is not None:
            assert self.tolerance is not None
            low, high = self.boundary
            parts = max(1, math.ceil((high - low) / self.tolerance - 1e-9))
            ends, count = (low, high), parts + 1
        else:
            assert self.from_ is not None
            assert self.to is not None
            assert self.count is not None
            ends, count = (self.from_, self.to), self.count
        return tuple(round(float(value), _DIGITS) for value in np.linspace(*ends, count))

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers."""
        return not isinstance(self.points[0], str)
