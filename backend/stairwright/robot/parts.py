"""The parts of a robot's document, each with its bounds and units. Frames: see `description`."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from stairwright.documents import EITHER, NUMBER, OTHER, Model
from stairwright.errors import InputError

BENT = 0.05  # rad; a knee whose range contains a straight leg keeps this far from it in plans

Positive = Annotated[float, Field(gt=0.0, le=1000.0)]
# The least are far below any robot's and far above what the simulator takes for nothing.
Mass = Annotated[float, Field(ge=1e-6, le=1000.0)]
Moment = Annotated[float, Field(ge=1e-12, le=1000.0)]
Place = Annotated[float, Field(ge=-100.0, le=100.0)]
Point = tuple[Place, Place]
MassCentre = Annotated[
    Annotated[float, Field(ge=0.0, le=1.0), NUMBER] | Annotated[Point, OTHER], EITHER
]
Angle = Annotated[float, Field(ge=-5 * math.pi, le=5 * math.pi)]
Range = tuple[Angle, Angle]


def optional(default: Any = None, **info: Any) -> Any:
    """A field that documents and hashes leave out while it has its default.

    Robots without it are the ones they were before there was such a field.
    """
    return Field(default, exclude_if=lambda value: value == default, **info)


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


class Outline(Model):
    """A convex piece of the trunk, seen from the side and extruded along y."""

    points: list[Point] = Field(
        min_length=3, max_length=64, description="convex, (x, z) in the trunk frame [m]"
    )
    width: Positive = Field(description="along y [m]")

    @model_validator(mode="after")
    def _check_convex(self) -> Outline:
        n = len(self.points)
        turns = []
        for k in range(n):
            (ax, az), (bx, bz), (cx, cz) = (self.points[(k + m) % n] for m in range(3))
            turns.append((bx - ax) * (cz - bz) - (bz - az) * (cx - bx))
        area = sum(
            a[0] * b[1] - a[1] * b[0]
            for a, b in zip(self.points, self.points[1:] + self.points[:1], strict=True)
        )
        if abs(area) < 1e-9 or min(turns) * max(turns) < -1e-18:
            raise InputError("must be a convex polygon, its points in order", ("points",))
        return self


class Trunk(Model):
    """The body box; its centre is the trunk point (x_c, z_c)."""

    size: tuple[Positive, Positive, Positive] = Field(description="length, width, height [m]")
    mass: Mass = Field(description="[kg]")
    inertia: Inertia = Field(description="Ixx, Iyy, Izz about the mass centre [kg m^2]")
    com: tuple[Place, Place, Place] = optional(
        (0.0, 0.0, 0.0), description="mass centre from the trunk point [m]"
    )
    outline: list[Outline] = optional(
        [], max_length=32, description="what may touch the terrain; the box if empty"
    )


class Payload(Model):
    """A load that is fixed to the trunk."""

    mass: Mass = Field(description="[kg]")
    place: tuple[Place, Place] = Field((0.0, 0.0), description="(x, z) in the trunk frame [m]")


class Hips(Model):
    """Hip axes in the trunk frame: (x, z) of the front and the rear one, and the legs' y."""

    front: tuple[float, float]
    rear: tuple[float, float]
    half_track: Positive = Field(description="distance of the leg planes from the middle [m]")


class LinkShape(Model):
    """A capsule of a link that is not one straight capsule from joint to joint."""

    start: Point = Field(description="(x, z) in the link's frame [m]")
    end: Point = Field(description="(x, z) in the link's frame [m]")
    radius: Positive = Field(description="[m]")


class Link(Model):
    """A thigh or a calf: its frame sits in its upper joint; at angle 0 the lower one is below it.

    A bent shank is one whose capsules leave that line.
    """

    length: float = Field(ge=1e-3, le=1000.0, description="from joint to joint [m]")
    radius: Positive = Field(description="of the capsule [m]")
    mass: Mass = Field(description="[kg]")
    com: MassCentre = Field(
        description="mass centre: a fraction of the length, or (x, z) in the link's frame [m]"
    )
    inertia: Inertia = Field(description="Ixx, Iyy, Izz about the mass centre [kg m^2]")
    shape: list[LinkShape] = optional(
        [], max_length=16, description="capsules; one from joint to joint if empty"
    )


