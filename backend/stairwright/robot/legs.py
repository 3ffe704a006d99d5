"""A robot's legs and body as planner, controller and simulator see them: everything filled in.

A document may leave out what follows from the rest (rear legs like the front ones, one motor for
thigh and calf, straight capsules); here nothing is left out. SI units; frames of `description`.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats

from .parts import (
    Actuator,
    Actuators,
    Hips,
    Joints,
    LegLimits,
    Link,
    Outline,
    Payload,
    RearLegs,
    Trunk,
    Wheel,
)

Vector2 = tuple[float, float]
Capsule = tuple[Vector2, Vector2, float]  # ends in the link's frame, radius


@dataclass(frozen=True)
class LinkForm:
    """A thigh or a calf.

    Attributes:
        length: From joint to joint [m].
        com: Mass centre in the link's frame: x, z [m].
        mass: [kg]
        inertia: Ixx, Iyy, Izz about the mass centre [kg m^2].
        capsules: What may touch the terrain or the other legs.
    """

    length: float
    com: Vector2
    mass: float
    inertia: tuple[float, float, float]
    capsules: tuple[Capsule, ...]

    @property
    def radius(self) -> float:
        """Of its thickest capsule [m]."""
        return max(radius for _, _, radius in self.capsules)

    def disc_round(self, place: Vector2) -> float:
        """Radius of the largest disc round `place`, in its frame, that a capsule holds [m]."""
        return max(r - _distance(place, a, b) for a, b, r in self.capsules)

    @property
    def com_along(self) -> Vector2:
        """The mass centre in terms of the line between the joints: shares of it along, across.

        It lies at upper + along * d + across * (-d_z, d_x), d = lower - upper joint: no angle is
        needed.
        """
        return -self.com[1] / self.length, self.com[0] / self.length


@dataclass(frozen=True)
class Leg:
    """The legs of a pair, which are alike; masses are those of one leg."""

    hip: Vector2
    thigh: LinkForm
    calf: LinkForm
    wheel: Wheel
    limits: LegLimits
    thigh_motor: Actuator
    calf_motor: Actuator
    wheel_motor: Actuator

    @property
    def knee(self) -> float:
        """+1 if the calf turns forward, -1 if it turns backward."""
        return self.limits.knee

    @property
    def reach(self) -> float:
        """Distance from hip to wheel of a straight leg [m]."""
        return self.thigh.length + self.calf.length

    @property
    def mass(self) -> float:
        """Of one leg [kg]."""
        return self.thigh.mass + self.calf.mass + self.wheel.mass

    @property
    def motors(self) -> tuple[Actuator, Actuator, Actuator]:
        """Of thigh, calf and wheel."""
        return self.thigh_motor, self.calf_motor, self.wheel_motor


@dataclass(frozen=True)
class Body:
    """The trunk with all that is fixed to it: mass [kg], mass centre [m], moments about it."""

    mass: float
    com: tuple[float, float, float]
    inertia: tuple[float, float, float]
    outline: tuple[Outline, ...]

    @property
    def corners(self) -> Floats:
        """(n, 2) corners of all pieces [m]."""
        return np.array([point for piece in self.outline for point in piece.points])

    def top(self, x: float) -> tuple[float, float]:
        """(x, z) of the highest point at `x`, or at the trunk's end where `x` is beyond it [m]."""
        x = float(np.clip(x, self.corners[:, 0].min(), self.corners[:, 0].max()))
        heights = [
            z0 + (z1 - z0) * (x - x0) / (x1 - x0)
            for piece in self.outline
            for (x0, z0), (x1, z1) in itertools.pairwise([*piece.points, piece.points[0]])
            if x0 != x1 and min(x0, x1) <= x <= max(x0, x1)
        ]
        return x, max(heights, default=float(self.corners[:, 1].max()))

    @property
    def span(self) -> float:
        """Largest distance of a corner from the trunk point [m]."""
        return float(np.hypot(*self.corners.T).max())


def legs_of(
    hips: Hips,
    thigh: Link,
    calf: Link,
    wheel: Wheel,
    joints: Joints,
    actuators: Actuators,
    rear: RearLegs | None,
) -> tuple[Leg, Leg]:
    """Front and rear leg; `rear` holds what differs in the rear one."""
    parts = ("thigh", "calf", "wheel")
    front_leg = Leg(
        hips.front, _form(thigh), _form(calf), wheel, joints.front, *map(actuators.of, parts)
    )
    rear_leg = Leg(
        hips.rear,
        _form((rear and rear.thigh) or thigh),
        _form((rear and rear.calf) or calf),
        (rear and rear.wheel) or wheel,
        joints.rear,
        *map(((rear and rear.actuators) or actuators).of, parts),
    )
    return front_leg, rear_leg


def body_of(trunk: Trunk, load: Payload | None) -> Body:
    """Trunk and payload as one body."""
    outline = tuple(trunk.outline) or (box(*trunk.size),)
    if load is None:
        return Body(trunk.mass, trunk.com, trunk.inertia, outline)
    mass = trunk.mass + load.mass
    own, place = np.array(trunk.com), np.array([load.place[0], 0.0, load.place[1]])
    com = (trunk.mass * own + load.mass * place) / mass
    moments = np.array(trunk.inertia)
    for part, centre in ((trunk.mass, own), (load.mass, place)):
        off = centre - com
        moments = moments + part * (off @ off - off**2)
    x, y, z = com.tolist()
    a, b, c = moments.tolist()
    return Body(mass, (x, y, z), (a, b, c), outline)


def box(length: float, width: float, height: float) -> Outline:
    """The outline of a box round the trunk point."""
    x, z = length / 2, height / 2
    corners = [(-x, -z), (x, -z), (x, z), (-x, z)]
    return Outline.model_construct(points=corners, width=width)  # of any size


def _form(link: Link) -> LinkForm:
    com = link.com if isinstance(link.com, tuple) else (0.0, -link.com * link.length)
    capsules: tuple[Capsule, ...] = tuple(
        (shape.start, shape.end, shape.radius) for shape in link.shape
    ) or (((0.0, 0.0), (0.0, -link.length), link.radius),)
    return LinkForm(link.length, com, link.mass, link.inertia, capsules)


def _distance(place: Vector2, start: Vector2, end: Vector2) -> float:
    """Of a point from a line between two others."""
    along = (end[0] - start[0], end[1] - start[1])
    off = (place[0] - start[0], place[1] - start[1])
    squared = along[0] ** 2 + along[1] ** 2
    share = (off[0] * along[0] + off[1] * along[1]) / squared if squared > 0.0 else 0.0
    share = min(max(share, 0.0), 1.0)
    return math.hypot(off[0] - share * along[0], off[1] - share * along[1])
