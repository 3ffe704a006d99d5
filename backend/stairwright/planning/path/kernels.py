"""Operations of the search on flat volumes, as single loops that compilers vectorise.

Each works on a range of positions: what a cell has reached is a small part of its volume.
"""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf, vector_leaf

from .tables import Floats32, Lattice

Bytes = NDArray[np.uint8]

FAR = np.float32(2.6)  # cost of two lattice steps in one move, in steps


@nb.njit(cache=True, nogil=True)
def shift(lat: Lattice, t: int, z: int, x: int) -> int:
    """Flat distance of poses that are (t, z, x) lattice steps apart."""
    return (t * (lat.nz + 4) + z) * lat.row + x


@leaf
def gather(volume: Bytes, lo: int, hi: int, by: int, out: Bytes) -> None:
    """out = max(out, volume shifted by `by`) for what lies in [lo, hi) of `volume`."""
    a, b = max(0, lo - by), min(len(out), hi - by)
    if b <= a:
        return
    src, dst = volume[a + by : b + by], out[a:b]
    for k in range(b - a):
        dst[k] = src[k] if src[k] > dst[k] else dst[k]


@leaf
def gather_cost(volume: Floats32, lo: int, hi: int, by: int, cost: float, out: Floats32) -> None:
    """out = min(out, volume shifted by `by` + cost) for what lies in [lo, hi) of `volume`."""
    a, b = max(0, lo - by), min(len(out), hi - by)
    if b <= a:
        return
    src, dst = volume[a + by : b + by], out[a:b]
    add = np.float32(cost)
    for k in range(b - a):
        v = src[k] + add
        dst[k] = v if v < dst[k] else dst[k]


@nb.njit(cache=True, nogil=True)
def reach(lat: Lattice) -> int:
    """Flat distance that two lattice steps along every axis span."""
    return 2 * (lat.row * (lat.nz + 4) + lat.row + 1)


@leaf
def _largest(a: Bytes, b: Bytes, lo: int, hi: int, o: int) -> None:
    """b = largest of a within two strides `o`, in [lo, hi)."""
    lo, hi = max(lo, 2 * o), min(hi, len(a) - 2 * o)
    if hi <= lo:
        return
    s0, s1, s2 = a[lo - 2 * o : hi - 2 * o], a[lo - o : hi - o], a[lo:hi]
    s3, s4, d = a[lo + o : hi + o], a[lo + 2 * o : hi + 2 * o], b[lo:hi]
    for k in range(hi - lo):
        u = s0[k] if s0[k] > s1[k] else s1[k]
        v = s3[k] if s3[k] > s4[k] else s4[k]
        w = u if u > v else v
        d[k] = w if w > s2[k] else s2[k]


@leaf
def dilate(a: Bytes, b: Bytes, lo: int, hi: int, lat: Lattice) -> None:
    """Largest value within two lattice steps along each axis, in [lo, hi).

    The result is in `b`, `a` is spent; both are zero outside what `a` holds, as far as [lo, hi) and
    a `reach` beyond. Right inside the window; the rim holds scratch.
    """
    _largest(a, b, lo, hi, 1)
    _largest(b, a, lo, hi, lat.row)
    _largest(a, b, lo, hi, lat.row * (lat.nz + 4))


@vector_leaf
def _cheapest(a: Floats32, b: Floats32, lo: int, hi: int, o: int, one: float) -> None:
    """b = least of a within two strides `o` plus what the way costs, in [lo, hi)."""
    lo, hi = max(lo, 2 * o), min(hi, len(a) - 2 * o)
    if hi <= lo:
        return
    near, far = np.float32(one), np.float32(one) * FAR
    s0, s1, s2 = a[lo - 2 * o : hi - 2 * o], a[lo - o : hi - o], a[lo:hi]
    s3, s4, d = a[lo + o : hi + o], a[lo + 2 * o : hi + 2 * o], b[lo:hi]
    for k in range(hi - lo):
        u = min(s1[k], s3[k]) + near
        v = min(s0[k], s4[k]) + far
        d[k] = min(s2[k], min(u, v))


@leaf
def convolve(a: Floats32, b: Floats32, lo: int, hi: int, lat: Lattice, one: float) -> None:
    """Min-plus convolution with the cost of body motion, in [lo, hi), as in `dilate`."""
    _cheapest(a, b, lo, hi, 1, one)
    _cheapest(b, a, lo, hi, lat.row, one)
    _cheapest(a, b, lo, hi, lat.row * (lat.nz + 4), one)
