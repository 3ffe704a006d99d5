"""When a robot that senses by itself gives up."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from stairwright import _core

STEP = 0.01  # s


def stops_after(way: Callable[[float], float], limit: float = 20.0) -> float | None:
    """When a robot gives up whose plan is at `way(time)` [m], None if never [s]."""
    stop = _core.SafeStop()
    for k in range(round(limit / STEP)):
        if stop.watch(way(k * STEP), True, STEP):
            return k * STEP
    return None


@pytest.mark.parametrize("speed", [0.0, 0.0008, 0.0016])
def test_less_than_5_mm_in_3_s_is_no_progress(speed: float) -> None:
    assert stops_after(lambda time: 0.7 + speed * time) == pytest.approx(3.0, abs=0.15)


def test_creeping_into_a_corner_does_not_begin_the_time_anew() -> None:
    """1.5 mm more each second, after the robot has come fast."""
    stopped = stops_after(lambda time: 0.1 * time if time < 2 else 0.2 + 0.0015 * (time - 2))
    assert stopped == pytest.approx(5.0, abs=0.15)


def test_slow_progress_is_progress() -> None:
    assert stops_after(lambda time: 0.002 * time) is None


def test_waiting_for_a_decision_neither_counts_nor_begins_the_time_anew() -> None:
    stop = _core.SafeStop()
    for advancing, seconds in ((True, 2.0), (False, 10.0), (True, 0.8)):
        for _ in range(round(seconds / STEP)):
            assert not stop.watch(0.5, advancing, STEP)
    for _ in range(round(0.4 / STEP)):
        why = stop.watch(0.5, True, STEP)
    assert why == 1


def test_a_jolt_as_of_a_face_missed_by_6_cm_is_no_reason_but_leaning_farther_is() -> None:
    """Between wheels that are 0.36 m apart."""
    stop = _core.SafeStop()
    assert not stop.watch(0.0, True, STEP, pitch_error=0.06 / 0.36)
    assert stop.watch(0.0, True, STEP, pitch_error=-0.21) == 2


def test_a_robot_that_is_lost_stops_at_once_and_for_good() -> None:
    stop = _core.SafeStop()
    assert not stop.watch(0.0, True, STEP)
    assert stop.watch(0.1, True, STEP, lost=True) == 3
    assert stop.watch(0.2, True, STEP) == 3
