"""Cells as numbers: their places on the axes, and an order that draws a coarse picture first."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stairwright.arrays import Ints

from .axes import Axis, Value
from .document import Study


def place(shape: Sequence[int], cell: int) -> tuple[int, ...]:
    """Indices along the axes of the cell with this number (C order)."""
    return tuple(int(i) for i in np.unravel_index(cell, tuple(shape)))


def point(study: Study, cell: int) -> tuple[Value, ...]:
    """Values of the axes at a cell."""
    indices = place(study.shape, cell)
    return tuple(axis.points[i] for axis, i in zip(study.axes, indices, strict=True))


def levels(length: int, *, numeric: bool = True) -> Ints:
    """(length,) how coarse a picture each index of an axis belongs to; the ends to the coarsest.

    At level k and above every 2^k-th index is there.
    """
    top = max(0, int(length - 1).bit_length() - 2) if numeric else 0
    out = np.zeros(length, np.int64)
    for k in range(1, top + 1):
        out[:: 2**k] = k
    out[-1] = top
    return out


def coarse_first(axes: Sequence[Axis]) -> Ints:
    """All cells of a grid, those of a coarse picture before those between them.

    Within a level neighbours follow each other, first those that differ in friction alone, so that
    what they share is derived once.
    """
    shape = tuple(len(axis.points) for axis in axes)
    tops = [levels(n, numeric=axis.numeric) for n, axis in zip(shape, axes, strict=True)]
    most = max(int(each.max()) for each in tops)
    level = np.full(shape, most, np.int64)
    for k, each in enumerate(tops):
        if each.max() > 0:  # else the axis is too short to be drawn coarsely
            spread = [1] * len(shape)
            spread[k] = -1
            level = np.minimum(level, (each + most - each.max()).reshape(spread))
    friction_last = sorted(range(len(axes)), key=lambda k: axes[k].name == "friction")
    cells = np.arange(level.size).reshape(shape).transpose(friction_last).ravel()
    ordered: Ints = cells[np.argsort(-level.ravel()[cells], kind="stable")]
    return ordered
