"""Cost weights of the planners, with bounds and units: the page builds its sliders from them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import Field

from stairwright.arguments import as_model
from stairwright.documents import Model
from stairwright.planning.plan import Method


def _weight(default: float, low: float, high: float, unit: str, title: str, text: str) -> Any:
    return Field(
        default,
        ge=low,
        le=high,
        title=title,
        description=text,
        json_schema_extra={"unit": unit, "scale": "log"},
    )


def _share(title: str, text: str) -> Any:
    return _weight(1.0, 0.01, 100.0, "1", title, text)


def _speed(**extra: str) -> Any:
    return Field(
        0.12,
        ge=0.02,
        le=1.0,
        title="Speed",
        description="Wheel speed along the course where limits and margins allow",
        json_schema_extra={"unit": "m/s", "scale": "log", **extra},
    )


class CriticalWeights(Model):
    """Diagonal of Q (eq 17) and the regularisation that makes the optimum unique."""

    com_x: float = _weight(
        100.0, 0.01, 1e4, "m⁻²", "Trunk x", "Pull of the trunk to its place along x (eq 17)"
    )
    com_z: float = _weight(
        5.0, 0.01, 1e4, "m⁻²", "Trunk z", "Pull to the nominal height; far below x (eq 17)"
    )
    pitch: float = _weight(0.2, 1e-4, 100.0, "rad⁻²", "Pitch", "Pull to a level trunk")
    posture: float = _weight(
        0.01, 1e-5, 10.0, "rad⁻²", "Posture", "Pull of the joints to the standing pose"
    )
    speed: float = _speed()
    exact_links: bool = Field(
        True,
        title="Exact links",
        description="Keep whole links clear of the terrain, not only the 25 collision points",
    )


class PathWeights(Model):
    """What the path planner trades off along the course."""

    com_margin: float = _share(
        "CoM margin",
        "Makes small what the centre of mass lacks to 60 mm of margin where a wheel may be 20 mm "
        "late [m, rms along the path, for legs of 0.4 m]",
    )
    clearance: float = _share(
        "Clearance",
        "Makes small what the trunk lacks to 60 mm above the terrain, and links to what level "
        "ground gives them [m, rms along the path, for legs of 0.4 m]",
    )
    torque: float = _share(
        "Torque",
        "Makes static torque of the leg joints small "
        "[share of the motors' torque, rms along the path]",
    )
    smoothness: float = _share(
        "Smoothness",
        "Makes motion of the trunk small: travel per travel of the wheels, bends included "
        "[1, rms along the path]",
    )
    pitch: float = _share(
        "Pitch",
        "Makes small how far the pitch is off 0.8 of the slope between the wheels "
        "[rad, rms along the path]",
    )
    speed: float = _speed(timing="steady")
    aggressiveness: float = Field(
        0.75,
        ge=0.0,
        le=1.0,
        title="Aggressiveness",
        description="How hard a plan with fast timing is driven: accelerations, joint speeds, "
        "the share of the CoM margin that inertia may take, and clearance given up for a "
        "straighter path",
        json_schema_extra={"unit": "1", "scale": "linear", "timing": "fast"},
    )

    def for_speed(self) -> PathWeights:
        """With clearance traded for a path that bends less, the more the harder it is driven.

        Speed falls with the square root of a path's bends. CoM margin is not traded: inertia lives
        on it. docs/performance.md has what each part brings.
        """
        a = self.aggressiveness
        return self.model_copy(
            update={
                "smoothness": min(self.smoothness * 400.0**a, 100.0),
                "clearance": max(self.clearance * 0.05**a, 0.01),
            }
        )


class NominalWeights(Model):
    """The baseline optimises nothing; only its speed can be set."""

    speed: float = _speed()


MODELS: dict[Method, type[Model]] = {
    "path": PathWeights,
    "critical": CriticalWeights,
    "nominal": NominalWeights,
}


def parse_weights(method: Method, weights: Mapping[str, Any] | Model | None) -> Any:
    """The method's weights with defaults filled in.

    Raises:
        InputError: For an unknown name or a value out of bounds.
    """
    return as_model(MODELS[method], weights, "weights")
