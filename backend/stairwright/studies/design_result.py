"""What came of a design study: every design that was tried, and which no other beats."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import ConfigDict, Field

from stairwright.documents import Model
from stairwright.errors import InputError
from stairwright.robot.description import Robot

from .design_document import Aim, Design


class Candidate(Model):
    """One design that was tried."""

    values: dict[str, float] = Field(description="of what varies")
    aims: dict[str, float | None] = Field(description="None where it does not pass")
    passed: bool
    reason: str = Field("", description="why it does not pass")
    best: bool = Field(False, description="no other one is as good in all aims, better in one")
    robot: Robot | None = Field(None, description="of the best ones")


class DesignResult(Model):
    """The outcome (``stairwright/design-result/1``).

    A service's answer tells more, of the search's state: what is read from it leaves that out.
    """

    model_config = ConfigDict(extra="ignore")

    schema_: Literal["stairwright/design-result/1"] = Field(
        "stairwright/design-result/1", alias="schema"
    )
    id: str
    design: Design
    complete: bool
    candidates: list[Candidate]

    @property
    def front(self) -> list[Candidate]:
        """The best ones, by their first aim."""
        first = self.design.aims[0].name
        found = [each for each in self.candidates if each.best]
        return sorted(found, key=lambda each: each.aims[first] or 0.0)

    def save(self, path: str | Path) -> None:
        """Write it as JSON.

        Raises:
            InputError: If the ending is another, or the place cannot be written.
        """
        chosen = Path(path)
        if chosen.suffix.lower() != ".json":
            raise InputError(f"cannot write {chosen.name!r}; the ending is .json")
        try:
            chosen.write_text(self.model_dump_json(indent=1), encoding="utf-8")
        except OSError as error:
            raise InputError(f"cannot write {chosen}: {error.strerror or error}") from None


def with_best(aims: list[Aim], tried: list[Candidate]) -> list[Candidate]:
    """The candidates, those marked that no other beats (Pareto); only they keep their robots."""
    signs = np.array([1.0 if aim.direction == "minimize" else -1.0 for aim in aims])
    passed = [each for each in tried if each.passed]
    costs = np.array([[each.aims[aim.name] for aim in aims] for each in passed], float)
    costs = costs.reshape(-1, len(aims)) * signs
    best = {
        id(each)
        for each, mine in zip(passed, costs, strict=True)
        if not np.any((costs <= mine).all(axis=1) & (costs < mine).any(axis=1))
    }
    return [
        each.model_copy(
            update={"best": id(each) in best, "robot": each.robot if id(each) in best else None}
        )
        for each in tried
    ]
