"""Whoever dies: what was finished is kept, and the same study goes on."""

from __future__ import annotations

import gc
import json
import random
import shutil
import subprocess
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import stairwright as sw
from stairwright.errors import InputError
from stairwright.library import load_robot
from stairwright.studies import keeping
from stairwright.studies.dataset import grid_dataset
from stairwright.studies.store import ResultStore, consolidate
from stairwright.studies.study import prepared
from stairwright.studies.version import engine_of

from .small import LONG, STEP, identical, study


def _heights(*values: float, **fields: Any) -> dict[str, Any]:
    return study(
        {"name": "step.height", "values": list(values)},
        {"name": "friction", "values": [0.5]},
        **fields,
    )


def _asked(document: dict[str, Any], path: Path) -> list[int]:
    cells: list[int] = []
    sw.study(document, workers=1, store=path, progress=lambda p: cells.extend(p.new))
    return cells


@pytest.mark.slow
def test_xarray_opens_stores_and_copies_without_a_warning(tmp_path: Path) -> None:
    store, copy = tmp_path / "a.zarr", tmp_path / "copy.zarr"
    gc.collect()  # sockets that other tests have left behind would warn in this one
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made = sw.study(_heights(0.05), workers=1, store=store)
        made.save(copy)
        for path in (store, copy):
            with xr.open_zarr(path) as opened:
                assert identical(opened[list(made.dataset.data_vars)].load(), made.dataset), path


