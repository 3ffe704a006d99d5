"""Generators of terrain as documents: a kind and its measures, checked before anything is made."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import AliasChoices, Discriminator, Field, Tag, ValidationError

from stairwright.arguments import MOST_FRICTION
from stairwright.documents import Model, first_error, parse
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


Parameters = StairParameters | RampParameters | FlatParameters
GENERATORS: dict[str, type[Parameters]] = {
    "stair": StairParameters,
    "ramp": RampParameters,
    "flat": FlatParameters,
}


def kind_of(value: Any) -> Any:
    """What a document says that it is a kind of; None if it is no such document."""
    return value.get("kind") if isinstance(value, Mapping) else getattr(value, "kind", None)


def kind_tag(value: Any) -> str | None:
    """Pydantic's tag of it; None where there is no such kind."""
    kind = kind_of(value)
    return f"~{kind}" if isinstance(kind, str) and kind in GENERATORS else None


Generation = Annotated[
    Annotated[StairParameters, Tag("~stair")]
    | Annotated[RampParameters, Tag("~ramp")]
    | Annotated[FlatParameters, Tag("~flat")],
    Discriminator(
        kind_tag,
        custom_error_type="generator",
        custom_error_message="kind must be stair, ramp or flat",
        custom_error_context={"error": InputError("must be stair, ramp or flat", ("kind",))},
    ),
]


def generate(parameters: Parameters) -> Terrain:
    """The terrain of these measures.

    Raises:
        InputError: If they do not fit each other, or the terrain that they make is none.
    """
    make: Any = {"stair": stairs.stair, "ramp": stairs.ramp, "flat": stairs.flat}[parameters.kind]
    try:
        made: Terrain = make(**parameters.model_dump(exclude={"kind"}))
    except ValidationError as error:  # the measures are fine one by one, the terrain is not
        raise first_error(error, Terrain) from None
    return made


def terrain_in(document: Mapping[str, Any]) -> Terrain:
    """The terrain that a mapping is: a whole document, or a `kind` with its measures.

    Raises:
        InputError: If there is no such kind, or for the first bad value.
    """
    if "kind" not in document:
        return parse(Terrain, dict(document))
    model = GENERATORS.get(str(kind_of(document)))
    if model is None:
        raise InputError(f"must be one of: {', '.join(GENERATORS)}", ("kind",))
    return generate(parse(model, dict(document)))
