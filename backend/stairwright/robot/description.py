"""The robot: one document that feeds kinematics, planner and simulator.

A four-legged robot with a thigh, a calf and a driven wheel per leg; abduction joints are locked.
Everything that planner and simulator know about it comes from here. SI units; frames of the
contract: x forward, y left, z up, every joint turns about +y. The trunk frame's origin is the
midpoint of the two hip axes.
"""

from __future__ import annotations

import math
import re
from functools import cached_property
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.documents import Model, content_hash, save
from stairwright.errors import InputError

from .defaults import standard_points, suitable_gains
from .legs import Body, Leg, body_of, legs_of
from .native import native_robot
from .parts import (
    BENT,
    Actuator,
    Actuators,
    CollisionPoints,
    Gains,
    Hips,
    JointFrame,
    Joints,
    LegLimits,
    Link,
    Payload,
    Positive,
    RearLegs,
    Trunk,
    Wheel,
    optional,
)

LEGS = ("FL", "FR", "RL", "RR")
JOINTS = tuple(f"{leg}_{part}" for leg in LEGS for part in ("thigh", "calf", "wheel"))
_ROS_NAME = re.compile(r"[A-Za-z][\w/.-]{0,99}", re.ASCII)
MOST_HELD = 200  # joints of a file that count as rigid
FOLDED = 3.1  # rad; a calf lies on its thigh at pi
# Fields that documents of the first schema do not have.
_NEW_IN_2: tuple[tuple[str, ...], ...] = (
    ("source",), ("assumed",), ("assumed_fields",), ("payload",), ("rear",), ("abduction",),
    ("joint_frames",), ("held_joints",),
    ("trunk", "com"), ("trunk", "outline"), ("thigh", "shape"), ("calf", "shape"),
    ("wheel", "friction"), ("wheel", "rolling_resistance"),
    ("actuators", "thigh"), ("actuators", "calf"),
)  # fmt: skip
_TEXTS = {"description", "source", "assumed", "assumed_fields"}
PLANAR_JOINTS = ("front_thigh", "front_calf", "rear_thigh", "rear_calf")


def _joint_names(names: dict[str, str]) -> dict[str, str]:
    """Names for some of the joints, all different from each other and from the others'."""
    for joint, name in names.items():
        if joint not in JOINTS:
            raise InputError(f"no such joint; there are: {', '.join(JOINTS)}", (joint,))
        if not _ROS_NAME.fullmatch(name):
            raise InputError(
                "must be a letter, then letters, digits, '_', '/', '-' or '.', 100 at most",
                (joint,),
            )
    used = [names.get(joint, joint) for joint in JOINTS]
    for joint, name in zip(JOINTS, used, strict=True):
        if used.count(name) > 1:
            raise InputError(f"two joints are called {name!r}", (joint,))
    return names


def _known_joints(frames: dict[str, JointFrame]) -> dict[str, JointFrame]:
    """Frames of joints that there are."""
    for joint in frames:
        if joint not in JOINTS:
            raise InputError(f"no such joint; there are: {', '.join(JOINTS)}", (joint,))
    return frames


JointFrames = Annotated[dict[str, JointFrame], AfterValidator(_known_joints)]
JointNames = Annotated[dict[str, str], AfterValidator(_joint_names)]


