"""What clients send, typed and bounded. Field texts and examples go into OpenAPI."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, StrictBool, Tag

from stairwright.documents import Model
from stairwright.planning.plan import Method, Plan
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain


def _form(value: Any) -> str:
    return "~name" if isinstance(value, str) else "~document"


Name = Annotated[str, Field(min_length=1, max_length=100, pattern=r"^[\w .+-]+$")]
TerrainSource = Annotated[
    Annotated[Name, Tag("~name")] | Annotated[Terrain, Tag("~document")], Discriminator(_form)
]
RobotSource = Annotated[
    Annotated[Name, Tag("~name")] | Annotated[Robot, Tag("~document")], Discriminator(_form)
]
Friction = Annotated[float, Field(gt=0.0, le=5.0, description="Coulomb, wheel on terrain")]
SettingName = Annotated[str, Field(max_length=64, pattern=r"^[a-z0-9_]+$")]
Number = Annotated[float, Field(ge=-1e9, le=1e9)]
SettingValue = StrictBool | Number | Annotated[str, Field(max_length=64)]
Weights = Annotated[
    dict[SettingName, Number],
    Field(max_length=32, description="cost weights by name, see GET /settings"),
]
Controller = Annotated[
    dict[SettingName, SettingValue],
    Field(max_length=64, description="controller settings by name, see GET /settings"),
]
Id = Annotated[str, Field(min_length=1, max_length=64, pattern=r"^[a-z]-[0-9a-f]+$")]


class PlanRequest(Model):
    """A question to the planner."""

    model_config = {
        "json_schema_extra": {
            "examples": [
                {"terrain": "single-stair-036", "robot": "a1_wheeled", "method": "path"},
                {
                    "terrain": {"points": [[-1.5, 0], [0, 0], [0, 0.2], [2, 0.2]]},
                    "friction": 0.8,
                    "method": "critical",
                    "weights": {"com_x": 50.0},
                },
            ]
        }
    }

    terrain: TerrainSource = Field(description="a terrain's name or a terrain document")
    robot: RobotSource = Field("a1_wheeled", description="a robot's name or a robot document")
    friction: Friction | None = Field(None, description="the terrain's own by default")
    method: Method = "path"
    weights: Weights = {}


class RolloutRequest(Model):
    """A question to the simulator: a plan by its id or in full, or what to plan first."""

    model_config = {
        "json_schema_extra": {
            "examples": [
                {"terrain": "single-stair-030", "robot": "a1_wheeled_x", "seed": 1},
                {"plan_id": "p-0123456789abcdef", "friction": 0.5},
            ]
        }
    }

    plan_id: Id | None = Field(None, description="a plan that POST /plans answered with")
    plan: Plan | None = Field(None, description="a whole plan document")
    terrain: TerrainSource | None = Field(None, description="what to plan over first")
    robot: RobotSource = Field("a1_wheeled", description="with `terrain`")
    method: Method = Field("path", description="with `terrain`")
    weights: Weights = Field({}, description="with `terrain`")
    friction: Friction | None = Field(
        None, description="friction in the simulation (and of the plan, with `terrain`)"
    )
    controller: Controller = {}
    seed: int = Field(0, ge=0, le=2**31 - 1)


class TerrainDocument(Terrain):
    """A terrain, and whether it is one of the read-only presets."""

    readonly: bool = Field(description="a preset; it cannot be changed or deleted")


class SettingsDocument(Model):
    """JSON Schemas of everything that can be tuned; each property has bounds, unit and scale."""

    weights: dict[Method, dict[str, Any]]
    controller: dict[str, Any]


class Health(Model):
    """The service is ready."""

    status: Literal["ok"] = "ok"
    version: str
