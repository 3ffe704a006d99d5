"""The rollout document: what happened when a plan was carried out in simulation."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, ConfigDict, Field, PlainSerializer, WithJsonSchema
from pydantic import model_validator as check

from stairwright.arrays import Floats
from stairwright.control.settings import StoredSettings
from stairwright.documents import Model, save
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.robot.description import Robot
from stairwright.robot.parts import optional
from stairwright.terrain.profile import Terrain

Outcome = Literal["success", "fell", "stuck", "collided", "diverged", "timeout", "stopped"]


def _as_array(value: Any) -> Floats:
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError("must be an array of numbers") from None
    if not np.isfinite(array).all():
        raise InputError("must be finite")
    return array


Array = Annotated[
    Any,
    BeforeValidator(_as_array),
    PlainSerializer(lambda array: array.tolist(), return_type=list),
    WithJsonSchema({"type": "array"}),
]

_SHAPES: dict[str, tuple[int, ...]] = {
    "time": (),
    "base_position": (3,),
    "base_quaternion": (4,),
    "q": (12,),
    "q_desired": (12,),
    "dq": (12,),
    "torque": (12,),
    "pitch": (),
    "pitch_desired": (),
    "progress": (),
    "progress_desired": (),
    "contact_force": (4, 2),
}


def _with_shapes(schema: dict[str, Any]) -> None:
    """Let the JSON schema say what the arrays hold."""
    for name, tail in _SHAPES.items():
        items: dict[str, Any] = {"type": "number"}
        for length in reversed(tail):
            items = {"type": "array", "items": items, "minItems": length, "maxItems": length}
        schema["properties"][name]["items"] = items


class Series(Model):
    """Samples at even times (N of them). SI units, world frame; numpy arrays, lists in JSON.

    Joint order is the contract's: FL, FR, RL, RR, each thigh, calf, wheel.
    """

    model_config = ConfigDict(arbitrary_types_allowed=True, json_schema_extra=_with_shapes)

    time: Array = Field(description="[N] s")
    base_position: Array = Field(description="[N, 3] trunk point [m]")
    base_quaternion: Array = Field(description="[N, 4] trunk, wxyz")
    q: Array = Field(description="[N, 12] joint angles [rad]")
    q_desired: Array = Field(
        description="[N, 12] what the plan asks for [rad]; wheels: the angle rolled so far"
    )
    dq: Array = Field(description="[N, 12] joint speeds [rad/s]")
    torque: Array = Field(description="[N, 12] joint torques after all limits [Nm]")
    pitch: Array = Field(description="[N] about +y: nose-up is negative [rad]")
    pitch_desired: Array = Field(description="[N] rad")
    progress: Array = Field(description="[N] measured, mean of the wheels since the start [m]")
    progress_desired: Array = Field(description="[N] the plan's, held back by the maximum lead [m]")
    contact_force: Array = Field(
        description="[N, 4, 2] force of the terrain on each wheel, world x and z [N]"
    )

    @check(mode="after")
    def _check_shapes(self) -> Series:
        n = len(self.time)
        for name, tail in _SHAPES.items():
            shape = getattr(self, name).shape
            if shape != (n, *tail):
                raise InputError(f"expected the shape {(n, *tail)}, got {shape}", (name,))
        return self

    def __len__(self) -> int:
        return len(self.time)


class Metrics(Model):
    """Figures of one rollout; angles in rad."""

    duration: float = Field(description="simulated time until the end [s]")
    pitch_error_max: float = Field(description="[rad]")
    pitch_error_rms: float = Field(description="[rad]")
    joint_error_rms: float = Field(description="thighs and calves [rad]")
    torque_peak: float = Field(description="thighs and calves [Nm]")
    wheel_torque_peak: float = Field(description="[Nm]")
    torque_rms: float | None = Field(
        None, description="largest root mean square of a thigh's or calf's torque [Nm]"
    )
    continuous_share: float | None = Field(
        None,
        description="largest root mean square of a motor's torque as a share of its `continuous` "
        "torque: above 1 it gets too hot in time; null where the robot's file has none",
    )
    energy: float = Field(description="integral of |torque x speed| over all joints [J]")
    link_contacts: int = Field(
        description="control steps in which trunk or a link touched the terrain"
    )
    link_force_peak: float = Field(description="largest such force, averaged over 20 ms [N]")
    self_contacts: int = Field(description="control steps in which legs touched each other")
    end_error: float = Field(description="largest distance of a wheel from the plan's end [m]")
    progress: float = Field(description="share of the plan that was reached, 0..1")
    speed_mean: float = Field(description="along the course [m/s]")
    speed_stairs: float | None = Field(
        None,
        description="along the course, from the first contact with the first face to all wheels on "
        "the landing [m/s]; null where the ground is level or the robot does not get there",
    )
    cost_of_transport: float | None = Field(
        None, description="energy per weight and way; null where it does not get on"
    )
    real_time_factor: float = Field(description="simulated time per wall-clock time")


class Rollout(Model):
    """A rollout (``stairwright/rollout/1``); `id` is a hash of everything that went into it."""

    schema_: Literal["stairwright/rollout/1"] = Field("stairwright/rollout/1", alias="schema")
    id: str
    plan_id: str
    method: str
    terrain: Terrain
    terrain_hash: str
    robot: str
    robot_hash: str
    robot_description: Robot
    model: str = optional(
        "", max_length=2000, description="the file whose model was simulated, if not ours"
    )
    friction: float
    seed: int
    controller: StoredSettings
    disturbance: dict[str, Any] = Field({}, description="what deviated, see Disturbance")
    outcome: Outcome
    reason: str = Field(description="one sentence: what happened, where and when")
    metrics: Metrics
    series: Series
    plan: Plan | None = Field(None, description="the plan that was carried out")

    @property
    def success(self) -> bool:
        """Whether the robot arrived as planned."""
        return self.outcome == "success"

    def save(self, path: str) -> None:
        """Write the rollout; the ending picks the format (html, json, csv, npz, mcap)."""
        save(self, path)
