"""Dynamic balance of a plan that moves fast, by inverse dynamics of its own (Newton and Euler).

Bodies are trunk, thighs, calves and wheels; their accelerations are differences of the poses over
`WINDOW` both ways, so what lasts shorter is taken as spread over it. At every pose one linear
program asks for the contact forces inside the friction cones that balance weight and inertia with
the least share of what the motors can give at their speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stairwright import _core
from stairwright._core import GRAVITY
from stairwright.arrays import Flags, Floats, Ints
from stairwright.planning.certificate.equilibrium import TOUCH, WHEEL_GAP, touching
from stairwright.planning.plan import Check, Plan
from stairwright.planning.pose_arrays import PoseArrays
from stairwright.robot import kinematics as kin
from stairwright.robot.description import Robot

WINDOW = 0.1  # s
_EXACT = 1e-4  # of the weight, and of the weight times metres; forces that miss less balance
_LEAST_TORQUE = 1e-3  # of a motor's torque, that counts where its speed leaves none
_DOWN = np.array([0.0, -GRAVITY])


@dataclass(frozen=True)
class Dynamics:
    """What moving as planned takes at every pose (n).

    Attributes:
        progress: (n,) [m].
        time: (n,) [s].
        share: (n,) of what the motors can give, at least.
        missed: (n,) what the forces lack to balance, in weights or weights times metres.
    """

    progress: Floats
    time: Floats
    share: Floats
    missed: Floats

    @property
    def out_of_balance(self) -> Flags:
        """(n,) flags."""
        return self.missed > _EXACT

    @property
    def overloaded(self) -> Flags:
        """(n,) flags."""
        return self.share > 1.0

    def checks(self) -> list[Check]:
        """For the certificate."""
        failed, hardest = int(self.out_of_balance.sum()), int(np.argmax(self.share))
        return [
            Check(
                name="poses out of dynamic balance", value=float(failed), bound=0.0, unit="1",
                passed=not failed,
                progress=float(self.progress[np.argmax(self.missed)]) if failed else None,
            ),
            Check(
                name="share of the motors in motion", value=float(self.share[hardest]), bound=1.0,
                unit="1", passed=not self.overloaded.any(), progress=float(self.progress[hardest]),
            ),
        ]  # fmt: skip


def dynamics_of(plan: Plan, time: Floats | None = None, at: Ints | None = None) -> Dynamics:
    """Dynamics along the poses of a plan.

    Args:
        plan: Of method ``path``.
        time: (n,) of its poses, rising [s]; those of the plan if not given.
        at: Numbers of the poses that are looked at; all if not given.
    """
    poses = PoseArrays.of(plan)
    time = poses.time if time is None else time
    at = np.arange(len(time)) if at is None else at
    share, missed = _forces(plan, _Motion.of(plan.robot_description, poses, time).part(at))
    return Dynamics(poses.progress[at], time[at], share, missed)


@dataclass(frozen=True)
class _Body:
    """A body, or two of them side by side: places (n, 2) [m], angles (n,) [rad]."""

    mass: float
    inertia: float
    place: Floats
    acceleration: Floats
    turning: Floats

    def load(self, about: Floats) -> Floats:
        """Force x, force z and moment about a point (n, 2) that it takes to move it so (n, 3)."""
        force = self.mass * (self.acceleration - _DOWN)
        moment = _moment(self.place - about, force) + self.inertia * self.turning
        return np.column_stack([force, moment])


def _moment(lever: Floats, force: Floats) -> Floats:
    """About +y (...,)."""
    product: Floats = lever[..., 1] * force[..., 0] - lever[..., 0] * force[..., 1]
    return product


class _Times:
    """Differences of values (n, ...) at times (n,)."""

    def __init__(self, time: Floats) -> None:
        self.time = time
        self.sides = [np.clip(time + side, time[0], time[-1]) for side in (-WINDOW, 0.0, WINDOW)]

    def at(self, moment: Floats, values: Floats) -> Floats:
        columns = values.reshape(len(values), -1).T
        found = np.stack([np.interp(moment, self.time, column) for column in columns], axis=-1)
        return found.reshape(values.shape)

    def rate(self, values: Floats) -> Floats:
        before, _, after = self.sides
        change = self.at(after, values) - self.at(before, values)
        return (change.T / (after - before)).T

    def acceleration(self, values: Floats) -> Floats:
        """The robot stands before the first and after the last time."""
        low, middle, high = (self.at(side, values) for side in self.sides)
        change: Floats = (high - 2.0 * middle + low) / WINDOW**2
        return change


@dataclass(frozen=True)
class _Motion:
    """What a robot's poses take: bodies, and by pair what its motors turn.

    Attributes:
        frames: Hips, knees, wheels.
        com: (n, 2) [m].
        loads: (n, 3) force x, force z, moment about the CoM of all bodies [N, N, Nm].
        torques: (n, 6) of thigh, calf, wheel of one front and of one rear leg, without contact.
        lowest, highest: (n, 6) what the motors can give at their speed [Nm].
    """

    frames: kin.Frames
    com: Floats
    loads: Floats
    torques: Floats
    lowest: Floats
    highest: Floats

    @classmethod
    def of(cls, robot: Robot, poses: PoseArrays, time: Floats) -> _Motion:
        times, joints = _Times(time), poses.q
        x, z, pitch = poses.body.T
        spins = poses.s / robot.wheel.radius
        frames = kin.forward(robot, x, z, pitch, joints)
        com = kin.com(robot, x, z, pitch, frames)

        def body(mass: float, inertia: float, place: Floats, angle: Floats) -> _Body:
            return _Body(mass, inertia, place, times.acceleration(place), times.acceleration(angle))

        trunk = np.stack([x, z], axis=1) + kin.rotate(pitch, np.array(robot.body.com)[[0, 2]])
        loads = body(robot.body.mass, robot.body.inertia[1], trunk, pitch).load(com)
        torques, lowest, highest = [], [], []
        for k, leg in enumerate(robot.legs):
            hip, knee, wheel = (p[:, k] for p in (frames.hips, frames.knees, frames.wheels))
            upper = pitch + joints[:, 2 * k]
            lower = upper + joints[:, 2 * k + 1]
            links = [
                body(link.mass, link.inertia[1], place, angle)
                for link, place, angle in (
                    (leg.thigh, kin.link_com(leg.thigh, hip, knee), upper),
                    (leg.calf, kin.link_com(leg.calf, knee, wheel), lower),
                    (leg.wheel, wheel, spins[:, k]),
                )
            ]
            turned = (joints[:, 2 * k], joints[:, 2 * k + 1], spins[:, k] - lower)
            for j, (joint, angle) in enumerate(zip((hip, knee, wheel), turned, strict=True)):
                loads = loads + 2.0 * links[j].load(com)
                motor, most = leg.motors[j], robot.torque_limits[k, j]
                rotor = motor.armature * times.acceleration(angle)
                torques.append(sum(link.load(joint)[:, 2] for link in links[j:]) + rotor)
                speed = times.rate(angle) / motor.speed
                highest.append(most * np.clip(1.0 - np.maximum(speed, 0.0), _LEAST_TORQUE, 1.0))
                lowest.append(-most * np.clip(1.0 + np.minimum(speed, 0.0), _LEAST_TORQUE, 1.0))
        columns = (np.column_stack(each) for each in (torques, lowest, highest))
        return cls(frames, com, loads, *columns)

    def part(self, at: Ints) -> _Motion:
        """At some of the poses."""
        frames = kin.Frames(self.frames.hips[at], self.frames.knees[at], self.frames.wheels[at])
        columns = (self.com, self.loads, self.torques, self.lowest, self.highest)
        return _Motion(frames, *(column[at] for column in columns))


def _forces(plan: Plan, motion: _Motion) -> tuple[Floats, Floats]:
    """Least share of the motors (n,), and by how much the wrench is missed (n,) in weights."""
    robot = plan.robot_description
    n, weight = len(motion.com), robot.mass * GRAVITY
    centres = motion.frames.wheels.reshape(-1, 2)
    radius = robot.wheel.radius
    points, normals, found = touching(
        plan.terrain.vertices, centres, radius + WHEEL_GAP, np.full(len(centres), radius + TOUCH)
    )
    tangents = np.stack([normals[..., 1], -normals[..., 0]], axis=-1)
    edges = np.stack(
        [normals + side * plan.least_friction * tangents for side in (1.0, -1.0)], axis=2
    )
    edges *= found[:, :, None, None]
    # By pose: pair, face and edge (n, 2, 6).
    edges = edges.reshape(n, 2, -1, 2)
    points = np.repeat(points, 2, axis=1).reshape(edges.shape)
    moments = _moment(points - motion.com[:, None, None], edges)
    wrenches = np.concatenate([edges, moments[..., None]], axis=-1)
    joints = np.stack([motion.frames.hips, motion.frames.knees, motion.frames.wheels], axis=2)
    # Half of a pair's force turns each of its legs, and none turns the other pair's.
    turned = np.zeros((n, 2, edges.shape[2], 2, 3))
    for pair in (0, 1):
        levers = points[:, pair, :, None] - joints[:, pair, None]
        turned[:, pair, :, pair] = -0.5 * weight * _moment(levers, edges[:, pair, :, None])
    return _core.certificate_least_share(
        wrenches.reshape(n, -1, 3), turned.reshape(n, -1, 6), motion.loads / weight,
        motion.torques, motion.lowest, motion.highest,
    )  # fmt: skip
