"""What the controller knows where nothing is hidden from it: the whole state, noisy and late.

The numpy form of `native/src/rollout/sensor_model.cpp`; the random numbers of both are drawn here.
"""

from __future__ import annotations

import math

import numpy as np

from stairwright.arrays import Floats, Ints

from .disturbance import Disturbance

# Standard deviations of the sensors at noise 1: a good joint encoder, IMU and state estimator.
JOINT_NOISE = 0.001  # rad
JOINT_RATE_NOISE = 0.05  # rad/s
POSITION_NOISE = 0.001  # m
VELOCITY_NOISE = 0.02  # m/s
TILT_NOISE = 0.002  # rad
GYRO_NOISE = 0.02  # rad/s


class Sensors:
    """What the controller sees: the truth with noise, some control steps late.

    Attributes:
        history: (delay + 1, 37) ring of the last measurements, qpos and qvel.
        seen: (1,) number of measurements so far.
    """

    def __init__(self, disturbance: Disturbance, dt: float, seed: int, start: float = 0.0) -> None:
        self.disturbance, self.start = disturbance, start  # start: x that is believed there [m]
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
        out, wrong = (np.empty(19), np.empty(18)), self.disturbance
        qpos = qpos.copy()
        qpos[0] += wrong.x_offset
        qpos[0] += wrong.odometry_scale * (qpos[0] - self.start)
        w, x, y, z = qpos[3:7]
        c, s = math.cos(wrong.pitch_bias / 2), math.sin(wrong.pitch_bias / 2)
        qpos[3:7] = w * c - y * s, x * c - z * s, y * c + w * s, z * c + x * s
        perceive(qpos, qvel, self.draws(1), 0, self.history, self.seen, *out)
        return out


def perceive(
    qpos: Floats,
    qvel: Floats,
    draws: Floats,
    k: int,
    history: Floats,
    seen: Ints,
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