class Wheel(Model):
    """A wheel at the end of each calf."""

    radius: Positive = Field(description="[m]")
    width: Positive = Field(description="[m]")
    mass: Mass = Field(description="[kg]")
    inertia: Inertia = Field(description="Ixx, Iyy, Izz about the centre [kg m^2]")
    friction: float | None = optional(
        None, gt=0.0, le=3.0, description="most that the tyre gives on any terrain"
    )
    rolling_resistance: float = optional(
        0.0, ge=0.0, le=0.2, description="share of the load that opposes rolling"
    )


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
        return self

    @model_validator(mode="after")
    def _check_bend(self) -> LegLimits:
        if not self.ways:
            raise InputError(f"a knee must bend by more than {BENT:g} rad", ("calf",))
        return self

    @property
    def straightens(self) -> bool:
        """Whether the range contains a straight leg, so that plans keep to one side of it."""
        return self.calf[0] < 0.0 < self.calf[1]

    @property
    def ways(self) -> tuple[float, ...]:
        """The ways the knee can bend: -1 backward, +1 forward."""
        if not self.straightens:
            return (self.knee,)
        backward, forward = self.calf[0] < -BENT, self.calf[1] > BENT
        return (*((-1.0,) if backward else ()), *((1.0,) if forward else ()))

    @property
    def both_ways(self) -> bool:
        """Whether the knee bends forward and backward."""
        return len(self.ways) == 2

    @property
    def knee(self) -> float:
        """+1 if the calf turns forward (knee in front), -1 if it turns backward, or farther so."""
        return 1.0 if sum(self.calf) > 0.0 else -1.0


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
    continuous: float | None = optional(
        None, gt=0.0, le=1000.0, description="torque that it holds without end [Nm]"
    )


class Actuators(Model):
    """Motors of the leg joints (`leg`, or `thigh` and `calf` where they differ) and the wheels."""

    leg: Actuator | None = optional(None)
    thigh: Actuator | None = optional(None)
    calf: Actuator | None = optional(None)
    wheel: Actuator

    @model_validator(mode="after")
    def _check_legs(self) -> Actuators:
        for name in ("thigh", "calf"):
            if (getattr(self, name) or self.leg) is None:
                raise InputError("Field required: this or leg", (name,))
        return self

    def of(self, part: str) -> Actuator:
        """The motor of `part`: thigh, calf or wheel."""
        own: Actuator | None = getattr(self, part)
        motor = own or self.leg
        assert motor is not None
        return motor


class RearLegs(Model):
    """What the rear legs have unlike the front ones."""

    thigh: Link | None = optional(None)
    calf: Link | None = optional(None)
    wheel: Wheel | None = optional(None)
    actuators: Actuators | None = optional(None)


class JointFrame(Model):
    """How the robot's own software counts a joint: theirs = sign * (ours - offset)."""

    sign: Literal[-1, 1] = Field(1, description="-1 where its axis points to the right")
    offset: Angle = Field(0.0, description="our angle where theirs is 0 [rad]")


# Largest gains: joint stiffness [Nm/rad], joint damping, wheel damping [Nm s/rad].
MOST_STIFFNESS, MOST_DAMPING, MOST_WHEEL_DAMPING = 1e6, 1e5, 1e4


class Gains(Model):
    """Feedback gains that suit this robot; the controller's settings may override them."""

    joint_stiffness: float = Field(ge=0.0, le=MOST_STIFFNESS, description="thigh and calf [Nm/rad]")
    joint_damping: float = Field(ge=0.0, le=MOST_DAMPING, description="thigh and calf [Nm s/rad]")
    wheel_damping: float = Field(
        ge=0.0, le=MOST_WHEEL_DAMPING, description="wheel rate feedback [Nm s/rad]"
    )


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
