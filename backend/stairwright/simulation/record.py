"""Records the series of a rollout."""

from __future__ import annotations

from typing import Any

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats, Ints
from stairwright.control.setpoint import JOINTS, PITCH, PROGRESS
from stairwright.robot.description import LEGS

from .governor import Track
from .result import Series

# Columns of a sample.
_TIME = 0
_QPOS, _QVEL, _TORQUE = slice(1, 20), slice(20, 38), slice(38, 50)
_CONTACTS, _PROGRESS, _TARGET = slice(50, 66), 66, slice(67, 74)
PLACES = slice(74, 78)
_WIDTH = 78


class Recorder:
    """Takes a sample every few control steps.

    Args:
        every: Control steps between samples.
        track: What is carried out.
        radius: Of the wheels [m].
        native: The loop that keeps the samples itself, if it is the native one.

    Attributes:
        samples: (capacity, 78), the first `len(recorder)` of them taken; not used beside `native`.
        cursor: (2,) number of samples, and control steps to let pass before the next.
    """

    def __init__(
        self, every: int, track: Track, radius: float, native: _core.Rollout | None = None
    ) -> None:
        self.native = native
        self.every, self.track, self.radius = every, track, radius
        self.samples = np.empty((1024, _WIDTH))
        self.cursor = np.zeros(2, np.int64)

    def reserve(self, steps: int) -> None:
        """Make room for the samples of `steps` more control steps."""
        if len(self) + steps > len(self.samples):
            self.samples = np.vstack([self.samples, np.empty((len(self) + steps, _WIDTH))])

    def take(self, data: Any, target: Floats, places: Floats) -> None:
        """Keep the state of `data` (an MjData) and what was asked for, if it is time to."""
        self.reserve(1)
        state = (data.time, data.qpos, data.qvel, data.ctrl, data.sensordata)
        keep_sample(self.every, self.cursor, self.samples, *state, target, places)

    def __len__(self) -> int:
        """How many samples there are."""
        return int(self.cursor[0]) if self.native is None else self.native.sample_count

    def series(self, first: int = 0, stride: int = 1) -> Series:
        """Every `stride`-th sample from `first` on, up to the first that is not finite."""
        if self.native is not None:
            rows = self.native.samples(first, stride)
        else:
            rows = self.samples[first : len(self) : stride]
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        rows = rows[: bad[0]] if len(bad) else rows
        qpos, target, n = rows[:, _QPOS], rows[:, _TARGET], len(rows)
        w, x, y, z = qpos[:, 3:7].T
        pitch = np.arctan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y))
        # Sensors report the force on the ground; turn it into the force on the wheel.
        forces = -rows[:, _CONTACTS].reshape(n, len(LEGS), 4)[:, :, [1, 3]]
        return Series(
            time=rows[:, _TIME].copy(),
            base_position=qpos[:, :3].copy(),
            base_quaternion=qpos[:, 3:7].copy(),
            q=qpos[:, 7:].copy(),
            q_desired=self._desired(target),
            dq=rows[:, _QVEL][:, 6:].copy(),
            torque=rows[:, _TORQUE].copy(),
            pitch=np.unwrap(pitch),
            pitch_desired=target[:, PITCH].copy(),
            progress=self._progress(rows[:, PLACES]),
            progress_desired=rows[:, _PROGRESS].copy(),
            contact_force=forces,
        )

    def _progress(self, places: Floats) -> Floats:
        """Mean place of the wheels on the plan's scale of progress."""
        first = self.track.rows[0]
        mean: Floats = places.mean(axis=1) - first[:2].mean() + self.track.start
        return mean

    def _desired(self, target: Floats) -> Floats:
        """(n, 12) joints; a wheel's angle is what rolling without slip gives."""
        out = np.empty((len(target), 12))
        for leg in range(4):
            pair = leg // 2
            q = target[:, JOINTS.start + 2 * pair : JOINTS.start + 2 * pair + 2]
            turned = q.sum(axis=1) + target[:, PITCH]
            first = self.track.rows[0]
            start = first[JOINTS.start + 2 * pair : JOINTS.start + 2 * pair + 2].sum()
            rolled = (target[:, pair] - first[pair]) / self.radius
            out[:, 3 * leg : 3 * leg + 2] = q
            out[:, 3 * leg + 2] = rolled - (turned - start - first[PITCH])
        return out


def keep_sample(
    every: int,
    cursor: Ints,
    samples: Floats,
    time: float,
    qpos: Floats,
    qvel: Floats,
    torque: Floats,
    contacts: Floats,
    target: Floats,
    places: Floats,
) -> None:
    """Write the next row of `samples`, if it is time to; see `Recorder`."""
    if cursor[1] > 0:
        cursor[1] -= 1
        return
    cursor[1] = every - 1
    row = samples[cursor[0]]
    cursor[0] += 1
    row[0] = time
    row[1:20], row[20:38], row[38:50] = qpos, qvel, torque
    row[50:66], row[66], row[67:74] = contacts[:16], target[PROGRESS], target[:7]
    row[74:78] = places
