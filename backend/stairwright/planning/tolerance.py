"""How far the world may be from what a plan was drawn for, with the plan still holding."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import Field

from stairwright.arguments import as_model
from stairwright.documents import Model
from stairwright.errors import InputError


def _tolerance(high: float, unit: str, title: str, text: str) -> Any:
    extra: dict[str, Any] = {"unit": unit, "scale": "linear"}
    return Field(0.0, ge=0.0, le=high, title=title, description=text, json_schema_extra=extra)


class Tolerance(Model):
    """What a plan shall stand; docs/method.md says what the certificate makes of it.

    Faces are stretches steeper than 45 degrees, treads what lies between them; both keep their
    slopes. The robot adapts as it does with its own sensors: the trunk keeps its pitch, its place
    follows the ground under the wheels by the load they carry, and the legs reach for the ground.
    """

    height: float = _tolerance(
        0.05, "m", "Step height ±", "each step is up to this much taller or lower than drawn [m]"
    )
    place: float = _tolerance(
        0.06,
        "m",
        "Face place ±",
        "each face is up to this much nearer or farther than drawn [m]",
    )
    friction: float = _tolerance(
        0.5, "1", "Friction loss", "friction is up to this much lower than planned"
    )

    @property
    def none(self) -> bool:
        """Whether nothing is asked for."""
        return not (self.height or self.place or self.friction)

    @property
    def asked(self) -> dict[str, float]:
        """What is asked for, by name."""
        return {name: value for name, value in self.model_dump().items() if value}


def parse_tolerance(
    tolerance: Mapping[str, Any] | Tolerance | None, method: str, friction: float
) -> Tolerance | None:
    """A plan's tolerance; None where nothing is asked for.

    Raises:
        InputError: For an unknown name, a value out of bounds, another method than ``path``, or
            where no friction would be left.
    """
    parsed = as_model(Tolerance, tolerance, "tolerance")
    if parsed.none:
        return None
    if method != "path":
        raise InputError("belongs to the method path", ("tolerance",))
    if parsed.friction >= friction:
        raise InputError(f"must leave some of the friction {friction:g}", ("tolerance", "friction"))
    return parsed
