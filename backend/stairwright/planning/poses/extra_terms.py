"""Cost terms and constraints that users add to the paper's pose optimisation, in CasADi."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca

from stairwright.errors import InputError
from stairwright.robot.symbolic import Point, Skeleton


@dataclass(frozen=True)
class SymbolicPose:
    """A pose in CasADi scalars: metres and radians, world frame, pitch positive nose down.

    Attributes:
        x, z, pitch: Of the trunk.
        q: Joints: front thigh, front calf, rear thigh, rear calf.
        s: Arc lengths of the front and the rear wheels on the wheel-centre curve.
        reference: x, z, pitch and the four joints that eq 17 draws the pose to.
        hips, knees, wheels: (x, z) of the joints' axes and the wheels' centres: front, rear.
    """

    x: Any
    z: Any
    pitch: Any
    q: tuple[Any, Any, Any, Any]
    s: tuple[Any, Any]
    reference: tuple[Any, ...]
    hips: tuple[Point, Point]
    knees: tuple[Point, Point]
    wheels: tuple[Point, Point]

    @classmethod
    def of(cls, variables: Any, reference: Any, skeleton: Skeleton) -> SymbolicPose:
        """The pose of the variables (9,) of eq 18 and the arc lengths."""
        x, z, pitch, q1, q2, q3, q4, front, rear = ca.vertsplit(variables)
        return cls(
            x, z, pitch, (q1, q2, q3, q4), (front, rear), tuple(ca.vertsplit(reference)),
            skeleton.hips, skeleton.knees, skeleton.wheels,
        )  # fmt: skip


ExtraCost = Callable[[SymbolicPose], Any]
ExtraConstraints = Callable[[SymbolicPose], Any]


@dataclass(frozen=True)
class ExtraTerms:
    """What is added to eqs 17-22.

    Attributes:
        cost: Gives a scalar that is added to the cost of eq 17.
        constraints: Gives a scalar, or several, that shall not be negative.
    """

    cost: ExtraCost | None = None
    constraints: ExtraConstraints | None = None

    def __bool__(self) -> bool:
        return self.cost is not None or self.constraints is not None

    def cost_of(self, pose: SymbolicPose) -> Any:
        """The scalar cost.

        Raises:
            InputError: If it is none.
        """
        if self.cost is None:
            return 0.0
        (value,) = _scalars(self.cost(pose), "extra_cost", most=1)
        return value

    def constraints_of(self, pose: SymbolicPose) -> list[Any]:
        """The scalars that shall not be negative.

        Raises:
            InputError: If they are none.
        """
        if self.constraints is None:
            return []
        return _scalars(self.constraints(pose), "extra_constraints")


NONE = ExtraTerms()


def _scalars(values: Any, field: str, most: int | None = None) -> list[Any]:
    """CasADi scalars, or numbers."""
    several = isinstance(values, Sequence) and not isinstance(values, (str, bytes))
    out = list(values) if several else [values]
    if most is not None and len(out) > most:
        raise InputError(f"must return one CasADi scalar, not {len(out)}", (field,))
    for one in out:
        if isinstance(one, bool) or not isinstance(one, (int, float, ca.SX)):
            kind = type(one).__name__
            raise InputError(f"must return CasADi scalars (casadi.SX), not {kind}", (field,))
        if isinstance(one, ca.SX) and one.shape != (1, 1):
            raise InputError(f"must return scalars, not shape {one.shape}", (field,))
    return out
