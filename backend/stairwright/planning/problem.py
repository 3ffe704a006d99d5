"""What stops the robot: the sentence, the place and the amount are made from the same numbers."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from stairwright.documents import Model
from stairwright.robot.turning import Facing

Vector2 = tuple[float, float]
ProblemKind = Literal["reach", "clearance", "statics", "torque", "joint_limit", "start", "goal"]


class Limit(Model):
    """The quantity that is missing: what would be needed, and what there is."""

    needed: float
    available: float
    quantity: str = ""
    unit: str = ""
    given: dict[str, float] = Field({}, description="values of what else must change with it")
    confirmed: tuple[float, float] | None = Field(
        None,
        description="values asked of all of planning: with the first there is no plan, with the "
        "second there is one, with everything else as it is",
    )

    def __str__(self) -> str:
        bound = "of at most " if self.needed < self.available else ""
        given = "".join(f" with {name} {value:.2g}" for name, value in self.given.items())
        needed, available = map(self._amount, (self.needed, self.available))
        return f"needs {self.quantity} {bound}{needed}{given}, has {available}"

    def _amount(self, value: float) -> str:
        if self.unit == "m":
            return f"{round(value, 3):g} m"
        return f"{value:.3g}" + (f" {self.unit}" if self.unit not in ("", "1") else "")


class Problem(Model):
    """What stops the robot, where, and by how much."""

    kind: ProblemKind
    at: Vector2 = Field(description="place on the terrain [m]")
    progress: float = Field(description="how far the plan gets [m]")
    message: str
    limit: Limit | None = None
    feasible_facing: Facing | None = Field(
        None,
        description="the `facing` that has a plan, where the one asked for has none",
    )

    @classmethod
    def told(
        cls, kind: ProblemKind, at: tuple[float, float], progress: float, what: str,
        limit: Limit | None = None,
    ) -> Problem:  # fmt: skip
        """A problem whose message tells by how much, `what` happens, and where."""
        lack = "" if limit is None else f"{limit}: "
        message = f"{lack}{what} at x = {at[0]:.2f} m, z = {at[1]:.2f} m"
        return cls(kind=kind, at=at, progress=progress, message=message, limit=limit)

    def but_facing(self, facing: Facing) -> Problem:
        """The same one, telling that with the robot's other end in front there is a plan."""
        end = "rear" if facing == "backward" else "front"
        message = f"{self.message}; there is a plan {end} first (facing {facing})"
        return self.model_copy(update={"message": message, "feasible_facing": facing})


def between_poses(
    kind: ProblemKind, at: tuple[float, float], progress: float, before: int, what: str
) -> Problem:
    """What stops the motion from pose `before`, counted from 1, to the next."""
    what = f"only the poses are certified: between poses {before} and {before + 1} {what},"
    return Problem.told(kind, at, progress, what)
