"""The trunk on the body lattice: what it costs at each place, or that the ground is in the way."""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Planar

from .ground import Ground, box_clearance, link_clearance
from .tables import INF, Bounds, Lattice, Pulls, Words

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Flags = NDArray[np.bool_]


class TrunkTable(NamedTuple):
    """The trunk on the body lattice.

    Attributes:
        cost: (pitches, rows, columns), INF where it cannot be, or no window comes.
        possible: Words alike, whose bit k tells whether the k-th column from there on is possible.
        x0, z0: Lattice index of the first column and row.
    """

    cost: Floats32
    possible: Words
    x0: int
    z0: int


@nb.njit(cache=True, nogil=True)
def trunk_table(
    g: Ground,
    p: Planar,
    lat: Lattice,
    pulls: Pulls,
    b: Bounds,
    centres: Floats,
    pairs: tuple[Ints, Ints],
) -> TrunkTable:
    """Cost of the trunk wherever a window comes.

    Args:
        g, p, lat, pulls, b: Ground, robot, lattice, weights, bounds.
        centres: (n, 2) wheel centres [m].
        pairs: Samples of front and rear wheels.
    """
    used, x0, z0 = _windows(lat, centres, pairs)
    nz, nx = used.shape
    out = np.full((lat.pitches, nz, nx + lat.row), INF, np.float32)
    soft = 0.15 * (p.thigh + p.calf) / 2.0
    radius = math.hypot(p.half_length, p.half_height)
    pitches = (np.arange(lat.pitches) - lat.pitches // 2) * lat.turn
    cos, sin = np.cos(pitches), np.sin(pitches)
    for j in range(nz):
        z = (z0 + j) * lat.step
        for i in range(nx):
            if not used[j, i]:
                continue
            x = (x0 + i) * lat.step
            # One look at the centre settles most points for all pitches.
            far_off = link_clearance(g, x, z, x, z, 0.0, radius + soft)
            if far_off < min(p.half_height, p.half_length) + b.trunk:
                continue
            for t in range(lat.pitches):
                c = soft
                if far_off < radius + soft:
                    c = box_clearance(g, x, z, cos[t], sin[t], p.half_length, p.half_height, soft)
                if c >= b.trunk:
                    e = max(0.0, soft - c) / soft
                    out[t, j, i] = pulls.clearance * 0.5 * e * e
    possible = np.zeros((lat.pitches, nz, nx), np.uint64)
    for t in range(lat.pitches):
        for j in range(nz):
            word = np.uint64(0)
            for i in range(nx - 1, -1, -1):
                word = word << np.uint64(1) | np.uint64(out[t, j, i] < INF)
                possible[t, j, i] = word
    return TrunkTable(out, possible, x0, z0)


@nb.njit(cache=True, nogil=True)
def _windows(lat: Lattice, centres: Floats, pairs: tuple[Ints, Ints]) -> tuple[Flags, int, int]:
    """Places (rows, columns) that the window of some pair of wheels covers, and where they begin.

    Every window lies round the mean of its two wheels; what lies between windows of one front wheel
    counts too.
    """
    x, z, half = centres[:, 0], centres[:, 1], lat.nx // 2 + 2
    x0, x1 = math.floor(x.min() / lat.step) - half, math.ceil(x.max() / lat.step) + half
    z0 = math.floor(z.min() / lat.step) + lat.low - 2
    z1 = math.ceil(z.max() / lat.step) + lat.low + lat.nz + 2
    used = np.zeros((z1 - z0 + 1, x1 - x0 + 1), np.bool_)
    fronts, rears = pairs
    begin = 0
    while begin < len(fronts):
        i, end = fronts[begin], begin
        while end < len(fronts) and fronts[end] == i:
            end += 1
        a = max(0, int(0.5 * (x[rears[begin]] + x[i]) / lat.step) - half - x0)
        b = int(0.5 * (x[rears[end - 1]] + x[i]) / lat.step) + half - x0
        heights = z[rears[begin:end]]
        d = max(0, int(0.5 * (heights.min() + z[i]) / lat.step) + lat.low - 2 - z0)
        e = int(0.5 * (heights.max() + z[i]) / lat.step) + lat.low + lat.nz + 2 - z0
        used[d : e + 1, a : b + 1] = True
        begin = end
    return used, x0, z0