class Robot(Model):
    """A wheel-legged robot (``stairwright/robot/2``; ``/1`` has fewer fields, see `_NEW_IN_2`)."""

    schema_: Literal["stairwright/robot/1", "stairwright/robot/2"] = Field(
        "stairwright/robot/2", alias="schema"
    )
    name: str = Field(min_length=1, max_length=100, pattern=r"^[\w .+-]+$")
    description: str = Field("", max_length=2000)
    source: str = optional("", max_length=2000, description="where the numbers are from")
    assumed: list[str] = optional(
        [], max_length=200, description="numbers that nobody publishes, and what was taken"
    )
    assumed_fields: dict[str, Annotated[int, Field(ge=0)]] = optional(
        {},
        max_length=200,
        description="which sentence of `assumed`, from 0, tells a field, by its path: "
        "wheel.radius, rear.actuators.calf.torque",
    )
    nominal_height: Positive = Field(description="trunk centre above the ground, standing [m]")
    trunk: Trunk
    payload: Payload | None = optional(None)
    hips: Hips
    thigh: Link
    calf: Link
    wheel: Wheel
    rear: RearLegs | None = optional(None, description="where the rear legs differ")
    joints: Joints
    abduction: float = optional(
        0.0, ge=-1.6, le=1.6, description="angle at which the abduction joints are locked [rad]"
    )
    actuators: Actuators
    gains: Gains | None = optional(None, description="from masses and motors if empty")
    collision_points: CollisionPoints | None = optional(None, description="25 and more if empty")
    joint_names: JointNames = optional(
        {},
        description="what the robot's own software calls its joints, by our names "
        "(FL_thigh ... RR_wheel); used in ROS messages and URDF",
    )
    joint_frames: JointFrames = optional(
        {},
        description="how the robot's own software counts the angles of its joints, by our names; "
        "used in ROS messages and URDF",
    )
    held_joints: dict[str, float] = optional(
        {},
        max_length=MOST_HELD,
        description="joints of the file it was imported from that count as rigid, by the file's "
        "names, and where they are held [rad or m]",
    )

    @model_validator(mode="before")
    @classmethod
    def _without_schema(cls, data: Any) -> Any:
        """A document that names no schema is of the first one."""
        if isinstance(data, dict) and not {"schema", "schema_"} & data.keys():
            return data | {"schema": "stairwright/robot/1"}
        return data

    @model_validator(mode="after")
    def _check_schema(self) -> Robot:
        if self.schema_ == "stairwright/robot/2":
            return self
        for field in ("gains", "collision_points"):
            if getattr(self, field) is None:
                raise InputError("Field required", (field,))
        if self.actuators.leg is None:
            raise InputError("Field required", ("actuators", "leg"))
        for name, pair in self.joints:
            if pair.straightens:
                raise InputError(
                    "the range must not contain 0 (a straight leg): the knee bends one way; "
                    "it may in stairwright/robot/2",
                    ("joints", name, "calf"),
                )
        for path in _NEW_IN_2:
            *parents, name = path
            owner: Model = self
            for key in parents:
                owner = getattr(owner, key)
            if getattr(owner, name) != type(owner).model_fields[name].default:
                raise InputError("needs schema: stairwright/robot/2", path)
        for part in ("thigh", "calf"):
            if isinstance(getattr(self, part).com, tuple):
                raise InputError("a place needs schema: stairwright/robot/2", (part, "com"))
        return self

    @model_validator(mode="after")
    def _check_assumed(self) -> Robot:
        for path, sentence in self.assumed_fields.items():
            if sentence >= len(self.assumed):
                raise InputError("`assumed` has no such sentence", ("assumed_fields", path))
        return self

    @model_validator(mode="after")
    def _check_geometry(self) -> Robot:
        if self.hips.front[0] <= self.hips.rear[0]:
            raise InputError("the front hip must lie ahead of the rear hip", ("hips", "front"))
        middle = [(a + b) / 2 for a, b in zip(self.hips.front, self.hips.rear, strict=True)]
        if math.hypot(*middle) > 1e-6:
            raise InputError(
                "the trunk's centre must be the midpoint of the two hip axes", ("hips", "rear")
            )
        front, rear = self.legs
        if front.wheel.radius != rear.wheel.radius:
            raise InputError(
                f"must be {front.wheel.radius:g} m, as in front: wheels of one size",
                ("rear", "wheel", "radius"),
            )
        reach = min(front.reach, rear.reach)
        drop = self.nominal_height - self.wheel.radius
        if not 0.0 < drop < reach:
            raise InputError(
                f"must lie between the wheel radius {self.wheel.radius:g} m and "
                f"{reach + self.wheel.radius:g} m, where the legs are straight",
                ("nominal_height",),
            )
        return self

    @cached_property
    def hash(self) -> str:
        """Hash of everything but the texts."""
        return content_hash(self.model_dump(mode="json", exclude=_TEXTS))

    def save(self, path: str) -> None:
        """Write the robot; the ending of `path` picks the format (yaml, json, urdf, mjcf)."""
        save(self, path)

    @property
    def ros_joints(self) -> tuple[str, ...]:
        """What the robot's own software calls the 12 joints, in the contract's order."""
        return tuple(self.joint_names.get(joint, joint) for joint in JOINTS)

    @cached_property
    def ros_frames(self) -> tuple[Floats, Floats]:
        """(12,) signs and (12,) offsets [rad]: what its software calls q is sign * (q - offset)."""
        frames = [self.joint_frames.get(joint, JointFrame()) for joint in JOINTS]
        signs, offsets = zip(*((frame.sign, frame.offset) for frame in frames), strict=True)
        return np.array(signs, float), np.array(offsets, float)

    @cached_property
    def legs(self) -> tuple[Leg, Leg]:
        """Front and rear leg, with everything that the document may leave out."""
        links = (self.thigh, self.calf, self.wheel)
        return legs_of(self.hips, *links, self.joints, self.actuators, self.rear)

    @cached_property
    def body(self) -> Body:
        """The trunk with its payload."""
        return body_of(self.trunk, self.payload)

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return self.body.mass + 2 * sum(leg.mass for leg in self.legs)

    @property
    def motors(self) -> tuple[Actuator, ...]:
        """Of the 12 joints, in the contract's order."""
        front, rear = self.legs
        return (*front.motors, *front.motors, *rear.motors, *rear.motors)

    @property
    def leg_speed(self) -> float:
        """No-load speed of the slowest leg motor [rad/s]."""
        return min(motor.speed for leg in self.legs for motor in leg.motors[:2])

    @property
    def wheel_speed(self) -> float:
        """No-load speed of the slowest wheel motor [rad/s]."""
        return min(leg.wheel_motor.speed for leg in self.legs)

    @cached_property
    def torque_limits(self) -> Floats:
        """(2, 3) front and rear: peak torque of thigh, calf and wheel motors [Nm]."""
        return np.array([[motor.torque for motor in leg.motors] for leg in self.legs])

    @cached_property
    def points(self) -> CollisionPoints:
        """Where the collision points sit."""
        return self.collision_points or standard_points(self.trunk)

    @cached_property
    def feedback(self) -> Gains:
        """The document's gains, or what suits its masses and motors."""
        return self.gains or suitable_gains(self.mass, self.legs)

    @cached_property
    def native(self) -> _core.Robot:
        """The planar robot of the native core; to change one, copy it first (`copy.copy`)."""
        return native_robot(self.body, self.legs, self.hips.half_track, self.nominal_height)

    def with_knees(self, front: float, rear: float) -> Robot:
        """The robot whose knees bend one way each: +1 forward, -1 backward.

        Raises:
            InputError: If a knee cannot.
        """
        limits: dict[str, Any] = {}
        for name, knee in (("front", front), ("rear", rear)):
            pair: LegLimits = getattr(self.joints, name)
            if knee not in pair.ways:
                raise InputError("the knee does not bend that way", ("joints", name, "calf"))
            low, high = pair.calf
            low, high = (max(low, BENT), high) if knee > 0 else (low, min(high, -BENT))
            low, high = max(low, -FOLDED), min(high, FOLDED)
            limits[name] = pair.model_copy(update={"calf": (low, high)})
        return self.model_copy(update={"joints": Joints(**limits)})
