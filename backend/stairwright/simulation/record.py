"""Records the series of a rollout."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stairwright.control.setpoint import JOINTS, PITCH
from stairwright.robot.description import LEGS

from .governor import Track
from .result import Series

Floats = NDArray[np.float64]


class Recorder:
    """Takes a sample every few control steps.

    Args:
        every: Control steps between samples.
        track: What is carried out.
        radius: Of the wheels [m].
    """

    def __init__(self, every: int, track: Track, radius: float) -> None:
        self.every, self.track, self.radius = every, track, radius
        self._wait = 0
        self._time: list[float] = []
        self._qpos: list[Floats] = []
        self._qvel: list[Floats] = []
        self._torque: list[Floats] = []
        self._contacts: list[Floats] = []
        self._clock: list[Floats] = []
        self._target: list[Floats] = []
        self._places: list[Floats] = []

    def due(self) -> bool:
        """Whether this control step is to be recorded."""
        self._wait -= 1
        if self._wait >= 0:
            return False
        self._wait = self.every - 1
        return True

    def take(self, data: Any, clock: Floats, target: Floats, places: Floats) -> None:
        """Keep the state of `data` (an MjData) and what was asked for."""
        self._time.append(data.time)
        self._qpos.append(data.qpos.copy())
        self._qvel.append(data.qvel.copy())
        self._torque.append(data.ctrl.copy())
        self._contacts.append(data.sensordata.copy())
        self._clock.append(clock.copy())
        self._target.append(target[: PITCH + 1].copy())
        self._places.append(places.copy())

    def __len__(self) -> int:
        """How many samples there are."""
        return len(self._time)

    def series(self, first: int = 0, stride: int = 1) -> Series:
        """Every `stride`-th sample from `first` on, up to the first that is not finite."""
        part = slice(first, None, stride)
        qpos, qvel = np.array(self._qpos[part]), np.array(self._qvel[part])
        torque, target = np.array(self._torque[part]), np.array(self._target[part])
        contacts, places = np.array(self._contacts[part]), np.array(self._places[part])
        rows = np.column_stack([qpos, qvel, torque, contacts, places])
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        n = int(bad[0]) if len(bad) else len(rows)
        qpos, qvel, torque, target = qpos[:n], qvel[:n], torque[:n], target[:n]
        clock = np.array(self._clock[part])[:n]
        w, x, y, z = qpos[:, 3:7].T
        pitch = np.arctan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y))
        # Sensors report the force on the ground; turn it into the force on the wheel.
        forces = -contacts[:n, : 4 * len(LEGS)].reshape(n, 4, 4)[:, :, [1, 3]]
        return Series(
            time=np.array(self._time[part])[:n],
            base_position=qpos[:, :3],
            base_quaternion=qpos[:, 3:7],
            q=qpos[:, 7:],
            q_desired=self._desired(target),
            dq=qvel[:, 6:],
            torque=torque,
            pitch=np.unwrap(pitch),
            pitch_desired=target[:, PITCH],
            progress=self._progress(places[:n]),
            progress_desired=clock[:, 0],
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
