"""The closed loop, compiled: sense, control, record, step the physics."""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

from .disturbance import perceive
from .record import keep_sample
from .stepping import call_step
from .tick import tick

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

BEYOND = 1e6  # m, m/s, rad or rad/s, summed up: no robot gets there


@leaf
def diverged(qpos: Floats, qvel: Floats) -> bool:
    """Whether the state is not one to compute anything from: not finite, or beyond all reason."""
    total = 0.0
    for value in qpos:
        total += abs(value)
    for value in qvel:
        total += abs(value)
    return not total < BEYOND


@nb.njit(cache=True, nogil=True)
def run(
    function: int,
    model: int,
    data: int,
    substeps: int,
    first: int,
    last: int,
    looked: bool,
    loaded: bool,
    begun: float,
    dt: float,
    moving: bool,
    record: NDArray[np.void],
    pieces: Floats,
    corners: Floats,
    start: float,
    step: float,
    rows: Floats,
    speeds: Floats,
    leash: float,
    qpos: Floats,
    qvel: Floats,
    ctrl: Floats,
    sensors: Floats,
    draws: Floats,
    history: Floats,
    seen: Integers,
    clock: Floats,
    places: Floats,
    forces: Floats,
    learnt: Floats,
    target: Floats,
    wanted: Floats,
    score: Floats,
    every: int,
    cursor: Integers,
    samples: Floats,
) -> int:
    """Control steps `first` to `last`; returns where it stopped.

    It stops before the physics of a step with a contact to look at: one that is not a wheel's, or
    any while a link is still `loaded`. Go on from there with `looked`. It ends at once when the
    state has diverged.

    Args:
        function, model, data: See `stepping.addresses`.
        substeps: Physics steps per control step.
        begun: Time of control step 0 [s].
        dt: Period of control [s].
        draws: See `disturbance.Sensors`, as `history` and `seen`.
        every, cursor, samples: See `record.Recorder`.

    The others are those of `tick.tick`.
    """
    sensed_qpos, sensed_qvel = np.empty(19), np.empty(18)
    for k in range(first, last):
        if diverged(qpos, qvel):
            return last
        if not (looked and k == first):
            perceive(qpos, qvel, draws, k, history, seen, sensed_qpos, sensed_qvel)
            wheels = tick(
                record, pieces, corners, start, step, rows, speeds, leash, moving, dt, qpos, qvel,
                sensed_qpos, sensed_qvel, clock, places, forces, learnt, target, wanted, ctrl,
                score, sensors,
            )  # fmt: skip
            now = begun + k * dt
            keep_sample(every, cursor, samples, now, qpos, qvel, ctrl, sensors, target, places)
            if loaded or int(sensors[16]) != wheels:
                return k
        for _ in range(substeps):
            call_step(function, model, data)  # type: ignore[call-arg]
    return last
