import numpy as np
import pytest
import quadprog

from stairwright._core import solve_quadratic_program

SOLVED, INFEASIBLE = 0, 1


@pytest.mark.parametrize("seed", range(8))
def test_random_programmes_equal_quadprog(seed):
    random = np.random.default_rng(seed)
    outcomes = set()
    for _ in range(150):
        n, m = random.integers(1, 7), random.integers(1, 30)
        root = random.normal(size=(n, n))
        H = root @ root.T + 10 ** random.uniform(-3, 0) * np.eye(n)
        g, A = random.normal(size=n), random.normal(size=(m, n))
        b = random.normal(size=m) - random.uniform(-0.5, 2)
        outcome, x, multipliers = solve_quadratic_program(H, g, A, b)
        outcomes.add(outcome)
        try:
            expected = quadprog.solve_qp(H, -g, A.T.copy(), b)[0]
        except ValueError:
            assert outcome == INFEASIBLE
            continue
        assert outcome == SOLVED
        assert np.allclose(x, expected, rtol=1e-6, atol=1e-7)
        # The conditions of optimality, with our multipliers.
        scale = 1 + multipliers.max()
        assert np.all(multipliers >= 0.0)
        assert np.allclose(H @ x + g, A.T @ multipliers, rtol=1e-6, atol=1e-6 * scale)
        assert np.all(np.abs(multipliers * (A @ x - b)) < 1e-6 * (1 + multipliers))
    assert outcomes == {SOLVED, INFEASIBLE}


def test_repeated_and_contradicting_rows():
    H, g = np.eye(2), np.zeros(2)
    A = np.array([[1.0, 0.0], [1.0, 0.0], [2.0, 0.0], [-1.0, 0.0]])
    outcome, x, _ = solve_quadratic_program(H, g, A[:3], np.array([1.0, 1.0, 2.0]))
    assert outcome == SOLVED
    assert x == pytest.approx([1.0, 0.0])
    assert solve_quadratic_program(H, g, A, np.array([1.0, 1.0, 2.0, 1.0]))[0] == INFEASIBLE


def test_no_rows():
    outcome, x, _ = solve_quadratic_program(
        2 * np.eye(2), np.array([2.0, -4.0]), np.empty((0, 2)), np.empty(0)
    )
    assert outcome == SOLVED
    assert x == pytest.approx([-1.0, 2.0])


def test_shapes_are_checked():
    with pytest.raises(ValueError, match=r"\(n, n\)"):
        solve_quadratic_program(np.eye(3), np.zeros(2), np.empty((0, 2)), np.empty(0))
