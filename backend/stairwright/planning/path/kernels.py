"""Whole-volume operations of the search, as single loops that compilers vectorise."""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

from .tables import Floats32, Lattice

Bytes = NDArray[np.uint8]

FAR = np.float32(2.6)  # cost of two lattice steps in one move, in steps


@nb.njit(cache=True)
def shift(lat: Lattice, t: int, z: int, x: int) -> int:
    """Flat distance of poses that are (t, z, x) lattice steps apart."""
    return (t * (lat.nz + 4) + z) * lat.row + x


@nb.njit(cache=True)
def gather(volume: Bytes, by: int, out: Bytes) -> None:
    """out = max(out, volume shifted by `by`); what leaves the volume counts as 0."""
    n = len(out)
    a, b = max(0, -by), min(n, n - by)
    src, dst = volume[a + by : b + by], out[a:b]
    for k in range(b - a):
        dst[k] = src[k] if src[k] > dst[k] else dst[k]


@nb.njit(cache=True)
def gather_cost(volume: Floats32, by: int, cost: float, out: Floats32) -> None:
    """out = min(out, volume shifted by `by` + cost)."""
    n = len(out)
    a, b = max(0, -by), min(n, n - by)
    src, dst = volume[a + by : b + by], out[a:b]
    add = np.float32(cost)
    for k in range(b - a):
        v = src[k] + add
        dst[k] = v if v < dst[k] else dst[k]


@nb.njit(cache=True)
def _largest(a: Bytes, b: Bytes, o: int) -> None:
    """b = largest of a within two strides `o`."""
    n = len(a)
    s0, s1, s2 = a[0 : n - 4 * o], a[o : n - 3 * o], a[2 * o : n - 2 * o]
    s3, s4, d = a[3 * o : n - o], a[4 * o : n], b[2 * o : n - 2 * o]
    for k in range(n - 4 * o):
        u = s0[k] if s0[k] > s1[k] else s1[k]
        v = s3[k] if s3[k] > s4[k] else s4[k]
        w = u if u > v else v
        d[k] = w if w > s2[k] else s2[k]


@nb.njit(cache=True)
def dilate(a: Bytes, b: Bytes, lat: Lattice) -> None:
    """Largest value within two lattice steps along each axis; the result is in `b`, `a` is spent.

    Right inside the window; the rim holds scratch.
    """
    _largest(a, b, 1)
    _largest(b, a, lat.row)
    _largest(a, b, lat.row * (lat.nz + 4))


@nb.njit(cache=True, fastmath=True)
def _cheapest(a: Floats32, b: Floats32, o: int, one: float) -> None:
    """b = least of a within two strides `o` plus what the way costs."""
    n = len(a)
    near, far = np.float32(one), np.float32(one) * FAR
    s0, s1, s2 = a[0 : n - 4 * o], a[o : n - 3 * o], a[2 * o : n - 2 * o]
    s3, s4, d = a[3 * o : n - o], a[4 * o : n], b[2 * o : n - 2 * o]
    for k in range(n - 4 * o):
        u = min(s1[k], s3[k]) + near
        v = min(s0[k], s4[k]) + far
        d[k] = min(s2[k], min(u, v))


@nb.njit(cache=True)
def convolve(a: Floats32, b: Floats32, lat: Lattice, one: float) -> None:
    """Min-plus convolution with the cost of body motion; the result is in `b`, `a` is spent."""
    _cheapest(a, b, 1, one)
    _cheapest(b, a, lat.row, one)
    _cheapest(a, b, lat.row * (lat.nz + 4), one)
