"""What may differ between the plan's world and the real one: one set of deviations of a trial."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import Field

from stairwright.arguments import as_model
from stairwright.documents import Model


def _field(low: float, high: float, unit: str, title: str, text: str) -> Any:
    extra: dict[str, Any] = {"unit": unit, "scale": "linear"}
    return Field(0.0, ge=low, le=high, title=title, description=text, json_schema_extra=extra)


class Disturbance(Model):
    """Deviations of one rollout from what the plan and the controller believe."""

    friction: float = _field(-5.0, 5.0, "1", "Friction", "added to the true friction")
    friction_front: float = _field(
        -5.0, 5.0, "1", "Friction, front", "added to that, at the front wheels"
    )
    friction_rear: float = _field(
        -5.0, 5.0, "1", "Friction, rear", "added to that, at the rear wheels"
    )
    mass: float = _field(-0.5, 1.0, "1", "Mass", "share of the robot's mass, on the trunk")
    payload: float = _field(0.0, 100.0, "kg", "Payload", "on top of the trunk's middle [kg]")
    com_x: float = _field(-0.2, 0.2, "m", "CoM forward", "the robot's CoM moves forward [m]")
    com_z: float = _field(-0.2, 0.2, "m", "CoM up", "the robot's CoM moves up [m]")
    height: float = _field(-0.2, 0.2, "m", "Rise", "added to the terrain's rise [m]")
    step_height_error: float = _field(
        0.0, 0.1, "m", "Step heights", "each rise or descent is off by at most this, at random [m]"
    )
    face_place_error: float = _field(
        0.0, 0.1, "m", "Face places", "each face is moved along by at most this, at random [m]"
    )
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
        0.0, 20.0, "1", "Sensor noise", "sensor noise, in units of the sensors' own"
    )
    delay: float = _field(0.0, 0.1, "s", "Delay", "from sensing to torque [s]")
    bandwidth: float = _field(
        0.0, 500.0, "Hz", "Torque bandwidth", "of the torques [Hz]; 0: they act at once"
    )


def parse_disturbance(value: Mapping[str, Any] | Disturbance | None) -> Disturbance:
    """A disturbance with zeros filled in.

    Raises:
        InputError: For an unknown name or a value out of bounds.
    """
    return as_model(Disturbance, value, "disturbance")
