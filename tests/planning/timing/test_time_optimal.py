"""Speed along a path under limits that are linear in its square and its acceleration."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import linprog

from stairwright import _core

Floats = NDArray[np.float64]


def test_a_bound_on_acceleration_gives_a_triangle() -> None:
    n, step, most = 101, 0.01, 2.0
    rows = np.zeros((n, 2, 3))
    rows[:, 0] = (0.0, -1.0, most)
    rows[:, 1] = (0.0, 1.0, most)
    x = _core.fastest_squares(rows, np.full(n, 100.0), step)
    way = step * np.arange(n)
    assert x == pytest.approx(2 * most * np.minimum(way, way[-1] - way), abs=1e-9)
    capped = _core.fastest_squares(rows, np.full(n, 0.5), step)
    assert capped == pytest.approx(np.minimum(x, 0.5), abs=1e-9)


def random_limits(rng: np.random.Generator, n: int, k: int) -> Floats:
    rows = rng.normal(size=(n, k, 3))
    rows[..., 2] = np.abs(rows[..., 2]) + 0.05
    return rows


@pytest.mark.parametrize("seed", range(6))
def test_limits_are_kept_and_nothing_is_faster(seed: int) -> None:
    """The pointwise largest profile also has the largest sum, which an LP finds."""
    rng = np.random.default_rng(seed)
    n, k, step = 30, 6, 0.02
    rows, caps = random_limits(rng, n, k), rng.uniform(0.3, 2.0, n)
    x = _core.fastest_squares(rows, caps, step)
    u = np.diff(x) / (2 * step)
    kept = rows[:-1, :, 0] * x[:-1, None] + rows[:-1, :, 1] * u[:, None] + rows[:-1, :, 2]
    assert kept.min() > -1e-6
    assert (x >= 0.0).all()
    assert (x <= caps + 1e-12).all()

    a, b, c = np.moveaxis(rows[:-1], -1, 0)
    upper, right = [], []
    for i in range(n - 1):
        for j in range(k):
            row = np.zeros(n)
            row[i] -= a[i, j] - b[i, j] / (2 * step)
            row[i + 1] -= b[i, j] / (2 * step)
            upper.append(row)
            right.append(c[i, j])
    bounds = [(0.0, 0.0), *((0.0, cap) for cap in caps[1:-1]), (0.0, 0.0)]
    best = linprog(-np.ones(n), np.array(upper), np.array(right), bounds=bounds)
    assert best.status == 0
    assert x.sum() == pytest.approx(-best.fun, rel=0.03)


@pytest.mark.parametrize(
    "limit", [(0.0, 1.0, -0.1), (np.nan, 0.0, 1.0), (0.0, np.inf, 1.0), (0.0, 1.0, np.nan)]
)
def test_what_forbids_standing_is_refused(limit: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="standing"):
        _core.fastest_squares(np.tile(np.array(limit), (3, 1, 1)), np.ones(3), 0.1)
