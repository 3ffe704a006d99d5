"""What may differ between the plan's world and the real one: one set of deviations of a trial."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import Field

from stairwright.arguments import as_model
from stairwright.documents import Model


def _field(low: float, high: float, text: str) -> Any:
    return Field(0.0, ge=low, le=high, description=text)


class Disturbance(Model):
    """Deviations of one rollout from what the plan and the controller believe."""

    friction: float = _field(-5.0, 5.0, "added to the true friction")
    friction_front: float = _field(-5.0, 5.0, "added to that, at the front wheels")
    friction_rear: float = _field(-5.0, 5.0, "added to that, at the rear wheels")
    mass: float = _field(-0.5, 1.0, "share of the robot's mass, on the trunk")
    payload: float = _field(0.0, 100.0, "on top of the trunk's middle [kg]")
    com_x: float = _field(-0.2, 0.2, "the robot's CoM moves forward [m]")
    com_z: float = _field(-0.2, 0.2, "the robot's CoM moves up [m]")
    height: float = _field(-0.2, 0.2, "added to the terrain's rise [m]")
    step_height_error: float = _field(
        0.0, 0.1, "each rise or descent is off by at most this, at random [m]"
    )
    face_place_error: float = _field(
        0.0, 0.1, "each face is moved along by at most this, at random [m]"
    )
    heading: float = _field(-0.5, 0.5, "the robot starts turned to the left of the course [rad]")
    cross_slope: float = _field(-0.3, 0.3, "the terrain rises to the left [rad]")
    x_offset: float = _field(
        -0.2, 0.2, "the robot believes to start farther ahead than it does [m]"
    )
    odometry_scale: float = _field(-0.2, 0.2, "share by which a way seems longer than it is")
    pitch_bias: float = _field(-0.2, 0.2, "added to the pitch: the IMU is mounted pitched [rad]")
    noise: float = _field(0.0, 20.0, "sensor noise, in units of the sensors' own")
    delay: float = _field(0.0, 0.1, "from sensing to torque [s]")
    bandwidth: float = _field(0.0, 500.0, "of the torques [Hz]; 0: they act at once")


def parse_disturbance(value: Mapping[str, Any] | Disturbance | None) -> Disturbance:
    """A disturbance with zeros filled in.

    Raises:
        InputError: For an unknown name or a value out of bounds.
    """
    return as_model(Disturbance, value, "disturbance")
