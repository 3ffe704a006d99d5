"""A path with little CoM margin is compared with one for which that margin weighs more."""

from __future__ import annotations

import pytest

import stairwright as sw
from stairwright.planning import strategy
from stairwright.planning.smoothing.path_document import least_margins
from stairwright.terrain.stairs import stair

STEP_DOWN = [(-1.3, 0.0), (0.0, 0.0), (0.0, -0.155), (1.3, -0.155)]
FLIGHT_DOWN = stair(0.16, 0.4, 3, direction="down").points


@pytest.mark.parametrize(("robot", "points"), [("a1_wheeled", STEP_DOWN), ("d1", FLIGHT_DOWN)])
def test_it_has_more_margin_and_is_certified(
    robot: str, points: list[tuple[float, float]], monkeypatch: pytest.MonkeyPatch
) -> None:
    steady = sw.plan({"points": points}, robot, 0.6)
    assert sw.certify(steady).passed
    monkeypatch.setattr(strategy, "_steadier", lambda _, found: found)
    usual = sw.plan({"points": points}, robot, 0.6)
    assert least_margins(steady)["com"] > 1.5 * least_margins(usual)["com"]
