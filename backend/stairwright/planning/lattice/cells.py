"""Cells of the search: pairs of wheel samples, each with a window of body poses.

The native core makes them (native/include/stairwright/lattice/pairs.hpp).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats, Ints32

FORWARD = _core.FORWARD_MOVES  # of all moves of the wheels, the first ones
ALL_MOVES = _core.WHEEL_MOVES


class Cells(NamedTuple):
    """Pairs of wheel samples in lexicographic order.

    Attributes:
        front, rear: (n,) sample indices.
        number: (samples, samples) cell number, -1 where there is none.
        spans: (n, 6) CoM intervals at friction, at the reserve, with lag [m].
        t0, z0, x0: (n,) lattice index of the window's corner.
        slope: (n,) angle of the line from the rear to the front wheel, upward positive [rad].
        origin: (n, moves) cell that a move into a cell comes from, -1 where there is none.
    """

    front: Ints32
    rear: Ints32
    number: Ints32
    spans: Floats
    t0: Ints32
    z0: Ints32
    x0: Ints32
    slope: Floats
    origin: Ints32


def alike(vertices: Floats, centres: Floats, reach: float) -> tuple[Ints32, Ints32]:
    """Samples whose terrain within `reach` looks the same from the wheel's centre.

    Returns:
        (k,) samples of which no two are alike, and (n,) which of those each sample is like.
    """
    kinds: dict[bytes, int] = {}
    kept: list[int] = []
    out = np.empty(len(centres), np.int32)
    for i, outline in enumerate(_core.outlines(vertices, centres, reach)):
        kind = kinds.setdefault(outline.tobytes(), len(kept))
        if kind == len(kept):
            kept.append(i)
        out[i] = kind
    return np.array(kept, np.int32), out
