"""Settings of the controller, with bounds and units: the page builds its sliders from them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, ConfigDict, Field, model_validator

from stairwright.arguments import as_model
from stairwright.documents import Model
from stairwright.errors import InputError
from stairwright.setting_groups import grouped

Form = Literal["contact", "paper"]
Solver = Literal["native", "clarabel"]
Sensing = Literal["ideal", "robot"]

# m; a robot that does not quite know where the next face is must push on to find it.
MAXIMUM_LEAD: dict[Sensing, float] = {"ideal": 0.012, "robot": 0.03}

GROUPS = {
    "Controller": ("form", "solver", "sensing"),
    "Pace": ("speed", "joint_speed", "maximum_lead"),
    "Joints and wheels": ("joint_stiffness", "joint_damping", "wheel_damping", "wheel_sync"),
    "Course": ("yaw_damping", "heading_stiffness"),
    "Balance": (
        "com_stiffness",
        "com_damping",
        "pitch_stiffness",
        "pitch_damping",
        "pitch_integral",
        "roll_stiffness",
        "roll_damping",
    ),
    "Contact forces": (
        "force_weight",
        "moment_weight",
        "alpha",
        "beta",
        "friction_share",
        "force_limit",
    ),
}


def _number(
    default: float | None, low: float, high: float, unit: str, title: str, text: str, scale: str
) -> Any:
    def extra(schema: dict[str, Any]) -> None:
        schema.update(unit=unit, scale=scale)
        if schema.pop("anyOf", None):  # a number or empty: keep the bounds where a slider looks
            schema.update(type=["number", "null"], minimum=low, maximum=high)

    return Field(default, ge=low, le=high, title=title, description=text, json_schema_extra=extra)


class ControllerSettings(Model):
    """How the robot is driven along its plan. Equation numbers are the paper's."""

    model_config = ConfigDict(json_schema_extra=grouped(GROUPS))

    form: Form = Field(
        "contact",
        title="Formulation",
        description="contact: forces at the contact points, in each wheel's own frame, wheel "
        "torque fed forward. paper: forces at the wheel centres, wheel torque from the rolling "
        "control alone (eqs 3-16)",
    )
    solver: Solver = Field(
        "native",
        title="QP solver",
        description="Solves the balance QP (eqs 11-12): native is part of the control loop; "
        "clarabel, through qpsolvers, is the reference",
    )
    sensing: Sensing = Field(
        "robot",
        title="Sensing",
        description="What the controller knows of its state. robot: what encoders, motor currents "
        "and an inertial sensor tell, by an estimator that knows the map (form contact, native "
        "solver). ideal: all of it, as the simulation has it; the default of form paper and of "
        "the clarabel solver, which have no estimator",
    )
    speed: float | None = _number(
        None, 0.02, 1.0, "m/s", "Speed", "Along the course; the plan's own timing if empty", "log"
    )
    joint_speed: float = _number(
        1.5, 0.1, 10.0, "rad/s", "Joint speed limit", "Cap on joint rates along the plan", "log"
    )
    maximum_lead: float | None = _number(
        None,
        0.002,
        0.2,
        "m",
        "Maximum lead",
        "How far the plan may run ahead of the wheels; 30 mm if empty where the robot senses by "
        "itself, else 12 mm",
        "log",
    )
    joint_stiffness: float | None = _number(
        None, 0.0, 2000.0, "Nm/rad", "Joint stiffness", "K_p of eq 27; the robot's if empty", "log"
    )
    joint_damping: float | None = _number(
        None, 0.0, 100.0, "Nm s/rad", "Joint damping", "K_d of eq 27; the robot's if empty", "log"
    )
    wheel_damping: float | None = _number(
        None, 0.0, 20.0, "Nm s/rad", "Wheel damping", "K_d of eq 14; the robot's if empty", "log"
    )
    wheel_sync: float = _number(
        5.0, 0.0, 20.0, "1/s", "Wheel stiffness", "Pull of each wheel to its place", "linear"
    )
    yaw_damping: float = _number(
        1.2, 0.0, 20.0, "1", "Yaw damping", "K_d of eq 16, per wheel radius and track", "linear"
    )
    heading_stiffness: float = _number(
        4.0, 0.0, 40.0, "1/s", "Heading stiffness", "Turns the robot back to the course", "linear"
    )
    com_stiffness: float = _number(
        40.0, 0.0, 400.0, "1/s²", "CoM stiffness", "K_p of eq 8, position", "log"
    )
    com_damping: float = _number(
        8.0, 0.0, 80.0, "1/s", "CoM damping", "K_d of eq 8, position", "log"
    )
    pitch_stiffness: float = _number(
        200.0, 0.0, 1000.0, "1/s²", "Pitch stiffness", "K_p of eq 8, pitch", "log"
    )
    pitch_damping: float = _number(
        14.0, 0.0, 100.0, "1/s", "Pitch damping", "K_d of eq 8, pitch", "log"
    )
    pitch_integral: float = _number(
        300.0,
        0.0,
        2000.0,
        "1/s³",
        "Pitch integral",
        "Learns a moment that the model does not know, e.g. of a shifted load (form contact)",
        "linear",
    )
    roll_stiffness: float = _number(
        100.0,
        0.0,
        1000.0,
        "1/s²",
        "Roll stiffness",
        "Left wheels push more than right ones where the robot leans to the left (form contact)",
        "linear",
    )
    roll_damping: float = _number(
        14.0, 0.0, 100.0, "1/s", "Roll damping", "The same against the rate of roll", "linear"
    )
    force_weight: float = _number(
        1.0, 0.001, 100.0, "1", "Force tracking", "S of eq 11 for the force rows", "log"
    )
    moment_weight: float = _number(
        20.0, 0.001, 1000.0, "1/m²", "Moment tracking", "S of eq 11 for the moment row", "log"
    )
    alpha: float = _number(
        1e-3,
        1e-6,
        1.0,
        "1",
        "Force size",
        "Weight of the forces (eq 11); form contact: of their distance from the plan's static ones",
        "log",
    )
    beta: float = _number(
        1e-4, 0.0, 1.0, "1", "Force change", "Weight of the change of forces (eq 11)", "linear"
    )
    friction_share: float = _number(
        0.95,
        0.1,
        1.0,
        "1",
        "Friction share",
        "Part of the friction that the QP may use; all of it where the plan itself needs more",
        "linear",
    )
    force_limit: float | None = _number(
        None,
        20.0,
        10000.0,
        "N",
        "Force limit",
        "Largest normal force of a wheel (eq 12); 1.3 times the robot's weight if empty",
        "log",
    )

    @property
    def lead(self) -> float:
        """How far the plan may run ahead of the wheels [m]."""
        given = self.maximum_lead
        return given if given is not None else MAXIMUM_LEAD[self.sensing]

    @model_validator(mode="before")
    @classmethod
    def _renamed(cls, data: Any) -> Any:
        """Runs that were stored before the setting had its name."""
        if isinstance(data, Mapping) and "leash" in data and "maximum_lead" not in data:
            return {"maximum_lead" if key == "leash" else key: data[key] for key in data}
        return data

    @model_validator(mode="before")
    @classmethod
    def _sensing_follows(cls, data: Any) -> Any:
        """Only form contact with the native solver has an estimator."""
        if not isinstance(data, Mapping) or "sensing" in data:
            return data
        own = data.get("form", "contact") == "contact" and data.get("solver", "native") == "native"
        return data if own else {**data, "sensing": "ideal"}

    @model_validator(mode="after")
    def _check_sensing(self) -> ControllerSettings:
        if self.sensing == "robot" and (self.form != "contact" or self.solver != "native"):
            raise InputError("robot needs form contact and the native solver", ("sensing",))
        return self


def _as_stored(data: Any) -> Any:
    """Runs that were stored before there was a choice knew all of their state."""
    old = isinstance(data, Mapping) and "sensing" not in data
    return {**data, "sensing": "ideal"} if old else data


# Settings within a document of a run, which holds all of them.
StoredSettings = Annotated[ControllerSettings, BeforeValidator(_as_stored)]


def parse_settings(settings: Mapping[str, Any] | ControllerSettings | None) -> ControllerSettings:
    """Settings with defaults filled in.

    Raises:
        InputError: For an unknown name or a value out of bounds; the field starts at `controller`.
    """
    return as_model(ControllerSettings, settings, "controller")
