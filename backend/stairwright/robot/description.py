"""The robot: one document that feeds kinematics, planner and simulator.

A four-legged robot with a thigh, a calf and a driven wheel per leg and no abduction. Everything
that planner and simulator know about it comes from here. SI units; frames of the contract: x
forward, y left, z up, every joint turns about +y.
"""

from __future__ import annotations

import math
import re
from functools import cached_property
from typing import Annotated, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Field, model_validator

from stairwright import _core
from stairwright.documents import Model, content_hash
from stairwright.errors import InputError

LEGS = ("FL", "FR", "RL", "RR")
JOINTS = tuple(f"{leg}_{part}" for leg in LEGS for part in ("thigh", "calf", "wheel"))
_ROS_NAME = re.compile(r"[A-Za-z][\w/.-]{0,99}", re.ASCII)
PLANAR_JOINTS = ("front_thigh", "front_calf", "rear_thigh", "rear_calf")

Positive = Annotated[float, Field(gt=0.0, le=1000.0)]
# The least are far below any robot's and far above what the simulator takes for nothing.
Mass = Annotated[float, Field(ge=1e-6, le=1000.0)]
Moment = Annotated[float, Field(ge=1e-12, le=1000.0)]
Range = tuple[
    Annotated[float, Field(ge=-2 * math.pi, le=2 * math.pi)],
    Annotated[float, Field(ge=-2 * math.pi, le=2 * math.pi)],
]


def _possible(moments: tuple[float, float, float]) -> tuple[float, float, float]:
    """Principal moments that some distribution of mass has."""
    a, b, c = sorted(moments)
    if a + b < c:
        raise InputError(
            f"no body has these moments: the largest, {c}, must be at most the sum of the other "
            f"two, {a + b}"
        )
    return moments


Inertia = Annotated[tuple[Moment, Moment, Moment], AfterValidator(_possible)]


class Trunk(Model):
    """The body box; its centre is the trunk point (x_c, z_c)."""

    size: tuple[Positive, Positive, Positive] = Field(description="length, width, height [m]")
    mass: Mass = Field(description="[kg]")
    inertia: Inertia = Field(description="Ixx, Iyy, Izz about the centre [kg m^2]")


class Hips(Model):
    """Hip axes in the trunk frame: (x, z) of the front and the rear one, and the legs' y."""

    front: tuple[float, float]
    rear: tuple[float, float]
    half_track: Positive = Field(description="distance of the leg planes from the middle [m]")


class Link(Model):
    """A thigh or a calf: a capsule from its upper joint to its lower one."""

    length: float = Field(ge=1e-3, le=1000.0, description="[m]")
    radius: Positive = Field(description="of the capsule [m]")
    mass: Mass = Field(description="[kg]")
    com: float = Field(ge=0.0, le=1.0, description="mass centre as a fraction of the length")
    inertia: Inertia = Field(description="Ixx, Iyy, Izz about the mass centre [kg m^2]")


class Wheel(Model):
    """A wheel at the end of each calf."""

    radius: Positive = Field(description="[m]")
    width: Positive = Field(description="[m]")
    mass: Mass = Field(description="[kg]")
    inertia: Inertia = Field(description="Ixx, Iyy, Izz about the centre [kg m^2]")


class LegLimits(Model):
    """Joint ranges of one leg pair [rad]. The sign of the calf's range says how the knee bends."""

    thigh: Range
    calf: Range

    @model_validator(mode="after")
    def _check_order(self) -> LegLimits:
        for name in ("thigh", "calf"):
            lower, upper = getattr(self, name)
            if lower >= upper:
                raise InputError(
                    f"lower limit {lower:g} must be below the upper {upper:g}", (name,)
                )
        if self.calf[0] < 0.0 < self.calf[1]:
            raise InputError(
                "the range must not contain 0 (a straight leg): the knee bends one way", ("calf",)
            )
        return self

    @property
    def knee(self) -> float:
        """+1 if the calf turns forward (knee in front), -1 if it turns backward."""
        return 1.0 if self.calf[1] > 0.0 else -1.0


class Joints(Model):
    """Joint ranges of the front and the rear legs."""

    front: LegLimits
    rear: LegLimits


class Actuator(Model):
    """A motor: peak torque at standstill that falls linearly to zero at its top speed."""

    torque: Positive = Field(description="peak torque [Nm]")
    speed: Positive = Field(description="no-load speed [rad/s]")
    armature: float = Field(ge=0.0, le=10.0, description="reflected rotor inertia [kg m^2]")
    damping: float = Field(ge=0.0, le=10.0, description="viscous friction [Nm s/rad]")


class Actuators(Model):
    """Motors of the leg joints (thigh, calf) and of the wheels."""

    leg: Actuator
    wheel: Actuator


class Gains(Model):
    """Feedback gains that suit this robot; the controller's settings may override them."""

    joint_stiffness: float = Field(ge=0.0, le=5000.0, description="thigh and calf [Nm/rad]")
    joint_damping: float = Field(ge=0.0, le=500.0, description="thigh and calf [Nm s/rad]")
    wheel_damping: float = Field(ge=0.0, le=100.0, description="wheel rate feedback [Nm s/rad]")


class CollisionPoints(Model):
    """Where the paper's collision points sit on trunk and links."""

    trunk: list[tuple[float, float]] = Field(
        min_length=1, max_length=200, description="(x, z) in trunk sizes from the centre, -0.5..0.5"
    )
    thigh: list[float] = Field(max_length=100, description="fractions of the thigh from the hip")
    calf: list[float] = Field(max_length=100, description="fractions of the calf from the knee")

    @property
    def count(self) -> int:
        """Number of points on one side of the robot (trunk, front leg, rear leg)."""
        return len(self.trunk) + 2 * (len(self.thigh) + len(self.calf))


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


