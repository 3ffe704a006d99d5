"""Generators of terrain as documents: a kind and its measures, checked before anything is made."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import AliasChoices, Discriminator, Field, Tag

from stairwright.arguments import MOST_FRICTION
from stairwright.documents import Model
from stairwright.errors import InputError

from . import stairs
from .profile import Terrain
from .stairs import Direction

Name = Annotated[str, Field(min_length=1, max_length=100, pattern=r"^[\w .+-]+$")]
Friction = Annotated[
    float, Field(strict=True, gt=0.0, le=MOST_FRICTION, description="Coulomb, wheel on terrain")
]
Length = Annotated[float, Field(strict=True, gt=0.0, le=100.0)]
Name100 = Annotated[Name | None, Field(description="made from the measures by default")]


class _Generated(Model):
    approach: Length = Field(1.5, description="level ground before it [m]")
    platform: Length = Field(2.0, description="level ground on top and after it [m]")
    direction: Direction = "up"
    name: Name100 = None
    friction: Friction = 0.6


class StairParameters(_Generated):
    """A flight of equal steps."""

    kind: Literal["stair"]
    rise: Length = Field(description="height of a step [m]")
    run: Length = Field(0.30, description="from edge to edge [m]")
    count: int = Field(
        1,
        strict=True,
        ge=1,
        le=200,
        validation_alias=AliasChoices("count", "steps"),
        description="of steps",
    )
    face_angle: float = Field(
        math.pi / 2,
        strict=True,
        gt=0.0,
        le=math.pi / 2,
        description="of the faces from the horizontal [rad]",
    )


class RampParameters(_Generated):
    """One inclined plane."""

    kind: Literal["ramp"]
    rise: Length = Field(
        validation_alias=AliasChoices("rise", "height"), description="height gained [m]"
    )
    slope: float = Field(
        strict=True,
        gt=0.0,
        lt=math.pi / 2,
        validation_alias=AliasChoices("slope", "angle"),
        description="from the horizontal [rad]",
    )


class FlatParameters(Model):
    """Level ground."""

    kind: Literal["flat"]
    length: Length = Field(4.0, description="[m]")
    name: Name = "flat"
    friction: Friction = 0.6


GENERATORS = ("stair", "ramp", "flat")


def _generator(value: Any) -> str | None:
    kind = value.get("kind") if isinstance(value, dict) else getattr(value, "kind", None)
    return f"~{kind}" if kind in GENERATORS else None


Generation = Annotated[
    Annotated[StairParameters, Tag("~stair")]
    | Annotated[RampParameters, Tag("~ramp")]
    | Annotated[FlatParameters, Tag("~flat")],
    Discriminator(
        _generator,
        custom_error_type="generator",
        custom_error_message="kind must be stair, ramp or flat",
        custom_error_context={"error": InputError("must be stair, ramp or flat", ("kind",))},
    ),
]


def generate(parameters: StairParameters | RampParameters | FlatParameters) -> Terrain:
    """The terrain of these measures.

    Raises:
        InputError: If they do not fit each other.
        ValidationError: If the terrain that they make is none.
    """
    make: Any = {"stair": stairs.stair, "ramp": stairs.ramp, "flat": stairs.flat}[parameters.kind]
    made: Terrain = make(**parameters.model_dump(exclude={"kind"}))
    return made
