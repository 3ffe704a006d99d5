"""The document of randomised trials: how often a plan succeeds, and each trial with its reason."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from stairwright.control.settings import StoredSettings
from stairwright.documents import Model

from .disturbance import Disturbance
from .ranges import Ranges
from .result import Outcome

MOST_TRIALS = 100_000


class Trial(Model):
    """One rollout of the set."""

    seed: int
    disturbance: Disturbance
    outcome: Outcome
    reason: str
    pitch_error_max: float
    link_contacts: int


class Trials(Model):
    """A set of randomised rollouts (``stairwright/trials/1``)."""

    schema_: Literal["stairwright/trials/1"] = Field("stairwright/trials/1", alias="schema")
    id: str = Field(description="hash of the question")
    plan_id: str
    terrain_hash: str
    robot_hash: str
    friction: float = Field(description="nominal true friction; each trial adds its own")
    seed: int
    controller: StoredSettings
    ranges: Ranges
    count: int
    successes: int
    rate: float = Field(description="share of successes")
    wilson: tuple[float, float] = Field(description="95 % confidence interval of the rate")
    clopper_pearson: tuple[float, float] = Field(description="95 % interval, exact")
    outcomes: dict[str, int]
    suspects: dict[str, float] = Field(
        {},
        description="deviations that are larger where trials failed: how often a failed one had "
        "more of it than one that succeeded",
    )
    trials: list[Trial]
