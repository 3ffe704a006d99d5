"""Where along one axis the outcome changes: what to ask next, and what the answers say.

A row is a line of cells along the boundary axis, numbered 0..n. `known` holds the verdicts so far.
Bisection needs an outcome that changes once; where the answers contradict that, it is said.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Known = Mapping[int, bool]
Floats = NDArray[np.float64]
_NEIGHBOURS = 8  # finished rows from which the next one's border is foretold


@dataclass(frozen=True)
class Border:
    """Where the outcome of a row changes.

    Attributes:
        inside: The last cell that passes, counted from the end that does; None if none passes.
        beyond: The cell next to it that does not pass; None if all pass.
        monotone: Whether the answers changed at most once.
    """

    inside: int | None
    beyond: int | None
    monotone: bool


def flips(known: Known) -> list[tuple[int, int]]:
    """Neighbouring asked cells with different verdicts, in order."""
    return [(a, b) for a, b in itertools.pairwise(sorted(known)) if known[a] != known[b]]


def next_cells(
    known: Known, n: int, rising: bool | None = None, guess: float | None = None
) -> list[int]:
    """Cells to ask next; none once the border is between two neighbours, or there is none.

    Args:
        known: Verdicts so far.
        n: Number of the last cell.
        rising: Whether rows pass at their high end; None while that is not known.
        guess: Where the border may be: the last cell that is as the low end is.
    """
    changes = flips(known)
    if changes:
        low, high = changes[0] if known[min(known)] else changes[-1]
        return [(low + high) // 2] if high - low > 1 else []
    if 0 in known and n in known:
        return []
    if not known:
        if rising is None or guess is None:
            return sorted({0, n})
        k = round(guess)
        return sorted({min(max(k, 0), n), min(max(k + 1, 0), n)})
    if rising is None:
        return [k for k in (0, n) if k not in known]
    upwards = known[min(known)] != rising  # it is as the low end is: the border is above
    if (upwards and n in known) or (not upwards and 0 in known):
        return []
    step = 2 ** max(0, len(known) - 2)
    return [min(max(known) + step, n) if upwards else max(min(known) - step, 0)]


def border(known: Known) -> Border:
    """What the verdicts of a row say."""
    changes = flips(known)
    monotone = len(changes) <= 1
    if not changes:
        if not any(known.values()):
            return Border(None, None if not known else min(known), monotone)
        return Border(max(known), None, monotone)
    if known[min(known)]:  # passes at the low end
        inside, beyond = changes[0]
    else:
        beyond, inside = changes[-1]
    return Border(inside, beyond, monotone)


def low_count(known: Known, n: int, rising: bool) -> int:
    """The last cell that is as the low end is: -1 if all are as the high end, n if none is."""
    changes = flips(known)
    if changes:
        return changes[0][0] if known[min(known)] else changes[-1][0]
    return n if known and known[min(known)] != rising else -1


def foretell(place: Floats, places: Floats, borders: Floats, n: int) -> float:
    """The border of a row from those of finished rows near it: a plane through the nearest.

    Args:
        place: (d,) indices of the row on the other axes.
        places: (m, d) those of finished rows.
        borders: (m,) their `low_count`.
        n: Number of the last cell.
    """
    distance = np.abs(places - place).sum(axis=1)
    near = np.argsort(distance, kind="stable")[:_NEIGHBOURS]
    values, weights = borders[near], 1.0 / (1.0 + distance[near])
    inner = (values >= 0) & (values < n)
    if not inner.any() or not inner[0]:  # beyond the range, as its nearest neighbour is
        return float(values[0])
    offsets = np.column_stack([np.ones(inner.sum()), (places[near] - place)[inner]])
    root = np.sqrt(weights[inner])
    fit, *_ = np.linalg.lstsq(offsets * root[:, None], values[inner] * root, rcond=1e-6)
    low, high = values[inner].min(), values[inner].max()
    return float(np.clip(fit[0], low - (high - low) - 1, high + (high - low) + 1))
