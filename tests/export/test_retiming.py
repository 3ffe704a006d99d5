"""Retiming: limits hold everywhere, both ends rest, and the path is kept."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stairwright.errors import InputError
from stairwright.export.retiming import Limits, retime

LIMITS = Limits(
    speed=np.array([1.5, 3.0]),
    acceleration=np.array([12.0, 30.0]),
    jerk=np.array([1200.0, 3000.0]),
    tolerance=np.array([1e-3, np.inf]),
)
STEPS = st.lists(
    st.tuples(
        st.floats(1e-9, 0.5),
        st.one_of(st.just(0.0), st.floats(-0.3, 0.3)),
        st.floats(-0.5, 0.5),
    ),
    min_size=1,
    max_size=30,
)


def polyline(steps: list[tuple[float, float, float]]) -> tuple[np.ndarray, np.ndarray]:
    table = np.cumsum([(0.0, 0.2, -1.0), *steps], axis=0)
    return table[:, 0], table[:, 1:]


@pytest.mark.slow
@given(STEPS, st.sampled_from([10.0, 30.0, 50.0, 100.0, 125.0, 1000.0]))
@settings(max_examples=150)
def test_limits_hold_for_any_path(steps, rate) -> None:
    clock, path = polyline(steps)
    made = retime(clock, path, LIMITS, rate)
    np.testing.assert_allclose(np.diff(made.time), 1 / rate, rtol=1e-9)
    rise = 1 + 1e-9
    assert (np.abs(made.rates) <= LIMITS.speed * rise + 1e-12).all()
    assert (np.abs(made.accelerations) <= LIMITS.acceleration * rise + 1e-9).all()
    jerk = np.abs(np.diff(made.accelerations, axis=0)) * rate
    assert (jerk <= LIMITS.jerk * rise + 1e-6).all()
    for end, corner in ((slice(0, 2), 0), (slice(-1, None), -1)):
        np.testing.assert_allclose(made.values[end] - path[corner], 0.0, atol=1e-12)
        assert not made.rates[end].any()
        assert not made.accelerations[end].any()
    assert distance(path[:, :1], made.values[:, :1]).max() <= 1e-3


def distance(path: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Distance (n,) of points from a polyline, largest channel."""
    start, along = path[:-1], np.diff(path, axis=0)
    length = np.maximum((along**2).sum(axis=1), 1e-30)
    out = []
    for point in points:
        share = np.clip(((point - start) * along).sum(axis=1) / length, 0.0, 1.0)
        out.append(np.abs(start + share[:, None] * along - point).max(axis=1).min())
    return np.array(out)


def test_the_plans_pace_is_kept_where_it_is_gentle() -> None:
    """A straight path at an even, slow pace takes its own time and a little for both ends."""
    clock, path = np.array([0.0, 10.0]), np.array([[0.0, 0.0], [1.0, 1.0]])
    made = retime(clock, path, LIMITS, 100.0)
    assert 10.0 < made.time[-1] < 10.3
    middle = slice(len(made.time) // 4, -len(made.time) // 4)
    np.testing.assert_allclose(made.rates[middle, 0], 0.1, rtol=1e-9)


def test_a_corner_is_passed_slowly_and_closely() -> None:
    """Back the way it came: the first channel turns by 2 rad/s at the plan's own pace."""
    clock, path = np.array([0.0, 1.0, 2.0]), np.array([[0.0, 0.0], [1.0, 1.0], [0.0, 2.0]])
    made = retime(clock, path, LIMITS, 100.0)
    assert 1.0 - 1e-3 <= made.values[:, 0].max() <= 1.0
    corner = int(made.values[:, 0].argmax())
    assert abs(made.rates[corner - 20 : corner + 20, 1]).min() < 0.3
    assert made.rates[:, 1].max() == pytest.approx(1.0, rel=0.05)


def test_what_would_be_endless_is_refused() -> None:
    path = np.array([[0.0, 0.0], [1.0, 1.0]])
    for span in (1e4, 1e12):
        with pytest.raises(InputError, match="a lower rate") as told:
            retime(np.array([0.0, span]), path, LIMITS, 100.0)
        assert told.value.field == ("rate",)
