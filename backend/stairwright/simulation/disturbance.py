"""What may differ between the plan's world and the real one: one set of deviations of a trial."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from stairwright.arguments import as_model
from stairwright.documents import Model
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

Floats = NDArray[np.float64]

# Standard deviations of the sensors at noise 1: a good joint encoder, IMU and state estimator.
JOINT_NOISE = 0.001  # rad
JOINT_RATE_NOISE = 0.05  # rad/s
POSITION_NOISE = 0.001  # m
VELOCITY_NOISE = 0.02  # m/s
TILT_NOISE = 0.002  # rad
GYRO_NOISE = 0.02  # rad/s


class Disturbance(Model):
    """Deviations of one rollout from what the plan and the controller believe."""

    friction: float = Field(0.0, ge=-5.0, le=5.0, description="added to the true friction")
    mass: float = Field(0.0, ge=-0.5, le=1.0, description="share of the robot's mass, on the trunk")
    com_x: float = Field(0.0, ge=-0.2, le=0.2, description="the robot's CoM moves forward [m]")
    com_z: float = Field(0.0, ge=-0.2, le=0.2, description="the robot's CoM moves up [m]")
    height: float = Field(0.0, ge=-0.2, le=0.2, description="added to the terrain's rise [m]")
    noise: float = Field(0.0, ge=0.0, le=20.0, description="sensor noise, in units of the module's")
    delay: float = Field(0.0, ge=0.0, le=0.1, description="from sensing to torque [s]")


def parse_disturbance(value: Mapping[str, Any] | Disturbance | None) -> Disturbance:
    """A disturbance with zeros filled in.

    Raises:
        InputError: For an unknown name or a value out of bounds.
    """
    return as_model(Disturbance, value, "disturbance")


def real_terrain(terrain: Terrain, height: float) -> Terrain:
    """The terrain with its rise (highest minus lowest point) changed by `height` [m]."""
    z = np.array(terrain.points)[:, 1]
    rise = float(np.ptp(z))
    if height == 0.0 or rise < 1e-6:
        return terrain
    factor = max(0.0, 1.0 + height / rise)
    base = terrain.points[0][1]
    points = [(x, base + factor * (z - base)) for x, z in terrain.points]
    return Terrain(
        name=terrain.name,
        points=points,
        friction=terrain.friction,
        start=terrain.start,
        goal=terrain.goal,
    )


def disturb_trunk(spec: Any, robot: Robot, disturbance: Disturbance) -> None:
    """Change the trunk of an uncompiled model: mass, and its place so that the CoM moves."""
    trunk = spec.body("trunk")
    added = disturbance.mass * robot.mass
    body = robot.body
    mass = max(0.1, body.mass + added)
    total = robot.mass - body.mass + mass
    trunk.mass = mass
    trunk.inertia = [value * mass / body.mass for value in body.inertia]
    x, y, z = body.com
    trunk.ipos = [
        x + disturbance.com_x * total / mass, y, z + disturbance.com_z * total / mass
    ]  # fmt: skip


class Sensors:
    """What the controller sees: the truth with noise, some control steps late.

    Attributes:
        history: (delay + 1, 37) ring of the last measurements, qpos and qvel.
        seen: (1,) number of measurements so far.
    """

    def __init__(self, disturbance: Disturbance, dt: float, seed: int) -> None:
        self.noise = disturbance.noise
        self.random = np.random.default_rng(seed)
        self.history = np.zeros((1 + round(disturbance.delay / dt), 37))
        self.seen = np.zeros(1, np.int64)
        place, turn = [POSITION_NOISE] * 3 + [0.0] * 4, [0.5 * TILT_NOISE] * 3
        speed, joints = [VELOCITY_NOISE] * 3 + [GYRO_NOISE] * 3, [JOINT_NOISE] * 12
        self._scale = np.array([*place, *joints, *speed, *[JOINT_RATE_NOISE] * 12, *turn])

    def draws(self, count: int) -> Floats:
        """(count, 40) noise of as many measurements; (0, 40) if there is none.

        Added to qpos (19) and qvel (18), and half a small turn about each axis of the trunk (3).
        """
        if self.noise == 0.0:
            return np.zeros((0, 40))
        noise: Floats = self.noise * self._scale * self.random.standard_normal((count, 40))
        return noise

    def sense(self, qpos: Floats, qvel: Floats) -> tuple[Floats, Floats]:
        """Measured `qpos` (19,) and `qvel` (18,)."""
        out = np.empty(19), np.empty(18)
        perceive(qpos, qvel, self.draws(1), 0, self.history, self.seen, *out)
        return out


def perceive(
    qpos: Floats,
    qvel: Floats,
    draws: Floats,
    k: int,
    history: Floats,
    seen: NDArray[np.int64],
    out_qpos: Floats,
    out_qvel: Floats,
) -> None:
    """What the controller sees of `qpos` and `qvel`, into `out_*`; noise is row `k` of `draws`."""
    size = len(history)
    new = history[seen[0] % size]
    new[:19], new[19:] = qpos, qvel
    if len(draws):
        draw = draws[k]
        new += draw[:37]
        w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
        a, b, c = draw[37], draw[38], draw[39]
        new[3], new[4] = w - x * a - y * b - z * c, x + w * a + y * c - z * b
        new[5], new[6] = y + w * b + z * a - x * c, z + w * c + x * b - y * a
        length = math.sqrt(new[3] ** 2 + new[4] ** 2 + new[5] ** 2 + new[6] ** 2)
        for i in range(3, 7):
            new[i] /= length
    old = history[max(0, seen[0] - size + 1) % size]
    out_qpos[:], out_qvel[:] = old[:19], old[19:]
    seen[0] += 1
