"""A path with little CoM margin or little room for the trunk is compared with one with more."""

from __future__ import annotations

import pytest

import stairwright as sw
from stairwright.planning import strategy
from stairwright.planning.certificate.certify import TRUNK_CLEARANCE
from stairwright.planning.smoothing.path_document import least_margins
from stairwright.terrain.stairs import stair

STEP_DOWN = [(-1.3, 0.0), (0.0, 0.0), (0.0, -0.155), (1.3, -0.155)]
FLIGHT_DOWN = stair(0.16, 0.4, 3, direction="down").points


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "points"), [("a1_wheeled", STEP_DOWN), ("d1", FLIGHT_DOWN)])
def test_it_has_more_margin_and_is_certified(
    robot: str, points: list[tuple[float, float]], monkeypatch: pytest.MonkeyPatch
) -> None:
    steady = sw.plan({"points": points}, robot, 0.6)
    assert sw.certify(steady).passed
    monkeypatch.setattr(strategy, "_improved", lambda _, found: found)
    usual = sw.plan({"points": points}, robot, 0.6)
    assert least_margins(steady)["com"] > 1.5 * least_margins(usual)["com"]


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "height", "friction"), [("d1", 0.6, 0.4), ("d1", 0.6, 0.5)])
def test_its_trunk_has_more_room(
    robot: str, height: float, friction: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    wall = {"points": [(-1.5, 0.0), (0.0, 0.0), (0.0, height), (3.0, height)]}

    def room(plan: sw.Plan) -> float:
        assert plan.certificate is not None
        return next(c.value for c in plan.certificate.checks if c.name == TRUNK_CLEARANCE)

    roomy = sw.plan(wall, robot, friction)
    assert sw.certify(roomy).passed
    monkeypatch.setattr(strategy, "_improved", lambda _, found: found)
    usual = sw.plan(wall, robot, friction)
    assert room(usual) < 0.005
    assert room(roomy) > 2.0 * room(usual)
    assert least_margins(roomy)["com"] > 0.9 * least_margins(usual)["com"]
