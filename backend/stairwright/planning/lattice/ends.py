"""Where paths begin and end: poses of a cell near a standing pose, with the widest path."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stairwright import _core
from stairwright.arrays import Ints, Ints32
from stairwright.planning.lattice.body_lattice import Lattice
from stairwright.planning.lattice.cells import Cells
from stairwright.planning.standing import StandingPose

_NEAR = 2  # lattice steps; poses this near to a standing pose's count as it


def pose_in(lat: Lattice, cells: Cells, c: int, where: StandingPose) -> Ints32:
    """Window indices (3,) (pitch, z, x) in cell `c` of the pose nearest to a standing pose."""
    x, z, pitch = where.body
    pose = [
        round(pitch / lat.turn) + lat.pitches // 2 - cells.t0[c],
        round(z / lat.step) - cells.z0[c],
        round(x / lat.step) - cells.x0[c],
    ]
    sizes = np.array([lat.nt, lat.nz, lat.nx])
    inside: Ints32 = np.clip(pose, 0, sizes - 1).astype(np.int32)
    return inside


def near(lat: Lattice, pose: Ints32) -> Ints32:
    """Range (3, 2) of window indices near `pose` (3,)."""
    sizes = np.array([lat.nt, lat.nz, lat.nx])
    both = np.stack([np.maximum(pose - _NEAR, 0), np.minimum(pose + _NEAR + 1, sizes)], axis=1)
    return both.astype(np.int32)


def anywhere(lat: Lattice) -> Ints32:
    """Range (3, 2) of all window indices."""
    return np.array([[0, lat.nt], [0, lat.nz], [0, lat.nx]], np.int32)


def arrival(
    lat: Lattice, widest: _core.WidestPaths, goals: Ints, target: Ints32 | None
) -> tuple[int, int, Ints32]:
    """Best quality at one of the `goals` (cells), near the pose `target` (3,) if there is one.

    Returns:
        The quality (0: none is reached), the goal, and its pose.
    """
    best_of = widest.best
    goal = int(goals[int(np.argmax(best_of[goals]))])
    if best_of[goal] == 0:
        return 0, goal, np.zeros(3, np.int32)
    if target is None:
        return int(best_of[goal]), goal, widest_pose(lat, widest, goal)
    part = near(lat, target)
    widths = _window(lat, widest.width(goal))[_slices(part)]
    best = int(widths.max())
    return best, goal, part[:, 0] + _place(widths, int(widths.argmax())) if best else target


def widest_pose(lat: Lattice, widest: _core.WidestPaths, c: int) -> Ints32:
    """The pose of cell `c` with the widest path to it."""
    widths = _window(lat, widest.width(c))
    return _place(widths, int(widths.argmax()))


def _window(lat: Lattice, volume: NDArray[Any]) -> NDArray[Any]:
    """(nt, nz, nx) view of a flat volume without its rim."""
    full = volume.reshape(lat.nt + 4, lat.nz + 4, lat.row)
    return full[2:-2, 2:-2, 2 : 2 + lat.nx]


def _slices(part: Ints32) -> tuple[slice, ...]:
    return tuple(slice(int(a), int(b)) for a, b in part)


def _place(values: NDArray[Any], k: int) -> Ints32:
    return np.array(np.unravel_index(k, values.shape), np.int32)
