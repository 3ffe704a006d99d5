"""Boundaries: bisection finds what the grid finds, and does not trust that there is one border."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stairwright as sw
from stairwright.studies.border import border, foretell, low_count, next_cells
from stairwright.studies.border_dataset import border_dataset
from stairwright.studies.boundary import fill_boundary
from stairwright.studies.document import Study
from stairwright.studies.fill import is_complete
from stairwright.studies.grid import point
from stairwright.studies.serial import Finished, Stopped
from stairwright.studies.store import ResultStore
from stairwright.studies.study import prepared
from stairwright.studies.variables import DONE, complete

from .small import identical, study


@given(
    n=st.integers(1, 200),
    change=st.integers(-1, 200),
    rising=st.booleans(),
    told=st.booleans(),
    guess=st.none() | st.floats(-3, 210),
)
def test_bisection_ends_at_the_border(
    n: int, change: int, rising: bool, told: bool, guess: float | None
) -> None:
    """Whatever is guessed: cells up to `change` are as the low end is."""
    change = min(change, n)
    known: dict[int, bool] = {}
    asked = 0
    while cells := next_cells(known, n, rising if told else None, guess):
        assert not known.keys() & set(cells)
        asked += len(cells)
        known |= {k: (k > change) == rising for k in cells}
    found = border(known, rising if told else None)
    assert found.monotone
    if told:
        assert low_count(known, n, rising) == change
    if 0 <= change < n:
        inside, beyond = (change + 1, change) if rising else (change, change + 1)
        assert (found.inside, found.beyond) == (inside, beyond)
    else:
        assert (found.inside is None) == ((change == n) == rising)
    assert asked <= 4 + 2 * n.bit_length()


def test_the_first_failure_counts() -> None:
    """Seen from the end that passes, whatever is asked first."""
    frayed = [True] * 10 + [False] + [True] * 3 + [False] * 7
    for first in ({13, 14}, {10}, {0, 20}, {10, 12}):
        for rising in (False, True):
            row = frayed[::-1] if rising else frayed
            known = {20 - k if rising else k: frayed[k] for k in first}
            while cells := next_cells(known, 20, rising):
                known |= {k: row[k] for k in cells}
            found = border(known, rising)
            assert found.inside is not None
            assert row[found.inside]
            if 10 in first:
                assert found.inside == (11 if rising else 9)
                assert found.monotone == (len(first) == 1)


def test_a_plane_is_foretold() -> None:
    places = np.array([[0, 0], [4, 0], [0, 4], [4, 4], [8, 8]], float)
    borders = 10 + 2 * places[:, 0] - places[:, 1]
    assert foretell(np.array([2.0, 2.0]), places, borders, 40) == pytest.approx(12.0)


class Rule:
    """An engine for studies whose outcome is a formula; counts what it is asked."""

    def __init__(self, rule: Any) -> None:
        self.rule, self.asked = rule, 0

    def evaluate(self, made: Study, cells: Sequence[int], stopped: Stopped) -> Iterator[Finished]:
        self.asked += len(cells)
        yield {cell: self._told(point(made, cell)) for cell in cells}

    def _told(self, place: tuple[Any, ...]) -> dict[str, Any]:
        feasible = bool(self.rule(*place))
        reason = "" if feasible else "reach"
        return complete({"state": DONE, "feasible": feasible, "reason": reason})

    def close(self) -> None: ...


def _three(border_name: str = "step.height") -> Study:
    axes = [
        {"name": "robot.calf.length", "from": 0.2, "to": 0.23, "count": 31},
        {"name": "friction", "from": 0.3, "to": 0.9, "count": 12},
        {"name": border_name, "boundary": [0.1, 0.36], "tolerance": 0.01},
    ]
    return prepared(study(*axes))


def _filled(made: Study, rule: Any, path: Path) -> tuple[ResultStore, Rule]:
    store, engine = ResultStore.create(path, made, "test"), Rule(rule)
    fill_boundary(store, engine, None, lambda: False)
    return store, engine


@pytest.mark.slow
def test_an_eighth_of_the_cells_is_enough(tmp_path: Path) -> None:
    def rule(calf: float, friction: float, height: float) -> bool:
        return height <= 0.12 + 3 * (calf - 0.2) + 0.2 * np.sqrt(friction - 0.25)

    made = _three()
    store, engine = _filled(made, rule, tmp_path / "a.zarr")
    data = border_dataset(store)
    for calf in data["robot.calf.length"].values:
        for friction in data["friction"].values:
            heights = [h for h in made.axes[2].points if rule(calf, friction, h)]
            here = data.sel({"robot.calf.length": calf, "friction": friction})
            assert float(here.boundary) == heights[-1]
            if heights[-1] < 0.36:
                assert float(here.beyond) == pytest.approx(heights[-1] + 0.01)
            else:
                assert np.isnan(float(here.beyond))
    assert data.monotone.all()
    assert engine.asked <= made.cells / 8, engine.asked / made.cells
    assert int(data.asked.sum()) == engine.asked
    again = Rule(rule)
    fill_boundary(store, again, None, lambda: False)
    assert again.asked == 0
    assert is_complete(store)


@pytest.mark.slow
def test_an_outcome_that_changes_more_than_once_is_found_out(tmp_path: Path) -> None:
    """Resonance of tread and wheel: a band of heights that fails below the border."""

    def rule(calf: float, friction: float, height: float) -> bool:
        band = 0.24 < height < 0.28 and friction < 0.6
        return height <= 0.30 and not band

    made = _three()
    store, _ = _filled(made, rule, tmp_path / "a.zarr")
    data = border_dataset(store)
    low = data.sel(friction=data.friction[data.friction < 0.6])
    assert np.allclose(low.boundary, 0.24)  # what is sure to pass
    assert not low.monotone.all()  # and it is told
    high = data.sel(friction=data.friction[data.friction > 0.6])
    assert high.monotone.all()
    assert np.allclose(high.boundary, 0.30)


@pytest.mark.slow
def test_rows_without_a_border(tmp_path: Path) -> None:
    store, engine = _filled(_three(), lambda *_: False, tmp_path / "a.zarr")
    data = border_dataset(store)
    assert np.isnan(data.boundary).all()
    assert (data.reason == "reach").all()
    assert engine.asked < 31 * 12 * 3


def test_where_all_passes_the_least_friction_that_was_asked_is_named(tmp_path: Path) -> None:
    axes = [
        {"name": "step.height", "values": [0.05, 0.1]},
        {"name": "friction", "boundary": [0.1, 0.6], "tolerance": 0.05},
    ]
    store, _ = _filled(prepared(study(*axes)), lambda *_: True, tmp_path / "a.zarr")
    data = border_dataset(store)
    assert (data.boundary == 0.1).all()
    assert np.isnan(data.beyond).all()


def _fill_some(store: ResultStore, engine: Rule, limit: int) -> None:
    seen: list[int] = []
    fill_boundary(store, engine, lambda p: seen.extend(p.new), lambda: len(seen) > limit)


@pytest.mark.slow
def test_stopped_and_gone_on_with_it_is_the_same(tmp_path: Path) -> None:
    def rule(calf: float, friction: float, height: float) -> bool:
        return height <= 0.2 + friction / 10

    whole, _ = _filled(_three(), rule, tmp_path / "a.zarr")
    parts = ResultStore.create(tmp_path / "b.zarr", _three(), "test")
    for limit in (50, 300, 10**6):
        _fill_some(parts, Rule(rule), limit)
    assert identical(border_dataset(whole), border_dataset(parts))


@pytest.mark.slow
def test_the_border_is_that_of_the_grid(tmp_path: Path) -> None:
    grid = {"name": "friction", "values": [0.3, 0.6]}
    edges = {"name": "step.height", "boundary": [0.3, 1.2], "tolerance": 0.15}
    where = {"diagnose": "none"}  # each message tells where a cell ends, which is soon known
    found = sw.study(study(grid, edges, **where), workers=1, store=tmp_path / "b.zarr")
    assert found.complete
    heights = {"name": "step.height", "from": 0.3, "to": 1.2, "count": 7}
    full = sw.study(study(grid, heights, **where), workers=1, store=tmp_path / "g.zarr").dataset
    for friction in (0.3, 0.6):
        passing = full.feasible.sel(friction=friction)
        highest = float(passing["step.height"].values[passing.values].max())
        here = found.dataset.sel(friction=friction)
        assert float(here.boundary) == highest
        inside = full.sel({"friction": friction, "step.height": highest})
        assert str(here.plan_id.values) == str(inside.plan_id.values)
        beyond = full.sel({"friction": friction, "step.height": float(here.beyond)})
        assert str(here.message.values) == str(beyond.message.values)
