"""The parts of the polish, each against its plain form."""

import numpy as np
import pytest

from stairwright.library import load_robot
from stairwright.planning.path import polish
from stairwright.planning.path.evenness import BAND, solve_band, stiffness, unevenness
from stairwright.planning.path.ground import make_ground
from stairwright.planning.path.legs import RECORD, evaluate, make_legs

UNIT = np.array([1.0, 1.0, 0.25])


def wavy(n: int) -> np.ndarray:
    """Trunk poses (n, 3) of a robot that rolls over a step with a bobbing trunk."""
    x = np.linspace(-0.3, 1.0, n)
    return np.stack([x, 0.22 + 0.03 * np.sin(9.0 * x), 0.1 * np.cos(5.0 * x)], axis=1)


def test_band_solver_agrees_with_numpy():
    rng = np.random.default_rng(1)
    n = 40
    factor = np.tril(rng.normal(size=(n, n))) * (np.subtract.outer(range(n), range(n)) <= 6)
    full = factor @ factor.T + 0.1 * np.eye(n)
    b = rng.normal(size=n)
    band = np.zeros((n + BAND, BAND + 1))
    for i in range(n):
        band[i, : min(7, n - i)] = full[i, i : i + 7]
    x = np.concatenate([b, np.zeros(BAND)])
    solve_band(band, x)
    assert x[:n] == pytest.approx(np.linalg.solve(full, b), rel=1e-8)


def test_stiffness_and_gradient_belong_to_the_cost_of_unevenness():
    n, body = 12, np.random.default_rng(2).normal(size=(12, 3))
    grad = np.empty(3 * n)
    cost = unevenness(body, UNIT, 3.0, 70.0, grad)
    one, two = np.diff(body, axis=0) * UNIT, np.diff(body, 2, axis=0) * UNIT
    assert cost == pytest.approx(3.0 * (one**2).sum() + 70.0 * (two**2).sum())
    band = stiffness(n, UNIT, 3.0, 70.0)
    full = np.zeros((3 * n + 6, 3 * n + 6))
    for i in range(3 * n):
        full[i, i : i + 7] = full[i : i + 7, i] = band[i]
    assert grad == pytest.approx(full[: 3 * n, : 3 * n] @ body.ravel())


def test_extrapolated_residuals_are_those_of_the_moved_node():
    robot = load_robot("a1_wheeled")
    p, legs = robot.planar, make_legs(robot.planar)
    step = np.array([[-2.0, 0.0], [0.4, 0.0], [0.4, 0.15], [3.0, 0.15]])
    ground, n = make_ground(step), 200
    body, r = wavy(n), p.wheel_radius
    wheels = np.stack([body[:, 0] + 0.2, np.full(n, r), body[:, 0] - 0.2, np.full(n, r)], axis=1)
    spans = np.stack([body[:, 0] + d for d in (-0.03, 0.02, -0.01, 0.01, -0.02, 0.03)], axis=1)
    wish = np.full(polish.WISHES, 0.05)
    wish[polish.H_MARGIN : polish.HEIGHT] = 20.0

    def residuals(where: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        records, out = np.empty((n, RECORD)), np.empty((n, polish.TERMS))
        for k in range(n):
            points = np.empty((2, 3, 2))
            evaluate(ground, p, *legs, where[k], wheels[k], 0.05, points, records[k])
            polish._residuals(records[k], where[k], wheels[k], spans[k], wish, out[k])
        return records, out

    records, base = residuals(body)
    jac, own = np.zeros((n, 3, polish.TERMS)), np.zeros((n, 3, 3))
    polish._differentiate(
        ground, p, *legs, np.ones(n, np.bool_), body, wheels, spans, wish, 0.05, records, base,
        jac, own,
    )  # fmt: skip
    moved = body + np.random.default_rng(3).uniform(-1e-4, 1e-4, body.shape)
    _, there = residuals(moved)
    told = np.empty_like(there)
    for k in range(n):
        polish._extrapolate(base[k], jac[k], moved[k], body[k], told[k])
    wrong = np.abs(told - there)
    assert (base > 0.0).any(axis=0).sum() >= 7
    assert np.abs(there - base).max() > 0.05
    assert wrong.max() < 1e-3
    assert own[:, 1, 1] == pytest.approx((jac[:, 1] * jac[:, 2]).sum(axis=1))
