"""What a study tells of each cell: names, types and units of the variables of its dataset."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

Kind = Literal["number", "flag", "count", "word"]
Record = dict[str, Any]  # of one cell: variable to value

PENDING, DONE, REFUSED, FAILED = 0, 1, 2, 3


@dataclass(frozen=True)
class Variable:
    """One variable over all cells.

    Attributes:
        kind: number (NaN: none), flag (false: none), count (0: none) or word ("" : none).
        unit: Of numbers; 1 for ratios.
        text: What it is, in a few words.
        length: Of words, at most.
    """

    kind: Kind
    text: str
    unit: str = "1"
    length: int = 0

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of the array."""
        if self.kind == "word":
            return np.dtype(f"<U{self.length}")
        return np.dtype({"number": "f8", "flag": "?", "count": "i4"}[self.kind])

    @property
    def missing(self) -> Any:
        """The value of cells that have none."""
        return {"number": np.nan, "flag": False, "count": 0, "word": ""}[self.kind]

    def is_missing(self, value: Any) -> bool:
        """Whether this is how none is stored."""
        return bool(value != value or value == self.missing)  # NaN differs from itself

    def fitted(self, value: Any) -> Any:
        """`value` as it is stored; None for none."""
        if value is None:
            return self.missing
        return value[: self.length] if self.kind == "word" else value


VARIABLES: Mapping[str, Variable] = {
    "state": Variable("count", "0 pending, 1 done, 2 refused (no question), 3 failed"),
    "feasible": Variable("flag", "the planner found a certified plan"),
    "reason": Variable("word", "what stops the robot, empty if nothing does", length=16),
    "message": Variable("word", "the same in one sentence, with numbers", length=240),
    "quantity": Variable("word", "of which more, or less, is needed", length=32),
    "needed": Variable("number", "of that quantity, in its own unit", "1"),
    "available": Variable("number", "of that quantity, in its own unit", "1"),
    "least_friction": Variable(
        "number", "least friction that would do: that this plan needs, or that the diagnosis names"
    ),
    "margin_clearance": Variable("number", "least distance of trunk and links from terrain", "m"),
    "margin_com": Variable("number", "least shift of the CoM in x that tips the robot", "m"),
    "margin_friction": Variable("number", "friction there is minus the most that is needed"),
    "margin_torque": Variable("number", "leg motors' limit minus the largest static torque", "Nm"),
    "margin_wheel_torque": Variable("number", "the same of the wheel motors", "Nm"),
    "margin_joint_limit": Variable("number", "least distance of a joint from its limits", "rad"),
    "binding": Variable("word", "the margin that is least, as a share of what there is", length=16),
    "duration": Variable("number", "planned time; simulated time of rollouts", "s"),
    "speed": Variable("number", "mean speed along the way, planned or simulated", "m/s"),
    "energy": Variable("number", "of the rollout: integral of |torque x speed|", "J"),
    "cost_of_transport": Variable("number", "of the rollout: energy per weight and way"),
    "success": Variable("count", "rollouts or trials that succeeded"),
    "trials": Variable("count", "rollouts or trials that were made"),
    "success_low": Variable("number", "lower end of the rate's 95 % interval (Clopper-Pearson)"),
    "success_high": Variable("number", "upper end of the rate's 95 % interval (Clopper-Pearson)"),
    "outcome": Variable("word", "of the rollout, or the commonest failure of trials", length=16),
    "plan_id": Variable("word", "the id that POST /plans gives this cell's plan", length=32),
}
"""In the order in which they are listed."""


def complete(record: Mapping[str, Any]) -> Record:
    """All variables of a cell, as they are stored."""
    return {name: each.fitted(record.get(name)) for name, each in VARIABLES.items()}
