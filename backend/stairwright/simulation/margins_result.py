"""The document of what delay and loss of friction a plan stands."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from stairwright.control.settings import StoredSettings
from stairwright.documents import Model


class RobustMargins(Model):
    """What a plan stands in simulation (``stairwright/margins/1``)."""

    schema_: Literal["stairwright/margins/1"] = Field("stairwright/margins/1", alias="schema")
    id: str = Field(description="hash of the question")
    plan_id: str
    terrain_hash: str
    robot_hash: str
    controller: StoredSettings
    seed: int
    delay: float | None = Field(
        description="of the loop, up to which it succeeds; none if not even without [s]"
    )
    friction: float | None = Field(description="less than planned, up to which it succeeds")
    delay_ends: str = Field(description="what happens beyond; empty if nothing was tried there")
    friction_ends: str = Field(description="what happens beyond; empty if nothing was tried there")
