"""The robot along a path, and what moving along it takes: derivatives by the way, and momentum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stairwright.planning.poses.pose_reference import Reference
from stairwright.robot import kinematics
from stairwright.robot.description import Robot

from .way import even_grid, slopes, way_of

Floats = NDArray[np.float64]

REACH = 0.0125  # m; derivatives are differences over this far, both ways


@dataclass(frozen=True)
class MovingRobot:
    """A motion on an even grid of way (n,) [m]: values, and first and second derivatives by it.

    Attributes:
        way: (n,) [m].
        progress: (n,) the plan's [m].
        wheels, joints, trunk, com: Triples of (n, 2), (n, 4), (n, 3), (n, 2).
        momentum: Angular momentum (n,) about the CoM, about +y, per speed along the way [kg m],
            and its derivative; legs and the wheels' spin count.
        height: (n,) of the CoM above the lower wheel [m].
    """

    way: Floats
    progress: Floats
    wheels: tuple[Floats, Floats, Floats]
    joints: tuple[Floats, Floats, Floats]
    trunk: tuple[Floats, Floats, Floats]
    com: tuple[Floats, Floats, Floats]
    momentum: tuple[Floats, Floats]
    height: Floats

    @property
    def step(self) -> float:
        """Between samples [m]."""
        return float(self.way[1] - self.way[0])


def moving_robot(reference: Reference, robot: Robot) -> MovingRobot:
    """`robot` along `reference`."""
    at = way_of(reference)
    grid = even_grid(at)

    def sampled(values: Floats) -> tuple[Floats, Floats, Floats]:
        even = np.array([np.interp(grid, at, column) for column in values.T]).T
        first = slopes(grid, at, values, REACH)
        return even, first, slopes(grid, grid, first, REACH)

    joints, trunk = sampled(reference.q), sampled(reference.trunk)
    wheels, com = sampled(reference.wheel_progress), sampled(reference.com)
    x, z, pitch = trunk[0].T
    frames = kinematics.forward(robot, x, z, pitch, joints[0])
    momentum = _momentum(robot, grid, frames, wheels[0], joints[0], trunk[0], com[0])
    return MovingRobot(
        way=grid,
        progress=np.interp(grid, at, reference.progress),
        wheels=wheels,
        joints=joints,
        trunk=trunk,
        com=com,
        momentum=(momentum, slopes(grid, grid, momentum, REACH)),
        height=com[0][:, 1] - frames.wheels[..., 1].min(axis=1) + robot.wheel.radius,
    )


def _momentum(
    robot: Robot, grid: Floats, frames: kinematics.Frames, wheels: Floats, joints: Floats,
    trunk: Floats, com: Floats,
) -> Floats:  # fmt: skip
    """Angular momentum (n,) of all bodies about the CoM per speed along the way [kg m]."""
    pitch = trunk[:, 2]

    def part(mass: float, inertia: float, place: Floats, angle: Floats) -> Floats:
        r, v = place - com, slopes(grid, grid, place, REACH)
        turn = slopes(grid, grid, angle, REACH)
        total: Floats = mass * (r[:, 1] * v[:, 0] - r[:, 0] * v[:, 1]) + inertia * turn
        return total

    body = robot.body
    middle = trunk[:, :2] + kinematics.rotate(pitch, np.array([body.com[0], body.com[2]]))
    momentum = part(body.mass, body.inertia[1], middle, pitch)
    for k, leg in enumerate(robot.legs):
        hip, knee, wheel = frames.hips[:, k], frames.knees[:, k], frames.wheels[:, k]
        thigh = pitch + joints[:, 2 * k]
        calf, spin = thigh + joints[:, 2 * k + 1], wheels[:, k] / robot.wheel.radius
        for link, place, angle in (
            (leg.thigh, kinematics.link_com(leg.thigh, hip, knee), thigh),
            (leg.calf, kinematics.link_com(leg.calf, knee, wheel), calf),
            (leg.wheel, wheel, spin),
        ):
            momentum += 2 * part(link.mass, link.inertia[1], place, angle)
    return momentum