JointNames = Annotated[dict[str, str], AfterValidator(_joint_names)]


class Robot(Model):
    """A wheel-legged robot (``stairwright/robot/1``)."""

    schema_: Literal["stairwright/robot/1"] = Field("stairwright/robot/1", alias="schema")
    name: str = Field(min_length=1, max_length=100, pattern=r"^[\w .+-]+$")
    description: str = Field("", max_length=2000)
    nominal_height: Positive = Field(description="trunk centre above the ground, standing [m]")
    trunk: Trunk
    hips: Hips
    thigh: Link
    calf: Link
    wheel: Wheel
    joints: Joints
    actuators: Actuators
    gains: Gains
    collision_points: CollisionPoints
    # Left out of documents and hashes where empty: robots without it are the ones they were.
    joint_names: JointNames = Field(
        default={},
        exclude_if=lambda names: not names,
        description="what the robot's own software calls its joints, by our names "
        "(FL_thigh ... RR_wheel); used in ROS messages and URDF",
    )

    @model_validator(mode="after")
    def _check_geometry(self) -> Robot:
        if self.hips.front[0] <= self.hips.rear[0]:
            raise InputError("the front hip must lie ahead of the rear hip", ("hips", "front"))
        middle = [(a + b) / 2 for a, b in zip(self.hips.front, self.hips.rear, strict=True)]
        if math.hypot(*middle) > 1e-6:
            raise InputError(
                "the trunk's centre must be the midpoint of the two hip axes", ("hips", "rear")
            )
        reach = self.thigh.length + self.calf.length
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
        return content_hash(self.model_dump(mode="json", exclude={"description"}))

    def save(self, path: str) -> None:
        """Write the robot; the ending of `path` picks the format (urdf, mjcf)."""
        from stairwright.export.formats import save_robot  # exports lie to the right of robots

        save_robot(self, path)

    @property
    def ros_joints(self) -> tuple[str, ...]:
        """What the robot's own software calls the 12 joints, in the contract's order."""
        return tuple(self.joint_names.get(joint, joint) for joint in JOINTS)

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return self.trunk.mass + 4 * (self.thigh.mass + self.calf.mass + self.wheel.mass)

    @cached_property
    def torque_limits(self) -> NDArray[np.float64]:
        """(2, 3) front and rear: peak torque of thigh, calf and wheel motors [Nm]."""
        leg, wheel = self.actuators.leg.torque, self.actuators.wheel.torque
        return np.array([[leg, leg, wheel]] * 2)

    @cached_property
    def native(self) -> _core.Robot:
        """The planar robot of the native core; to change one, copy it first (`copy.copy`)."""
        from .native import native_robot  # it imports this file

        return native_robot(self)

    @cached_property
    def planar(self) -> Planar:
        """The numbers of the x-z plane, for compiled code."""
        front, rear = self.joints.front, self.joints.rear
        return Planar(
            hip_front_x=self.hips.front[0],
            hip_front_z=self.hips.front[1],
            hip_rear_x=self.hips.rear[0],
            hip_rear_z=self.hips.rear[1],
            half_length=self.trunk.size[0] / 2,
            half_height=self.trunk.size[2] / 2,
            thigh=self.thigh.length,
            calf=self.calf.length,
            thigh_radius=self.thigh.radius,
            calf_radius=self.calf.radius,
            wheel_radius=self.wheel.radius,
            mass=self.mass,
            trunk_mass=self.trunk.mass,
            thigh_mass=2 * self.thigh.mass,
            calf_mass=2 * self.calf.mass,
            wheel_mass=2 * self.wheel.mass,
            thigh_com=self.thigh.com,
            calf_com=self.calf.com,
            knee_front=front.knee,
            knee_rear=rear.knee,
            thigh_front_min=front.thigh[0],
            thigh_front_max=front.thigh[1],
            calf_front_min=front.calf[0],
            calf_front_max=front.calf[1],
            thigh_rear_min=rear.thigh[0],
            thigh_rear_max=rear.thigh[1],
            calf_rear_min=rear.calf[0],
            calf_rear_max=rear.calf[1],
            leg_torque=self.actuators.leg.torque,
            leg_speed=self.actuators.leg.speed,
            wheel_torque=self.actuators.wheel.torque,
            wheel_speed=self.actuators.wheel.speed,
            nominal_height=self.nominal_height,
        )


class Planar(NamedTuple):
    """The robot in the x-z plane, SI units; link and wheel masses are those of a leg pair."""

    hip_front_x: float
    hip_front_z: float
    hip_rear_x: float
    hip_rear_z: float
    half_length: float
    half_height: float
    thigh: float
    calf: float
    thigh_radius: float
    calf_radius: float
    wheel_radius: float
    mass: float
    trunk_mass: float
    thigh_mass: float
    calf_mass: float
    wheel_mass: float
    thigh_com: float
    calf_com: float
    knee_front: float
    knee_rear: float
    thigh_front_min: float
    thigh_front_max: float
    calf_front_min: float
    calf_front_max: float
    thigh_rear_min: float
    thigh_rear_max: float
    calf_rear_min: float
    calf_rear_max: float
    leg_torque: float
    leg_speed: float
    wheel_torque: float
    wheel_speed: float
    nominal_height: float
