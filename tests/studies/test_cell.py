"""Cells and the serial engine: what a cell tells is what the plan tells, and is kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.planning.smoothing.path_document import PathPoses
from stairwright.studies import cell
from stairwright.studies.grid import coarse_first, levels, place, point
from stairwright.studies.question import Questions
from stairwright.studies.resolve import load_study
from stairwright.studies.variables import DONE, FAILED, REFUSED
from stairwright.terrain import stairs

from .small import STEP, study


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> sw.StudyResult:
    return sw.study(STEP, workers=1, store=tmp_path_factory.mktemp("cell") / "step.zarr")


def test_a_cell_is_the_plan_of_its_values(result: sw.StudyResult) -> None:
    here = result.dataset.sel({"step.height": 0.3, "friction": 0.6})
    plan = sw.plan(stairs.stair(0.3), "a1_wheeled", friction=0.6)
    assert str(here.plan_id.values) == plan.id
    assert bool(here.feasible)
    assert float(here.duration) == plan.timing.total
    assert float(here.margin_com) == min(pose.margins.com for pose in plan.poses)
    needed = 0.6 - min(pose.margins.friction for pose in plan.poses)
    assert float(here.least_friction) == needed
    # static: half a pair's traction at the wheel's rim
    rims = [abs(f[0]) / 2 * 0.05 for pose in plan.poses for f in pose.forces or ()]
    assert float(here.margin_wheel_torque) == pytest.approx(33.5 - max(rims))


def test_what_stops_the_robot_is_told(result: sw.StudyResult) -> None:
    here = result.dataset.sel({"step.height": 1.2, "friction": 0.3})
    plan = sw.plan(stairs.stair(1.2), "a1_wheeled", friction=0.3)
    assert plan.problem is not None
    assert not bool(here.feasible)
    assert str(here.reason.values) == plan.problem.kind
    assert str(here.message.values) == plan.problem.message
    assert np.isnan(float(here.margin_com))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("diagnose", "told"), [("all", [1, 1]), ("last", [0, 1]), ("none", [0, 0])]
)
def test_what_would_open_the_way_is_found_out_where_it_is_asked(
    diagnose: str, told: list[int]
) -> None:
    friction = {"name": "friction", "boundary": [0.3, 0.6], "tolerance": 0.3}
    document = study({"name": "step.height", "values": [1.2]}, friction, diagnose=diagnose)
    questions = Questions(load_study(document))
    records = [cell.evaluate(questions, (1.2, mu)) for mu in (0.3, 0.6)]
    assert [not record["feasible"] for record in records] == [True, True]
    assert [record["reason"] != "" for record in records] == [bool(each) for each in told]
    assert [record["needed"] == record["needed"] for record in records] == [bool(e) for e in told]
    assert all("wheels stop at x" in record["message"] for record in records)


def test_axes_have_units_and_order(result: sw.StudyResult) -> None:
    data = result.dataset
    assert data.feasible.dims == ("step.height", "friction")
    assert data["step.height"].attrs["units"] == "m"
    assert data.margin_torque.attrs["units"] == "Nm"
    assert (data.state == DONE).all()


def test_values_that_make_no_question_are_an_answer() -> None:
    made = Questions(
        load_study(
            study(
                {"name": "stairs.run", "values": [0.1, 0.3]},
                {"name": "stairs.face_angle", "values": [0.8]},
            )
        )
    )
    record = cell.evaluate(made, (0.1, 0.8))
    assert record["state"] == REFUSED
    assert "run" in record["message"]


def test_a_cell_makes_no_documents_of_poses(monkeypatch: pytest.MonkeyPatch) -> None:
    def needless(_poses: PathPoses) -> list[object]:
        raise AssertionError("nobody reads them")

    monkeypatch.setattr(PathPoses, "documents", needless)
    record = cell.evaluate(Questions(load_study(STEP)), (0.05, 0.3))
    assert record["state"] == DONE
    assert record["feasible"]
    assert record["speed"] > 0.0


def test_a_bug_is_recorded_with_its_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("by zero")

    monkeypatch.setattr(cell, "make_plan", broken)
    record = cell.evaluate(Questions(load_study(STEP)), (0.05, 0.3))
    assert record["state"] == FAILED
    assert record["message"] == "ZeroDivisionError: by zero"


@pytest.mark.slow
def test_fast_plans_take_less_time(tmp_path: Path) -> None:
    low = {"name": "step.height", "values": [0.1]}
    slow, fast = (study(low, timing=timing) for timing in ("steady", "fast"))
    steady, quick = (
        sw.study(one, workers=1, store=tmp_path / f"{k}.zarr").dataset
        for k, one in enumerate((slow, fast))
    )
    assert float(quick.duration[0]) < 0.5 * float(steady.duration[0])
    assert float(quick.speed[0]) > 2.0 * float(steady.speed[0])
    plan = sw.plan(stairs.stair(0.1), "a1_wheeled", timing="fast")
    assert str(quick.plan_id.values[0]) == plan.id
    assert load_study(slow).family == load_study(study(low)).family
    with pytest.raises(InputError, match="fast belongs to the method path"):
        Questions(load_study(study(low, timing="fast", method="critical")))


@pytest.mark.slow
def test_robots_may_face_either_way(tmp_path: Path) -> None:
    ways = ["forward", "backward"]
    asked = study({"name": "facing", "values": ways}, terrain="curb-015")
    both = sw.study(asked, workers=1, store=tmp_path / "f.zarr")
    ids = both.dataset.plan_id.values.tolist()
    assert ids == [sw.plan("curb-015", "a1_wheeled", facing=way).id for way in ways]
    with pytest.raises(InputError, match="unknown facing; there are: forward, backward, either"):
        Questions(load_study(asked | {"axes": [{"name": "facing", "values": [*ways, "aside"]}]}))


def test_of_fast_plans_the_planner_chooses_the_end_that_leads() -> None:
    axis = {"name": "friction", "values": [0.6]}
    usual, either, forward = (
        Questions(load_study(study(axis, terrain="curb-015", timing="fast", **said)))
        for said in ({}, {"facing": "either"}, {"facing": "forward"})
    )
    assert [each.at((0.6,)).facing for each in (usual, either, forward)] == [
        "either",
        "either",
        "forward",
    ]
    assert "facing" not in either.at((0.6,)).plan
    assert forward.at((0.6,)).plan["facing"] == "forward"
    assert usual.study.family == either.study.family != forward.study.family


@pytest.mark.slow
def test_rollouts_and_trials(tmp_path: Path) -> None:
    low = {"name": "step.height", "values": [0.04]}
    run = sw.study(study(low, compute="rollout"), workers=1, store=tmp_path / "r.zarr").dataset
    assert str(run.outcome.values[0]) == "success"
    assert int(run.success[0]) == int(run.trials[0]) == 1
    plan = sw.plan(stairs.stair(0.04), "a1_wheeled")
    metrics = sw.rollout(plan).metrics
    assert float(run.energy[0]) == metrics.energy
    assert 0.1 < float(run.cost_of_transport[0]) < 3.0
    few = study(low, compute="trials", trials={"count": 1})
    tried = sw.study(few, workers=1, store=tmp_path / "t.zarr").dataset
    made = sw.trials(plan, 1)
    assert int(tried.trials[0]) == 1
    assert int(tried.success[0]) == made.successes
    assert (float(tried.success_low[0]), float(tried.success_high[0])) == made.clopper_pearson


def test_files(result: sw.StudyResult, tmp_path: Path) -> None:
    import xarray as xr

    result.save(tmp_path / "a.nc")
    result.save(tmp_path / "a.zarr")
    result.save(tmp_path / "a.csv")
    for name in ("a.nc", "a.zarr"):
        read = xr.open_dataset(tmp_path / name, consolidated=False) if "z" in name else (
            xr.open_dataset(tmp_path / name)
        )  # fmt: skip
        assert read.load().equals(result.dataset)
    assert len((tmp_path / "a.csv").read_text().splitlines()) == 7
    with pytest.raises(InputError, match=r"\.zarr, \.nc, \.csv"):
        result.save(tmp_path / "a.png")


def test_cells_that_differ_in_friction_alone_follow_each_other() -> None:
    axes = load_study(
        study(
            {"name": "friction", "values": [0.3, 0.5, 0.7]},
            {"name": "step.height", "from": 0.1, "to": 0.4, "count": 9},
        )
    ).axes
    order = coarse_first(axes)
    heights = np.array([place((3, 9), cell)[1] for cell in order])
    assert sorted(order) == list(range(27))
    assert np.count_nonzero(np.diff(heights[-12:])) == 3  # of the finest level, 4 x 3 cells


def test_a_coarse_picture_comes_first() -> None:
    axes = load_study(
        study(
            {"name": "stairs.rise", "from": 0.1, "to": 0.4, "count": 31},
            {"name": "stairs.run", "from": 0.2, "to": 0.46, "count": 27},
        )
    ).axes
    order = coarse_first(axes)
    assert sorted(order) == list(range(31 * 27))
    first = np.array([place((31, 27), cell) for cell in order[:25]])
    assert np.ptp(first, axis=0).tolist() == [30, 26]  # all over the map
    assert levels(1).tolist() == [0]
    assert point(load_study(STEP), 3) == (0.3, 0.6)
