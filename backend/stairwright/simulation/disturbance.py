"""What may differ between the plan's world and the real one: one set of deviations of a trial."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import ConfigDict, Field

from stairwright.arguments import as_model
from stairwright.documents import EITHER, NUMBER, OTHER, Model
from stairwright.setting_groups import grouped

GROUPS = {
    "Friction": ("friction", "friction_front", "friction_rear", "friction_wheels"),
    "Load": ("mass", "payload", "com_x", "com_z"),
    "Terrain": ("height", "step_height_error", "face_place_error", "cross_slope"),
    "Start": ("heading", "x_offset"),
    "Sensors": ("odometry_scale", "pitch_bias", "noise", "imu"),
    "Motors": ("delay", "bandwidth", "torque_scale", "stiction", "rotor_inertia"),
}

Error = Annotated[float, Field(ge=-0.1, le=0.1)]  # m
Errors = Annotated[Annotated[Error, NUMBER] | Annotated[list[Error], OTHER], EITHER]
Friction = Annotated[float, Field(gt=0.0, le=5.0)]


def _field(
    low: float,
    high: float,
    unit: str,
    title: str,
    text: str,
    slider: tuple[float, float] | None = None,
) -> Any:
    """A number that is 0 where nothing deviates; `slider`: a range for hands, within the bounds."""
    extra: dict[str, Any] = {"unit": unit, "scale": "linear"}
    if slider:
        extra["slider"] = slider
    return Field(0.0, ge=low, le=high, title=title, description=text, json_schema_extra=extra)


def _maybe(high: float, unit: str, title: str, text: str) -> Any:
    """A number from 0 that stays as it is where it is empty."""

    def extra(schema: dict[str, Any]) -> None:
        del schema["anyOf"]  # the bounds stand where a slider looks for them
        schema.update(type=["number", "null"], minimum=0.0, maximum=high, unit=unit, scale="linear")

    return Field(None, ge=0.0, le=high, title=title, description=text, json_schema_extra=extra)


def _deviation(title: str, text: str) -> Any:
    extra: dict[str, Any] = {"unit": "m", "scale": "linear", "minimum": 0.0, "maximum": 0.1}
    description = f"{text}: standard deviation, or one after the other [m]"
    return Field(0.0, title=title, description=description, json_schema_extra=extra)


class AddedPayload(Model):
    """A mass that the plan does not know of."""

    mass: float = Field(ge=0.0, le=100.0, description="kg")
    place: tuple[float, float, float] | None = Field(
        None, description="of its mass centre in the trunk's frame; on top if empty [m]"
    )


Payload = Annotated[
    Annotated[float, Field(ge=0.0, le=100.0), NUMBER] | Annotated[AddedPayload, OTHER], EITHER
]


class ImuErrors(Model):
    """Errors of the inertial sensor, beside those that the usual one has.

    They matter where the controller's sensing is `robot`.
    """

    gyro_bias: float = _field(-0.5, 0.5, "rad/s", "Gyroscope bias", "about each axis [rad/s]")
    accelerometer_bias: float = _field(
        -5.0, 5.0, "m/s²", "Accelerometer bias", "along each axis [m/s^2]"
    )
    gyro_noise: float | None = _maybe(
        1.0, "rad/s", "Gyroscope noise", "of a reading; the usual one if empty [rad/s]"
    )
    accelerometer_noise: float | None = _maybe(
        20.0, "m/s²", "Accelerometer noise", "of a reading; the usual one if empty [m/s^2]"
    )


class Disturbance(Model):
    """Deviations of one rollout from what the plan and the controller believe."""

    model_config = ConfigDict(json_schema_extra=grouped(GROUPS))

    friction: float = _field(-5.0, 5.0, "1", "Friction", "added to the true friction", (-0.5, 0.5))
    friction_front: float = _field(
        -5.0, 5.0, "1", "Friction, front", "added to that, at the front wheels", (-0.5, 0.5)
    )
    friction_rear: float = _field(
        -5.0, 5.0, "1", "Friction, rear", "added to that, at the rear wheels", (-0.5, 0.5)
    )
    friction_wheels: tuple[Friction, Friction, Friction, Friction] | None = Field(
        None,
        title="Friction, wheels",
        description="the true friction of the wheels FL, FR, RL, RR instead",
    )
    mass: float = _field(-0.5, 1.0, "1", "Mass", "share of the robot's mass, on the trunk")
    payload: Payload = Field(
        0.0,
        title="Payload",
        description="on top of the trunk's middle [kg], or a mass and its place",
        json_schema_extra={
            "unit": "kg",
            "scale": "linear",
            "minimum": 0.0,
            "maximum": 100.0,
            "slider": [0.0, 10.0],
        },
    )
    com_x: float = _field(-0.2, 0.2, "m", "CoM forward", "the robot's CoM moves forward [m]")
    com_z: float = _field(-0.2, 0.2, "m", "CoM up", "the robot's CoM moves up [m]")
    height: float = _field(-0.2, 0.2, "m", "Rise", "added to the terrain's rise [m]")
    step_height_error: Errors = _deviation("Step heights", "each rise or descent is off")
    face_place_error: Errors = _deviation("Face places", "each face is moved along")
    heading: float = _field(
        -0.5, 0.5, "rad", "Heading", "the robot starts turned to the left of the course [rad]"
    )
    cross_slope: float = _field(
        -0.3, 0.3, "rad", "Cross slope", "the terrain rises to the left [rad]"
    )
    x_offset: float = _field(
        -0.2,
        0.2,
        "m",
        "Start, believed",
        "the robot believes to start farther ahead than it does [m]",
    )
    odometry_scale: float = _field(
        -0.2, 0.2, "1", "Odometry", "share by which a way seems longer than it is"
    )
    pitch_bias: float = _field(
        -0.2, 0.2, "rad", "Pitch bias", "added to the pitch: the IMU is mounted pitched [rad]"
    )
    noise: float = _field(
        0.0, 20.0, "1", "Sensor noise", "sensor noise, in units of the sensors' own", (0.0, 5.0)
    )
    delay: float = _field(0.0, 0.1, "s", "Delay", "from sensing to torque [s]")
    bandwidth: float = _field(
        0.0,
        500.0,
        "Hz",
        "Torque bandwidth",
        "of the torques [Hz]; 0: they act at once",
        (0.0, 100.0),
    )
    torque_scale: float = _field(
        -0.5, 0.5, "1", "Motor torque", "share by which motors give more than asked for"
    )
    stiction: float = _field(
        0.0, 20.0, "Nm", "Stiction", "dry friction of each leg joint and wheel [Nm]", (0.0, 3.0)
    )
    rotor_inertia: float | None = _maybe(
        1.0, "kg m²", "Rotor inertia", "of every motor, as its joint feels it [kg m^2]"
    )
    imu: ImuErrors = Field(
        ImuErrors(),
        title="Inertial sensor",
        description="what the robot's own inertial sensor errs by, where sensing is robot",
    )

    @property
    def load(self) -> AddedPayload:
        """The payload with its place, if one is given."""
        return (
            self.payload
            if isinstance(self.payload, AddedPayload)
            else AddedPayload(mass=self.payload)
        )

    def size(self, name: str) -> float:
        """How large the deviation `name` is: without sign, the largest of several."""
        value = getattr(self, name)
        if isinstance(value, AddedPayload):
            return value.mass
        if isinstance(value, ImuErrors):
            return max(abs(v) for v in (value.gyro_bias, value.accelerometer_bias))
        if isinstance(value, list | tuple):
            return max((abs(v) for v in value), default=0.0)
        return abs(value) if value is not None else 0.0


def parse_disturbance(value: Mapping[str, Any] | Disturbance | None) -> Disturbance:
    """A disturbance with zeros filled in.

    Raises:
        InputError: For an unknown name or a value out of bounds.
    """
    return as_model(Disturbance, value, "disturbance")
