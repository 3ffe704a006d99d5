"""Questions to planner and simulator, complete and checked: alike in content, alike in key."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar, Literal

from stairwright.documents import content_hash, parse
from stairwright.errors import InputError
from stairwright.planning.plan import FacingChoice, Method, Plan, PlanTiming, usual_facing
from stairwright.planning.tolerance import Tolerance, parse_tolerance
from stairwright.planning.weights import parse_weights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

SimulationKind = Literal["rollout", "trials", "margins"]


@dataclass(frozen=True)
class PlanQuestion:
    """Everything that a plan depends on."""

    terrain: Terrain
    robot: Robot
    friction: float
    method: Method
    weights: Mapping[str, float]
    timing: PlanTiming = "steady"
    tolerance: Tolerance | None = None
    facing: FacingChoice = "forward"

    @classmethod
    def of(
        cls,
        terrain: Terrain,
        robot: Robot,
        friction: float | None,
        method: Method,
        weights: Mapping[str, float] | None,
        timing: PlanTiming = "steady",
        tolerance: Mapping[str, float] | Tolerance | None = None,
        facing: FacingChoice | None = None,
    ) -> PlanQuestion:
        """Fill in defaults.

        Raises:
            InputError: If a weight or tolerance is unknown or out of bounds, or timing or tolerance
                are not the method's.
        """
        if timing == "fast" and method != "path":
            raise InputError("fast belongs to the method path", ("timing",))
        complete = parse_weights(method, weights).model_dump(mode="json")
        mu = terrain.friction if friction is None else friction
        stood = parse_tolerance(tolerance, method, mu)
        end = facing or usual_facing(timing)
        return cls(terrain, robot, mu, method, complete, timing, stood, end)

    @classmethod
    def restored(cls, data: Mapping[str, Any]) -> PlanQuestion:
        """The question that `data` was made from.

        Raises:
            InputError: If it was made by other code and is none any more.
        """
        terrain, robot = parse(Terrain, data["terrain"]), parse(Robot, data["robot"])
        timing = data.get("timing", "steady")
        asked = (data["friction"], data["method"], data["weights"], timing)
        return cls.of(terrain, robot, *asked, data.get("tolerance"), data.get("facing", "forward"))

    @cached_property
    def data(self) -> dict[str, Any]:
        """As plain data, for a worker."""
        data: dict[str, Any] = {
            "terrain": self.terrain.model_dump(mode="json"),
            "robot": self.robot.model_dump(mode="json"),
            "friction": self.friction,
            "method": self.method,
            "weights": dict(self.weights),
            "timing": self.timing,
        }
        if self.tolerance is not None:  # the key of what was asked before there was one stays
            data["tolerance"] = self.tolerance.asked
        if self.facing != "forward":
            data["facing"] = self.facing
        return data

    @cached_property
    def key(self) -> str:
        """Hash of the whole question, names and texts included."""
        return content_hash(self.data)


@dataclass(frozen=True)
class RolloutQuestion:
    """What to roll out and how: a stored plan (its digest), a whole plan, or one to be made."""

    kind: ClassVar[SimulationKind] = "rollout"
    runs: ClassVar[int] = 1  # of the simulator

    source: PlanQuestion | Plan | str
    friction: float | None
    controller: Mapping[str, Any]
    seed: int
    disturbance: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def restored(cls, data: Mapping[str, Any]) -> RolloutQuestion:
        """The question that `data` was made from; one of trials or margins where it asks for those.

        Raises:
            InputError: If it was made by other code and is none any more.
        """
        source: PlanQuestion | Plan | str
        try:
            if "ask" in data:
                source = PlanQuestion.restored(data["ask"])
            else:
                source = parse(Plan, data["plan"]) if "plan" in data else data["plan_digest"]
            asked = (source, data["friction"], data["controller"], data["seed"])
            if "count" in data:
                return TrialsQuestion(*asked, count=data["count"], ranges=data["ranges"])
            if "margins" in data:
                return MarginsQuestion(*asked)
            return cls(*asked, data.get("disturbance", {}))
        except KeyError as error:
            raise InputError("is missing", (str(error.args[0]),)) from None

    @cached_property
    def data(self) -> dict[str, Any]:
        """As plain data, for a worker."""
        data: dict[str, Any] = {
            "friction": self.friction,
            "controller": dict(self.controller),
            "seed": self.seed,
        }
        if self.disturbance:
            data["disturbance"] = dict(self.disturbance)
        if isinstance(self.source, PlanQuestion):
            return {**data, "ask": self.source.data}
        if isinstance(self.source, Plan):
            return {**data, "plan": self.source.model_dump(mode="json")}
        return {**data, "plan_digest": self.source}

    @cached_property
    def key(self) -> str:
        """Hash of the whole question."""
        return content_hash(self.data)

    @property
    def needs(self) -> str | None:
        """Digest of the stored plan that it refers to."""
        return self.source if isinstance(self.source, str) else None


@dataclass(frozen=True)
class TrialsQuestion(RolloutQuestion):
    """The same many times over, each with deviations drawn from ranges."""

    kind: ClassVar[SimulationKind] = "trials"
    count: int = 1
    ranges: Mapping[str, Any] = field(default_factory=dict)

    @property
    def runs(self) -> int:  # type: ignore[override]
        """Of the simulator."""
        return self.count

    @cached_property
    def data(self) -> dict[str, Any]:
        """As plain data, for a worker."""
        return {**super().data, "count": self.count, "ranges": dict(self.ranges)}


@dataclass(frozen=True)
class MarginsQuestion(RolloutQuestion):
    """How much delay the plan stands, and how much less friction."""

    kind: ClassVar[SimulationKind] = "margins"
    runs: ClassVar[int] = 25  # at most, see `simulation/robust_margins.py`

    @cached_property
    def data(self) -> dict[str, Any]:
        """As plain data, for a worker."""
        return {**super().data, "margins": True}
