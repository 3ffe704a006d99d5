"""The balance QP: every solver finds the same forces, and they are optimal."""

from __future__ import annotations

from typing import get_args

import numpy as np
import pytest

from stairwright.control import balance, qp, rigid_body
from stairwright.control.settings import ControllerSettings, Solver


def problem(random: np.random.Generator, paired: bool, limit: float = 150.0):
    """A QP of random contacts; `paired` puts left and right wheels side by side, as in a climb."""
    angle = random.uniform(-1.6, 1.6, 4)
    levers = random.uniform(-0.4, 0.4, (4, 2))
    if paired:
        angle[[1, 3]], levers[[1, 3]] = angle[[0, 2]], levers[[0, 2]]
    settings = ControllerSettings()
    normals = np.column_stack([-np.sin(angle), np.cos(angle)])
    A = rigid_body.force_map(rigid_body.contact_frames(normals), levers)
    desired = np.array([0.0, 116.0, 0.0]) + random.normal(0.0, [40.0, 80.0, 10.0])
    resting = random.normal(0, 20, 8) + np.tile([0.0, 25.0], 4)
    previous = random.normal(0, 20, 8)
    H, g = balance.force_cost(settings, A, desired, resting, previous)
    return H, g, *balance.force_limits(limit, random.uniform(0.05, 1.2, 4))


@pytest.mark.parametrize("solver", [s for s in get_args(Solver) if s != "clarabel"])
def test_solvers_agree_with_clarabel(solver: str) -> None:
    random = np.random.default_rng(3)
    for k in range(60):
        H, g, C, d = problem(random, bool(k % 2))
        expected = qp.solve("clarabel", H, g, C, d, np.zeros(8))
        found = qp.solve(solver, H, g, C, d, np.zeros(8))
        scale = max(1.0, np.abs(expected).max())

        def cost(x, H=H, g=g):
            return 0.5 * x @ H @ x + g @ x

        # Nearly flat directions differ by what the interior point of the reference leaves open.
        assert np.abs(found - expected).max() < 1e-2 * scale
        assert cost(found) - cost(expected) < 1e-6 * abs(cost(expected)) + 1e-6
        assert np.max(C @ found - d) < 1e-5


@pytest.mark.slow
def test_native_is_exact() -> None:
    """Against an active-set solver, from cold and from random starts, limits active or not."""
    random = np.random.default_rng(4)
    for k in range(2000):
        H, g, C, d = problem(random, bool(k % 2), limit=35.0 if k % 5 == 0 else 150.0)
        expected = qp.solve("quadprog", H, g, C, d, np.zeros(8))
        for start in (np.zeros(8), random.normal(0, 50, 8), expected):
            found = qp.solve("native", H, g, C, d, start)
            np.testing.assert_allclose(found, expected, atol=1e-6 * max(1, np.abs(expected).max()))


def test_forces_stay_in_the_cones() -> None:
    random = np.random.default_rng(5)
    C, d = balance.force_limits(60.0, np.full(4, 0.4))
    for _ in range(100):
        H, g, _, _ = problem(random, paired=False)
        force = qp.solve("native", H, g, C, d, np.zeros(8)).reshape(4, 2)
        assert (np.abs(force[:, 0]) <= 0.4 * force[:, 1] + 1e-9).all()
        assert (force[:, 1] >= -1e-9).all()
        assert (force[:, 1] <= 60.0 + 1e-9).all()
