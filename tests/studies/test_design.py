"""Design studies: what is best is found, replayed, and the same whoever computes it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.studies import design as designing
from stairwright.studies.design_document import Aim
from stairwright.studies.design_result import Candidate, with_best
from stairwright.studies.document import Study
from stairwright.studies.grid import point
from stairwright.studies.serial import Finished, Stopped
from stairwright.studies.variables import DONE, complete

TORQUE = "robot.actuators.leg.torque"
HIGH = [{"maximise": "step.height", "between": [0.1, 0.6], "tolerance": 0.01}]


def _document(**fields: Any) -> dict[str, Any]:
    return {
        "schema": "stairwright/design/1",
        "ask": {"robot": "a1_wheeled", "axes": []},
        "vary": [
            {"name": TORQUE, "between": [5, 40]},
            {"name": "robot.calf.length", "between": [0.16, 0.26]},
        ],
        "aims": [{"minimise": TORQUE}, *HIGH],
        "designs": 40,
    } | fields


class Rule:
    """A robot climbs as high as its motors let it, and only with calves near 0.2 m."""

    def evaluate(self, made: Study, cells: Sequence[int], stopped: Stopped) -> Iterator[Finished]:
        yield {cell: complete({"state": DONE} | self._told(made, cell)) for cell in cells}

    def _told(self, made: Study, cell: int) -> dict[str, Any]:
        name, height = point(made, cell)
        robot = made.robots[str(name)]
        leg = robot.actuators.leg
        assert leg is not None
        high = leg.torque / 60 - 4 * abs(robot.calf.length - 0.2)
        return {"feasible": float(height) <= high, "message": "too high"}

    def close(self) -> None: ...


@pytest.fixture
def rule(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(designing, "choose_engine", lambda *_: Rule())


@pytest.mark.slow
@pytest.mark.usefixtures("rule")
def test_the_front_is_found(tmp_path: Path) -> None:
    result = sw.design(_document(), store=tmp_path / "a")
    assert result.complete
    assert len(result.candidates) == 40
    assert len(result.front) >= 4
    torques = [each.aims[TORQUE] or 0.0 for each in result.front]
    heights = [each.aims["step.height"] or 0.0 for each in result.front]
    assert torques == sorted(torques)
    assert heights == sorted(heights)
    for each in result.front:
        assert each.robot is not None
        assert each.robot.calf.length == each.values["robot.calf.length"]
        best = (each.aims[TORQUE] or 0.0) / 60
        assert 0.0 <= best - (each.aims["step.height"] or 0.0) < 0.25
    lost = [each for each in result.candidates if not each.passed]
    assert lost
    assert all(each.reason == "too high" and each.robot is None for each in lost)
    result.save(tmp_path / "a.json")
    assert sw.DesignResult.model_validate_json((tmp_path / "a.json").read_text()) == result


@pytest.mark.slow
@pytest.mark.usefixtures("rule")
def test_an_interrupted_one_is_replayed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = sw.design(_document(), store=tmp_path / "a")
    asked = 0

    def stopped() -> bool:
        nonlocal asked
        asked += 1
        return False

    part = sw.design(_document(designs=16), store=tmp_path / "b", stopped=stopped)
    assert part.candidates[0].values == whole.candidates[0].values
    again = sw.design(_document(), store=tmp_path / "b")
    assert again.candidates == whole.candidates


@pytest.mark.slow
def test_real_plans(tmp_path: Path) -> None:
    """The smallest motors that still carry the robot over a step."""
    document = _document(
        ask={"robot": "a1_wheeled", "axes": [{"name": "step.height", "values": [0.1, 0.2]}]},
        vary=[{"name": TORQUE, "between": [2, 40]}],
        aims=[{"minimise": TORQUE}],
        designs=10,
        generation=5,
    )
    result = sw.design(document, workers=1, store=tmp_path / "a")
    (best,) = result.front
    assert best.robot is not None
    for height in (0.1, 0.2):
        terrain = {"points": [[-1.5, 0], [0, 0], [0, height], [2, height]]}
        assert sw.plan(terrain, best.robot, friction=0.6).feasible
    worse = [each for each in result.candidates if not each.passed]
    assert all(each.values[TORQUE] < best.values[TORQUE] for each in worse)


def test_the_best_are_those_that_no_other_beats() -> None:
    aims = [Aim(minimise="mass"), Aim(maximise="payload")]
    points = [(1, 1), (2, 3), (2, 2), (3, 3), (0.5, None)]
    tried = [
        Candidate(values={}, aims={"mass": m, "payload": p}, passed=p is not None)
        for m, p in points
    ]
    assert [each.best for each in with_best(aims, tried)] == [True, True, False, False, False]


@pytest.mark.parametrize(
    ("fields", "field"),
    [
        ({"vary": [{"name": "friction", "between": [0.1, 0.2]}]}, "vary.0.name"),
        ({"vary": [{"name": TORQUE, "between": [2, 1]}]}, "vary.0.between"),
        (
            {"vary": [{"name": "robot.calf.length", "between": [-2, -1]}], "aims": HIGH},
            "vary.0.between",
        ),
        ({"vary": [{"name": "robot.tail", "between": [1, 2]}], "aims": HIGH}, "vary.0.between"),
        ({"aims": [{"minimise": "beauty"}]}, "aims.0"),
        ({"aims": [{"minimise": "mass", "maximise": "mass"}]}, "aims.0.minimise"),
        ({"aims": [{"maximise": "step.height", "tolerance": 0.1}]}, "aims.0.between"),
        ({"aims": [{"minimise": "mass"}]}, "ask.terrain"),
        ({"ask": {"robot": "cat", "axes": []}}, "ask.robot"),
        (
            {
                "designs": 100_000,
                "ask": {"axes": [{"name": "friction", "values": [0.4, 0.6]}]},
            },
            "designs",
        ),
    ],
)
def test_what_is_wrong_is_named(fields: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as caught:
        designing.prepared_design(_document(**fields))
    assert caught.value.path.startswith(field), caught.value
