"""Tables of the lattice search: what a leg costs at each place of the trunk, or that it cannot be.

A leg's cost depends on where the hip lies relative to the wheel and on the terrain there, so it is
computed once per wheel sample on a hip grid, then read onto the body lattice for every pitch: a
pose of the search costs one read per leg and one for the trunk (`trunk`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.robot.description import Planar

from .ground import Ground
from .legs import Leg, knee_point
from .links import ground_clearance, ground_near

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Longs = NDArray[np.int64]
Words = NDArray[np.uint64]

INF = np.float32(1e9)


class Lattice(NamedTuple):
    """The body lattice: x = i * step, z = j * step, pitch = (t - pitches // 2) * turn."""

    step: float  # m
    turn: float  # rad
    pitches: int  # of the whole table
    nt: int  # pitches of one cell's window
    nz: int  # rows of one cell's window
    nx: int  # columns of one cell's window
    row: int  # columns stored per row: the window, its rim, and room for shifts
    low: int  # first row of a window, relative to the mean wheel height
    half: int  # the hip grid spans -half..half of step / 2 round the wheel


class Pulls(NamedTuple):
    """Cost weights of the search, from the user's weights."""

    com: float
    clearance: float
    torque: float
    smooth: float
    pitch: float


class Bounds(NamedTuple):
    """Bounds that every lattice pose keeps. The obstruction search relaxes one at a time."""

    trunk: float  # least clearance of the trunk [m]
    links: float  # least clearance of the links [m]
    legs: float  # least gap between front and rear leg [m]
    reach: float  # slack of the hip-wheel distance; negative widens the calf's range [m]
    thigh: float  # slack of the thigh joints; negative widens their range [rad]
    com: float  # least CoM margin [m]


class LegTable(NamedTuple):
    """One leg on the body lattice, per wheel sample, pitch, row and column.

    Attributes:
        cost: Cost, INF where impossible.
        moment: CoM moment of the leg pair about the wheel's centre, on the hip grid [kg m].
        carried: What to add about the world's origin, per sample [kg m].
        x0, z0: Lattice index of the first column and row, per sample and pitch.
        u, v: Column and row of the hip grid that those read.
        possible: Bit k of a row's word tells whether its column k is possible.
    """

    cost: Floats32
    moment: Floats32
    carried: Floats32
    x0: Ints
    z0: Ints
    u: Ints
    v: Ints
    possible: Words


def alike(vertices: Floats, centres: Floats, reach: float) -> tuple[Ints, Ints]:
    """Samples whose terrain within `reach` looks the same from the wheel's centre.

    Returns:
        (k,) samples of which no two are alike, and (n,) which of those each sample is like.
    """
    first = np.searchsorted(vertices[:, 0], centres[:, 0] - reach)
    last = np.searchsorted(vertices[:, 0], centres[:, 0] + reach, side="right")
    kinds: dict[bytes, int] = {}
    kept: list[int] = []
    out = np.empty(len(centres), np.int32)
    for i, outline in enumerate(_outlines(vertices, centres, reach, first, last)):
        kind = kinds.setdefault(outline.tobytes(), len(kept))
        if kind == len(kept):
            kept.append(i)
        out[i] = kind
    return np.array(kept, np.int32), out


@nb.njit(cache=True)
def _outlines(vertices: Floats, centres: Floats, reach: float, first: Longs, last: Longs) -> Longs:
    """Rows (n, k) of the ground within `reach` of each wheel's centre, from there [1e-7 m].

    `first` and `last` (n,) are the first vertex within reach of each and the one after the last.
    """
    out = np.zeros((len(centres), 2 * (last - first).max() + 5), np.int64)
    for i in range(len(centres)):
        a, b = max(0, first[i] - 1), min(last[i] + 1, len(vertices))
        out[i, 0] = b - a
        for k in range(a, b):
            dx, dz = vertices[k, 0] - centres[i, 0], vertices[k, 1] - centres[i, 1]
            # A segment that enters from outside counts by where it crosses the border.
            inner = k + 1 if k < first[i] else k - 1
            if k < first[i] or k >= last[i]:
                ex, ez = vertices[inner, 0] - vertices[k, 0], vertices[inner, 1] - vertices[k, 1]
                side = -reach if k < first[i] else reach
                dx, dz = side, dz + ez * (side - dx) / ex
            out[i, 1 + 2 * (k - a)] = round(dx * 1e7)
            out[i, 2 + 2 * (k - a)] = round(dz * 1e7)
    return out


@nb.njit(cache=True, nogil=True)
def hip_grid(
    g: Ground,
    p: Planar,
    leg: Leg,
    centres: Floats,
    wanted: Ints,
    lat: Lattice,
    pulls: Pulls,
    b: Bounds,
) -> tuple[Floats32, Floats32, Floats32]:
    """Cost, moment and world thigh angle per wheel sample and hip position, split by parity.

    Arrays are (n, 2, 2, m, m), the last two (2, 2, m, m): sample, parity of row and column,
    row // 2, column // 2, so that the body lattice (every second hip position) reads neighbours in
    memory. Moments [kg m] are about the wheel's centre. Samples that are not `wanted` cost INF.
    """
    n, size = len(centres), 2 * lat.half + 1
    m = size // 2 + 1
    fine = 0.5 * lat.step
    cost = np.full((n, 2, 2, m, m), INF, np.float32)
    moment = np.zeros((2, 2, m, m), np.float32)
    angle = np.zeros((2, 2, m, m), np.float32)
    near, far = leg.reach_min + b.reach, leg.reach_max - b.reach
    far = min(far, 0.9995 * (p.thigh + p.calf))
    span = leg.reach_max - leg.reach_min
    soft = 0.15 * (p.thigh + p.calf) / 2.0
    load = p.mass * 9.81 / 4.0 / p.leg_torque
    centres = centres[wanted]
    around = ground_near(g, centres, far + soft + max(p.thigh_radius, p.calf_radius))
    clear = np.empty(len(wanted), np.float32)
    for v in range(size):
        dz = (v - lat.half) * fine
        for u in range(size):
            dx = (u - lat.half) * fine
            d = math.hypot(dx, dz)
            if d < near or d > far:
                continue
            ax, az = knee_point(-dx, -dz, p.thigh, p.calf, leg.knee)
            f = max(0.0, leg.reach_min + 0.1 * span - d) + max(0.0, d - leg.reach_max + 0.1 * span)
            f /= 0.1 * span
            tau = load * load * ((dx + ax) ** 2 + dx * dx)
            at = (v % 2, u % 2, v // 2, u // 2)
            angle[at] = math.atan2(-ax, -az)
            moment[at] = p.thigh_mass * (dx + p.thigh_com * ax)
            moment[at] += p.calf_mass * (1.0 - p.calf_com) * (dx + ax)
            base = 0.2 * f * f + pulls.torque * tau
            ground_clearance(g, around, p, centres, (dx, dz), (ax, az), soft, b.links, clear)
            for k, i in enumerate(wanted):
                if clear[k] < b.links:
                    continue
                e = max(0.0, soft - clear[k]) / soft
                cost[i, v % 2, u % 2, v // 2, u // 2] = pulls.clearance * 0.25 * e * e + base
    return cost, moment, angle


@nb.njit(cache=True, error_model="numpy", fastmath=True, nogil=True)
def on_lattice(
    grid: tuple[Floats32, Floats32, Floats32],
    like: Ints,
    leg: Leg,
    mass: float,
    centres: Floats,
    pitches: Ints,
    lat: Lattice,
    slack: float,
) -> LegTable:
    """Read a hip grid onto the body lattice; thigh limits are applied here.

    Args:
        grid: Of `hip_grid`.
        like: (n,) which sample of the grid stands for a sample here.
        leg: The leg.
        mass: Of the leg pair with its wheels [kg].
        centres: (n, 2) wheel centres [m].
        pitches: (n, 2) first pitch that is wanted of a sample and the one after the last; what
            the table holds of others means nothing.
        lat: The body lattice.
        slack: Of the thigh joints [rad].
    """
    cost, moment, angle = grid
    n, m = len(centres), cost.shape[3]
    fine = 0.5 * lat.step
    out = np.empty((n, lat.pitches, m, lat.row), np.float32)
    x0, z0 = np.empty((n, lat.pitches), np.int32), np.empty((n, lat.pitches), np.int32)
    us, vs = np.empty((n, lat.pitches), np.int32), np.empty((n, lat.pitches), np.int32)
    possible = np.zeros((n, lat.pitches, m), np.uint64)
    middle = np.float32(0.5 * (leg.thigh_min + leg.thigh_max))
    half_range = np.float32(0.5 * (leg.thigh_max - leg.thigh_min) - slack)
    turn_over, full = np.float32(math.pi), np.float32(2 * math.pi)
    soft = np.float32(0.15)
    zero, weight = np.float32(0.0), np.float32(0.2)
    for i in range(n):
        for t in range(pitches[i, 0], pitches[i, 1]):
            out[i, t] = INF
            pitch = (t - lat.pitches // 2) * lat.turn
            c, s = math.cos(pitch), math.sin(pitch)
            # Hip = body + (ox, oz); first lattice point whose hip lies on the grid.
            ox, oz = c * leg.hip_x + s * leg.hip_z, -s * leg.hip_x + c * leg.hip_z
            bx = math.ceil((centres[i, 0] - lat.half * fine - ox) / lat.step)
            bz = math.ceil((centres[i, 1] - lat.half * fine - oz) / lat.step)
            u = int(round((bx * lat.step + ox - centres[i, 0]) / fine)) + lat.half
            v = int(round((bz * lat.step + oz - centres[i, 1]) / fine)) + lat.half
            x0[i, t], z0[i, t], us[i, t], vs[i, t] = bx, bz, u, v
            shift = np.float32(pitch) + middle
            for j in range(m - v // 2):
                src = cost[like[i], v % 2, u % 2, v // 2 + j]
                ang = angle[v % 2, u % 2, v // 2 + j]
                width = min(lat.row, m - u // 2)
                src, ang = src[u // 2 :], ang[u // 2 :]
                value = out[i, t, j]
                for k in range(width):
                    w = ang[k] - shift
                    w = w - full * np.floor((w + turn_over) / full)
                    room = half_range - abs(w)
                    e = max(zero, soft - room) / soft
                    fits = src[k] + weight * e * e
                    value[k] = fits if room >= zero else INF
                possible[i, t, j] = bits(value[:width])
    carried = (mass * centres[:, 0]).astype(np.float32)
    return LegTable(out, moment, carried, x0, z0, us, vs, possible)


@leaf
def bits(row: Floats32) -> np.uint64:
    """A word whose bit k tells whether column k of a row of at most 64 costs is possible."""
    word = np.uint64(0)
    for k in range(len(row)):
        word |= np.uint64(row[k] < INF) << np.uint64(k)
    return word
