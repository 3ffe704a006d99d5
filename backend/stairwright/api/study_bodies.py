"""What clients are told of studies and of searches for designs."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from stairwright.documents import Model
from stairwright.jobs.job import State
from stairwright.studies.design_result import DesignResult
from stairwright.studies.design_shelf import DesignSummary


class AxisDocument(Model):
    """An axis of a study."""

    name: str
    unit: str = Field(description="of the values; 1 for ratios and words")
    values: list[float | str] = Field(description="all of them, in order")
    boundary: bool = Field(description="searched for where the outcome changes, not filled")


class StudyDocument(Model):
    """A study's state. Events leave the axes out."""

    id: str
    name: str
    state: State
    done: int = Field(description="cells that are known")
    total: int = Field(description="cells that are to be known, as far as can be told")
    progress: float = Field(ge=0.0, le=1.0)
    eta: float | None = Field(description="seconds until it is done, by its own pace so far")
    stage: str = Field(description="what is done before its first cells; empty from then on")
    created: float = Field(description="seconds since 1970")
    outdated: bool = Field(description="by another version of the planner than this service's")
    error: dict[str, Any] | None = Field(description="a problem document, when failed")
    axes: list[AxisDocument]
    compute: Literal["plan", "rollout", "trials"]
    links: dict[str, str]


class CellDocument(Model):
    """One cell of a study."""

    cell: int
    values: dict[str, float | str] = Field(description="of the axes, by name")
    plan: dict[str, Any] | None = Field(
        description="body of POST /plans for this cell; null where its values make no question"
    )
    record: dict[str, Any] = Field(description="the variables of the dataset")


class SearchState(Model):
    """How far a search is."""

    state: State | None = Field(
        description="null where `stairwright design` is at it, or was: this service does not know"
    )
    progress: float = Field(ge=0.0, le=1.0)
    eta: float | None = Field(description="seconds until it is done, by its own pace so far")
    stage: str = Field(description="what is done before its first designs; empty from then on")
    outdated: bool = Field(description="by another version of the planner than this service's")
    error: dict[str, Any] | None = Field(description="a problem document, when failed")
    links: dict[str, str]


class DesignDocument(DesignSummary, SearchState):
    """A search in a list, and how far it is."""


class DesignAnswer(DesignResult, SearchState):
    """What a search has found, as `stairwright design -o` writes it, and how far it is."""
