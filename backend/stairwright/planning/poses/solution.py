"""What any solver of the pose problem answers."""

from __future__ import annotations

from dataclasses import dataclass

from stairwright import _core
from stairwright.arrays import Floats


@dataclass(frozen=True)
class Solution:
    """A solved pose: variables (9,), cost, and by how much the worst constraint is violated."""

    x: Floats
    cost: float
    violation: float
    solver: str

    @property
    def solved(self) -> bool:
        """Whether all constraints hold."""
        return self.violation <= _core.SOLVED
