"""Where along one axis the outcome changes: what to ask next, and what the answers say.

A row is a line of cells along the boundary axis, numbered 0..n. `known` holds the verdicts so far.
Bisection needs an outcome that changes once; where the answers contradict that, it is said.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats

Known = Mapping[int, bool]
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
    way = _way(known, rising)
    if way is None:
        return [k for k in (0, n) if k not in known]
    if not known:
        if guess is None:
            return sorted({0, n})
        k = round(guess)
        return sorted({min(max(k, 0), n), min(max(k + 1, 0), n)})
    mirrored = {n - k: verdict for k, verdict in known.items()} if way else known
    asked = _next_falling(mirrored, n)
    return [n - k for k in asked] if way else asked


def _next_falling(known: Known, n: int) -> list[int]:
    """The same for a row that passes at its low end."""
    inside, beyond = _first_failure(known)
    step = 2 ** max(0, len(known) - 2)
    if beyond is None:
        assert inside is not None
        return [] if inside == n else [min(inside + step, n)]
    if inside is None:
        return [] if beyond == 0 else [max(beyond - step, 0)]
    return [(inside + beyond) // 2] if beyond - inside > 1 else []


def _first_failure(known: Known) -> tuple[int | None, int | None]:
    """The last cell that passes before the first that does not, and that one."""
    beyond = min((k for k, verdict in known.items() if not verdict), default=None)
    before = [k for k, verdict in known.items() if verdict and (beyond is None or k < beyond)]
    return max(before, default=None), beyond


def _way(known: Known, rising: bool | None) -> bool | None:
    """Whether a row passes at its high end, by the others or else by itself."""
    if rising is None and flips(known):
        return known[max(known)]
    return rising


def border(known: Known, rising: bool | None = None) -> Border:
    """What the verdicts of a row say; `rising` as in `next_cells`."""
    way = bool(_way(known, rising))
    changes = flips(known)
    monotone = len(changes) <= 1 and all(known[b] == way for _, b in changes)
    mirrored = {-k: verdict for k, verdict in known.items()} if way else known
    inside, beyond = _first_failure(mirrored)
    if way:
        inside, beyond = (None if k is None else -k for k in (inside, beyond))
    return Border(inside, beyond, monotone)


def low_count(known: Known, n: int, rising: bool) -> int:
    """The last cell that is as the low end is: -1 if all are as the high end, n if none is."""
    found = border(known, rising)
    if rising:
        return n if found.inside is None else (-1 if found.beyond is None else found.beyond)
    return -1 if found.inside is None else (n if found.beyond is None else found.inside)


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