def test_a_store_that_lacks_a_variable_gets_it(tmp_path: Path) -> None:
    path = tmp_path / "a.zarr"
    sw.study(_heights(0.05), workers=1, store=path)
    shutil.rmtree(path / "energy")
    consolidate(path)
    ResultStore(path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with xr.open_zarr(path) as opened:
            assert "energy" in opened


def test_a_finished_study_answers_from_its_store(tmp_path: Path) -> None:
    document, path = _heights(0.05, 0.1), tmp_path / "a.zarr"
    assert sorted(_asked(document, path)) == [0, 1]
    assert _asked(document, path) == []
    assert _asked(document | {"name": "another name"}, path) == []


def test_results_of_before_there_was_a_variable_are_read(tmp_path: Path) -> None:
    document, path = _heights(0.05), tmp_path / "a.zarr"
    _asked(document, path)
    shutil.rmtree(path / "speed")
    old = grid_dataset(ResultStore(path))
    assert bool(old.feasible.all())
    assert np.isnan(old.speed).all()


@pytest.mark.slow
def test_an_extended_axis_computes_only_new_cells(tmp_path: Path) -> None:
    path = tmp_path / "a.zarr"
    _asked(_heights(0.05, 0.1), path)
    before = sw.study(_heights(0.05, 0.1), workers=1, store=path).dataset
    assert _asked(_heights(0.03, 0.05, 0.1), path) == [0]
    after = sw.study(_heights(0.03, 0.05, 0.1), workers=1, store=path).dataset
    assert identical(before, after.sel({"step.height": [0.05, 0.1]}))


@pytest.mark.slow
def test_studies_in_the_data_folder_share_their_cells(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("STAIRWRIGHT_DATA", str(tmp_path))
    cells: list[int] = []
    for heights in ((0.05, 0.1), (0.05, 0.08, 0.1), (0.08,)):
        sw.study(_heights(*heights), workers=1, progress=lambda p: cells.extend(p.new))
    assert cells == [0, 1, 1]
    assert len(list((tmp_path / "studies").glob("*.zarr"))) == 3


def test_what_is_out_of_date_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.zarr"
    _asked(_heights(0.05), path)
    heavier = load_robot("a1_wheeled").model_dump(mode="json")
    heavier["trunk"]["mass"] += 1.0
    for document, why in (
        (_heights(0.05, robot="go2w"), "it is about a1_wheeled, not go2w"),
        (_heights(0.05, friction=0.4, seed=1), "other values of friction, seed were asked for"),
        (_heights(0.05, robot=heavier), "the robot a1_wheeled is out of date"),
        (
            _heights(0.05, terrain={"kind": "stair", "rise": 0.1, "platform": 3.0}),
            "the terrain is out of date",
        ),
        (_heights(0.05, method="nominal"), "other values of method"),
        (study({"name": "ramp.slope", "values": [0.1, 0.2]}), "it is another study"),
    ):
        with pytest.raises(InputError, match=why):
            sw.study(document, workers=1, store=path)
    monkeypatch.setattr("stairwright.studies.version.planning_engine", lambda: "another")
    with pytest.raises(InputError, match="another version of the planner"):
        sw.study(_heights(0.05), workers=1, store=path)
    monkeypatch.undo()
    assert _asked(_heights(0.05), path) == []


def test_failures_are_not_tried_for_ever(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("by zero")

    path = tmp_path / "a.zarr"
    with monkeypatch.context() as patch:
        patch.setattr("stairwright.studies.cell.make_plan", broken)
        _asked(_heights(0.05), path)
    assert _asked(_heights(0.05), path) == []
    tried = sw.study(_heights(0.05), workers=1, store=path, retry=True)
    assert tried.counts()["done"] == 1


@pytest.mark.slow
def test_two_writers_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.zarr"
    made = prepared(_heights(0.05))
    store = ResultStore.create(path, made, engine_of(made))
    code = (
        "import sys, stairwright as sw, json\n"
        "sw.study(json.loads(sys.argv[1]), workers=1, store=sys.argv[2])"
    )
    with store.writing():
        command = [sys.executable, "-c", code, json.dumps(_heights(0.05)), str(path)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "another process is at the study" in done.stderr


def test_something_else_at_the_place(tmp_path: Path) -> None:
    (tmp_path / "a.zarr").mkdir()
    with pytest.raises(InputError, match="holds no results of a study"):
        sw.study(STEP, workers=1, store=tmp_path / "a.zarr")
    assert not list(keeping.relatives(tmp_path, prepared(STEP), "e", tmp_path / "b.zarr"))


# ---------------------------------------------------------------- kill -9


@pytest.mark.slow
def test_a_killed_client_loses_at_most_a_batch(truth: ResultStore, tmp_path: Path) -> None:
    document, path = tmp_path / "study.json", tmp_path / "out.zarr"
    document.write_text(json.dumps(LONG))
    command = [sys.executable, "-c", HASTY, "study", str(document), "-o", str(path)]
    command += ["--workers", "2"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    assert _dies_at(process, path, random.randint(1, 20))  # the others take no second
    known = _done(path)
    assert 0 < known < 120  # it was killed before all was done
    assert len(_asked(LONG, path)) <= 120 - known  # nothing finished is lost
    store = ResultStore(path)
    assert np.all(store.states == 1)
    assert identical(grid_dataset(truth), grid_dataset(store))
    give_up = time.monotonic() + 60  # a cluster needs a moment to notice, longer where all is busy
    while _stray() and time.monotonic() < give_up:
        time.sleep(0.2)
    assert not _stray()


# The command line, written down so often that a process is killed in the middle of a short study.
HASTY = """
from stairwright.cli import main
from stairwright.studies import writer
writer.WRITE_EVERY = 0.05
raise SystemExit(main())
"""


def _done(path: Path) -> int:
    """How many cells the store at `path` has an answer for; 0 before there is a store."""
    if not path.exists():
        return 0
    try:
        return int((ResultStore(path).states != 0).sum())
    except InputError:  # it is being made
        return 0


def _dies_at(process: subprocess.Popen[bytes], path: Path, cells: int) -> bool:
    """Kill `process` once `cells` are done; whether it lived so long as not to be done before."""
    while process.poll() is None:
        if _done(path) >= cells:
            process.kill()
            process.wait()
            return True
        time.sleep(0.05)  # looking is work, too
    return False


def _stray() -> list[list[str]]:
    """Clusters whose client is gone."""
    import psutil

    return [
        process.info["cmdline"]
        for process in psutil.process_iter(["cmdline", "ppid"])
        if process.info["ppid"] == 1
        and "stairwright.studies.local_cluster" in (process.info["cmdline"] or [])
    ]
