"""What clients send, typed and bounded. Field texts and examples go into OpenAPI."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, StrictBool, Tag

from stairwright.arguments import MOST_SEED
from stairwright.documents import Model
from stairwright.export.table import Kind as Exported
from stairwright.jobs.job import State
from stairwright.planning.plan import FacingChoice, Method, Plan, PlanTiming
from stairwright.planning.tolerance import Tolerance
from stairwright.robot.description import Robot
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.ranges import Ranges
from stairwright.simulation.trials_result import MOST_TRIALS
from stairwright.sources import RobotSource, TerrainSource
from stairwright.studies.axes import Number
from stairwright.studies.document import SettingName
from stairwright.terrain.generation import Friction
from stairwright.terrain.profile import Terrain


def _weight_form(value: Any) -> str:
    return "~flag" if isinstance(value, bool) else "~number"


def _setting_form(value: Any) -> str:
    return "~word" if isinstance(value, str) else _weight_form(value)


# Tagged, or each bad value would be reported once for every type that it is not.
Weight = Annotated[
    Annotated[StrictBool, Tag("~flag")] | Annotated[Number, Tag("~number")],
    Discriminator(_weight_form),
]
SettingValue = Annotated[
    Annotated[StrictBool, Tag("~flag")]
    | Annotated[Annotated[str, Field(max_length=64)], Tag("~word")]
    | Annotated[Number | None, Tag("~number")],
    Discriminator(_setting_form),
]
Weights = Annotated[dict[SettingName, Weight], Field(max_length=32)] | None
Controller = Annotated[dict[SettingName, SettingValue], Field(max_length=64)] | None
Id = Annotated[str, Field(min_length=1, max_length=64)]


TIMING = "fast: a path as fast as friction, torques and speeds allow, see `aggressiveness`"

FACING = (
    "which end of the robot leads, see `facing` of a plan; either: as the planner finds better, "
    "which is the default where `timing` is fast, else forward"
)

TOLERANCE = (
    "how far the world may be from what is drawn, with the certificate holding for all of it; of "
    "the method `path`"
)


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

    terrain: TerrainSource = Field(
        description="a terrain's name, a terrain document, or a kind with its measures"
    )
    robot: RobotSource = Field("a1_wheeled", description="a robot's name or a robot document")
    friction: Friction | None = Field(None, description="the terrain's own by default")
    method: Method = "path"
    weights: Weights = Field(None, description="cost weights by name, see GET /settings")
    timing: PlanTiming = Field("steady", description=TIMING)
    facing: FacingChoice | None = Field(None, description=FACING)
    tolerance: Tolerance | None = Field(None, description=TOLERANCE)


class Simulation(Model):
    """A plan by its id or in full, or what to plan first; and how to carry it out."""

    plan_id: Id | None = Field(None, description="a plan that POST /plans answered with")
    plan: Plan | None = Field(None, description="a whole plan document")
    terrain: TerrainSource | None = Field(None, description="what to plan over first")
    robot: RobotSource = Field("a1_wheeled", description="with `terrain`")
    method: Method = Field("path", description="with `terrain`")
    weights: Weights = Field(None, description="with `terrain`")
    timing: PlanTiming = Field("steady", description="with `terrain`")
    facing: FacingChoice | None = Field(None, description="with `terrain`")
    tolerance: Tolerance | None = Field(None, description="with `terrain`")
    friction: Friction | None = Field(
        None, description="friction in the simulation (and of the plan, with `terrain`)"
    )
    controller: Controller = Field(
        None, description="controller settings by name, see GET /settings"
    )
    seed: int = Field(0, strict=True, ge=0, le=MOST_SEED)


class RolloutRequest(Simulation):
    """A question to the simulator."""

    model_config = {
        "json_schema_extra": {
            "examples": [
                {"terrain": "single-stair-030", "robot": "a1_wheeled_x", "seed": 1},
                {"plan_id": "p-0123456789abcdef", "friction": 0.5},
            ]
        }
    }

    disturbance: Disturbance | None = Field(
        None, description="how the real world differs from what plan and controller believe"
    )


class TrialsRequest(Simulation):
    """The same question many times over, under random deviations."""

    model_config = {
        "json_schema_extra": {
            "examples": [{"terrain": "single-stair-030", "count": 29, "bundle": "laboratory"}]
        }
    }

    count: int = Field(29, strict=True, ge=1, le=1000, description="number of rollouts")
    bundle: str | None = Field(None, max_length=40, description="of deviations, see GET /settings")
    ranges: Ranges | None = Field(None, description="deviations in full, instead of a bundle")
    seed: int = Field(0, strict=True, ge=0, le=MOST_SEED - MOST_TRIALS)


class TerrainDocument(Terrain):
    """A terrain, and whether it is one of the read-only presets."""

    readonly: bool = Field(description="a preset; it cannot be changed or deleted")


class RobotDocument(Robot):
    """A robot, whether it is one of the read-only presets, and which version of it this is."""

    readonly: bool = Field(description="a preset; it cannot be changed or deleted")
    version: str = Field(description="hash of its content, as in plans' `robot_hash`")


class ExportFormat(Model):
    """A format of files."""

    name: str
    note: str = Field(description="what it is for, in a few words")


class SettingsDocument(Model):
    """JSON Schemas of everything that can be tuned; each property has bounds, unit and scale."""

    weights: dict[Method, dict[str, Any]]
    tolerance: dict[str, Any]
    controller: dict[str, Any]
    disturbance: dict[str, Any]
    bundles: dict[str, Ranges] = Field(description="deviations that trials draw from, by name")
    exports: dict[Exported, list[ExportFormat]]


class StoredEntry(Model):
    """A stored plan, rollout or set of trials in a list."""

    id: str
    digest: str = Field(description="SHA-256 of its JSON")
    created: float = Field(description="seconds since 1970")
    name: str = Field(description="the user's own; empty if there is none")
    note: str = Field(description="the user's own")
    pinned: bool = Field(description="stays when room is made for newer results")
    summary: dict[str, Any] = Field(
        description="what it was asked, as far as that differs from the defaults, and its figures"
    )


class EntryChanges(Model):
    """What to change in what is noted about a stored result; what is left out stays."""

    model_config = {"json_schema_extra": {"examples": [{"name": "before the fix", "pinned": True}]}}

    name: str | None = Field(None, max_length=100)
    note: str | None = Field(None, max_length=2000)
    pinned: StrictBool | None = Field(None, description="stays when room is made")


class JobDocument(Model):
    """A job's state."""

    id: str
    kind: Literal["rollout", "trials", "margins"]
    state: State
    progress: float = Field(ge=0.0, le=1.0)
    created: float = Field(description="seconds since 1970")
    eta: float | None = Field(
        description="seconds until it is done, waiting included, as far as known"
    )
    result: str | None = Field(description="where the result is, when done")
    error: dict[str, Any] | None = Field(description="a problem document, when failed")
    links: dict[str, str]


class SessionDocument(Model):
    """A 3D scene of one browser session."""

    id: str
    scene: str = Field(description="path of the scene's page")


class SceneRequest(Model):
    """What the scene shows; what is left out stays, null shows none."""

    plan_id: Id | None = None
    rollout_id: Id | None = None
    compare_plan_id: Id | None = Field(
        None, description="a second plan, whose robot is shown translucent at the same place"
    )
    theme: Literal["dark", "light"] | None = None
    layers: Annotated[dict[SettingName, StrictBool], Field(max_length=32)] | None = None
    camera: Literal["side", "iso", "front", "follow"] | None = None


class PlaybackRequest(Model):
    """The scene's clock; what is left out stays."""

    time: float | None = Field(None, strict=True, ge=0.0, le=1e6, description="[s]")
    progress: float | None = Field(
        None, strict=True, ge=-1e3, le=1e3, description="[m] along the course"
    )
    playing: StrictBool | None = None
    speed: float | None = Field(
        None, strict=True, gt=0.0, le=20.0, description="factor on real time"
    )


class Health(Model):
    """The service is ready."""

    status: Literal["ok"] = "ok"
    version: str
    read_only: str | None = Field(
        default=None, description="why nothing is saved and what to do, if nothing is"
    )
