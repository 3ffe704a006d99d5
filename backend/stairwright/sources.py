"""What a question is about: a terrain or a robot by its name or as a whole document; a terrain also
as a kind with its measures.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Tag

from .documents import Model
from .robot.description import Robot
from .sent import without_readonly
from .terrain.generation import (
    GENERATORS,
    FlatParameters,
    Name,
    RampParameters,
    StairParameters,
    kind_of,
    kind_tag,
)
from .terrain.profile import Terrain

SentTerrain = Annotated[Terrain, BeforeValidator(without_readonly)]
SentRobot = Annotated[Robot, BeforeValidator(without_readonly)]


def _name_or_document(value: Any) -> str | None:
    if isinstance(value, str):
        return "~name"
    return "~document" if isinstance(value, (dict, Model)) else None


def _terrain_form(value: Any) -> str | None:
    return _name_or_document(value) if kind_of(value) is None else kind_tag(value)


# Tagged, or each bad value would be reported once for every form that it is not.
TerrainSource = Annotated[
    Annotated[Name, Tag("~name")]
    | Annotated[StairParameters, Tag("~stair")]
    | Annotated[RampParameters, Tag("~ramp")]
    | Annotated[FlatParameters, Tag("~flat")]
    | Annotated[SentTerrain, Tag("~document")],
    Discriminator(
        _terrain_form,
        custom_error_type="terrain",
        custom_error_message="must be a name, a whole document, or a kind "
        f"({', '.join(GENERATORS)}) with its measures",
    ),
]
RobotSource = Annotated[
    Annotated[Name, Tag("~name")] | Annotated[SentRobot, Tag("~document")],
    Discriminator(
        _name_or_document,
        custom_error_type="robot",
        custom_error_message="must be a name or a whole document",
    ),
]
