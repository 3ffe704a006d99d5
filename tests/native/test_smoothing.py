"""The parts of the smoothing, each against its plain form."""

import numpy as np
import pytest

from stairwright import _core

BAND = 6


def full(rows: np.ndarray) -> np.ndarray:
    """The symmetric matrix whose upper band is given by rows."""
    n = len(rows)
    out = np.zeros((n + BAND, n + BAND))
    for i in range(n):
        out[i, i : i + BAND + 1] = out[i : i + BAND + 1, i] = rows[i]
    return out[:n, :n]


def test_the_band_solver_agrees_with_numpy():
    rng = np.random.default_rng(1)
    n = 40
    factor = np.tril(rng.normal(size=(n, n))) * (np.subtract.outer(range(n), range(n)) <= BAND)
    matrix = factor @ factor.T + 0.1 * np.eye(n)
    b = rng.normal(size=n)
    rows = np.zeros((n, BAND + 1))
    for i in range(n):
        rows[i, : min(BAND + 1, n - i)] = matrix[i, i : i + BAND + 1]
    assert _core.solve_banded(rows, b) == pytest.approx(np.linalg.solve(matrix, b), rel=1e-8)
    with pytest.raises(ValueError, match="as many rows"):
        _core.solve_banded(rows, b[:-1])


def test_gradient_and_second_derivatives_belong_to_the_cost_of_unevenness():
    n, body = 12, np.random.default_rng(2).normal(size=(12, 3))
    evenness = _core.Evenness(rate=3.0, curvature=70.0, lever=0.25)
    cost, gradient = evenness.cost(body)
    unit = np.array([1.0, 1.0, 0.25])
    one, two = np.diff(body, axis=0) * unit, np.diff(body, 2, axis=0) * unit
    assert cost == pytest.approx(3.0 * (one**2).sum() + 70.0 * (two**2).sum())
    hessian = full(evenness.hessian(n)[: 3 * n])
    assert gradient == pytest.approx(hessian @ body.ravel())
