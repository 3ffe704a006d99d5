"""The study document: what is fixed, what varies, and what is computed in each cell."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from stairwright.arguments import MOST_SEED
from stairwright.documents import Model, content_hash
from stairwright.errors import InputError
from stairwright.planning.plan import FacingChoice, Method, PlanTiming, usual_facing
from stairwright.planning.tolerance import Tolerance
from stairwright.robot.description import Robot
from stairwright.simulation.ranges import Ranges
from stairwright.sources import RobotSource, TerrainSource
from stairwright.terrain.generation import Friction, Name

from .axes import Axis

MOST_AXES = 8
MOST_CELLS = 10_000_000  # of one study: its states have to fit into memory
MOST_TRIALS = 10_000  # of one cell
Compute = Literal["plan", "rollout", "trials"]
Diagnose = Literal["all", "last", "none"]


SettingName = Annotated[str, Field(max_length=64, pattern=r"^[a-z0-9_]+$")]


class TrialSettings(Model):
    """How many randomised rollouts a cell has, and what they draw from."""

    count: int = Field(
        29, strict=True, ge=1, le=MOST_TRIALS, description="29 of 29: more than 90 % with 95 %"
    )
    ranges: Ranges | None = Field(None, description="of the deviations, see `sw.trials`")


class Study(Model):
    """A study (``stairwright/study/1``): every combination of the axes' values is a cell."""

    schema_: Literal["stairwright/study/1"] = Field("stairwright/study/1", alias="schema")
    name: str = Field("", max_length=100)
    description: str = Field("", max_length=2000)
    terrain: TerrainSource | None = Field(
        None, description="a name, a document, or a kind with measures; by the axes if empty"
    )
    robot: RobotSource = "a1_wheeled"
    robots: dict[Name, Robot] = Field(
        {}, max_length=64, description="documents of the robots that an axis `robot` names"
    )
    friction: Friction | None = Field(None, description="the terrain's own by default")
    method: Method = "path"
    weights: dict[SettingName, bool | float] = Field({}, max_length=32)
    timing: PlanTiming = Field("steady", description="of plans of the method path, as for a plan")
    facing: FacingChoice | None = Field(
        None, description="which end of the robot leads, as for a plan"
    )
    tolerance: Tolerance | None = Field(
        None, description="that plans of the method path shall stand; axes may vary it"
    )
    axes: list[Axis] = Field(min_length=1, max_length=MOST_AXES)
    compute: Compute = "plan"
    diagnose: Diagnose = Field(
        "all",
        description="of which cells without a way is found out what would open it, which takes "
        "most of their time: all, those at the last value of the boundary axis, or none",
    )
    controller: dict[SettingName, Any] = Field(
        {}, max_length=64, description="of rollouts and trials"
    )
    seed: int = Field(0, strict=True, ge=0, le=MOST_SEED - MOST_TRIALS)
    trials: TrialSettings = TrialSettings()

    @model_validator(mode="after")
    def _check_axes(self) -> Study:
        names = [axis.name for axis in self.axes]
        for i, name in enumerate(names):
            if name in names[:i]:
                raise InputError(f"there are two axes {name!r}", ("axes", i, "name"))
        bounds = [i for i, axis in enumerate(self.axes) if axis.boundary is not None]
        if len(bounds) > 1:
            raise InputError("only one axis may be a boundary", ("axes", bounds[1], "boundary"))
        return self

    @property
    def boundary_axis(self) -> Axis | None:
        """The axis that is searched instead of filled."""
        return next((axis for axis in self.axes if axis.boundary is not None), None)

    @property
    def grid_axes(self) -> list[Axis]:
        """The axes whose every value is asked about."""
        return [axis for axis in self.axes if axis.boundary is None]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each axis."""
        return tuple(len(axis.points) for axis in self.axes)

    @property
    def cells(self) -> int:
        """Number of cells, those included that a boundary leaves out."""
        return math.prod(self.shape)

    @property
    def effort(self) -> int:
        """Plans, rollouts or trials that this takes: what budgets count.

        Of a boundary, as many as bisection takes.
        """
        cells = self.cells
        if self.boundary_axis is not None:
            length = len(self.boundary_axis.points)
            cells = cells // length * min(length, 4 + length.bit_length())
        return cells * (self.trials.count if self.compute == "trials" else 1)

    @cached_property
    def family(self) -> str:
        """Hash of everything but texts and values of axes: studies that share cells share it."""
        data = self.model_dump(mode="json", exclude={"name", "description", "axes"})
        # The name of what was asked before there was a choice stays.
        if self.tolerance is None:
            data.pop("tolerance")
        if self.timing == "steady":
            data.pop("timing")
        data["facing"] = self.facing or usual_facing(self.timing)
        if data["facing"] == "forward":
            data.pop("facing")
        data["axes"] = [axis.name for axis in self.axes]
        if self.diagnose == "last" and self.boundary_axis is not None:
            data["diagnose"] = ["last", self.boundary_axis.points[-1]]
        if self.compute == "plan":
            for name in ("controller", "seed", "trials"):
                data.pop(name)
        elif self.compute == "rollout":
            data.pop("trials")
        return content_hash(data)


def check_budget(study: Study, budget: int, setting: str) -> None:
    """Refuse what is too much, before anything is made.

    Args:
        study: What is asked.
        budget: Plans, rollouts or trials that it may take.
        setting: What raises the budget.

    Raises:
        InputError: If it is too much.
    """
    if study.cells > MOST_CELLS:
        raise InputError(
            f"{study.cells:,} cells are more than {MOST_CELLS:,}; ask for fewer values, or for "
            "a larger tolerance",
            ("axes",),
        )
    if study.effort > budget:
        each = {"plan": "plans", "rollout": "rollouts", "trials": "trials"}[study.compute]
        raise InputError(
            f"{study.effort:,} {each} are more than the budget of {budget:,}; "
            f"ask for fewer values, or raise {setting}",
            ("axes",),
        )


def study_id(study: Study, engine: str) -> str:
    """Name of a study whose terrain and robots are documents, for one version of the planner."""
    axes = [axis.model_dump(mode="json") for axis in study.axes]
    return "s-" + content_hash([study.family, axes, engine]).removeprefix("sha256:")
