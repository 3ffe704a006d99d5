"""Speed over faces and cost of transport."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright.simulation.crossing import _Curve, speed_over_faces


def test_where_faces_begin_and_end() -> None:
    up = sw.Terrain(name="up", points=[(-1, 0), (0, 0), (0, 0.2), (0.3, 0.2), (0.3, 0.4), (2, 0.4)])
    assert _Curve.of(up, 0.05).faces_span() == pytest.approx((-0.05, 0.3), abs=0.002)
    down = sw.Terrain(name="down", points=[(-1, 0), (0, 0), (0, -0.2), (2, -0.2)])
    assert _Curve.of(down, 0.05).faces_span() == pytest.approx((0.0, 0.05), abs=0.002)
    assert _Curve.of(sw.Terrain(name="flat", points=[(-1, 0), (2, 0)]), 0.05).faces_span() is None


def test_speed_is_that_of_the_crossing() -> None:
    # Not by its own sensors: in a test of the grip before the start wheels push, too.
    run = sw.rollout(sw.plan("curb-015", "a1_wheeled_x"), controller={"sensing": "ideal"})
    speed = run.metrics.speed_stairs
    assert speed is not None
    # Forces tell on their own when the first wheel is at the riser and the last one off its nose.
    series = run.series
    x, z = series.contact_force[..., 0], series.contact_force[..., 1]
    on_face = (x < -8.0) & (np.abs(x) > 0.3 * z)
    begun = np.flatnonzero(on_face[:, :2].any(axis=1))[0]
    ended = np.flatnonzero(on_face[:, 2:].any(axis=1))[-1]
    way, time = (column[ended] - column[begun] for column in (series.progress, series.time))
    assert speed == pytest.approx(way / time, rel=0.15)
    doubled = series.model_copy(update={"time": series.time * 2.0})
    assert speed_over_faces(doubled, run.terrain, run.robot_description) == pytest.approx(speed / 2)
    stopped = series.model_copy(update={"base_position": series.base_position - [3.0, 0.0, 0.0]})
    assert speed_over_faces(stopped, run.terrain, run.robot_description) is None


@pytest.mark.slow
def test_cost_of_transport_on_the_level() -> None:
    run = sw.rollout(sw.plan("flat", "a1_wheeled"))
    assert run.metrics.speed_stairs is None
    way = run.series.progress[-1]
    weight = run.robot_description.mass * 9.81
    assert run.metrics.cost_of_transport == pytest.approx(
        run.metrics.energy / weight / way, rel=0.02
    )
