"""A boundary study as a dataset over its other axes: where the outcome changes, and why there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .border import Border, border
from .boundary import Rows, searched_rows
from .store import ResultStore
from .targets import target
from .variables import VARIABLES, Variable, complete

if TYPE_CHECKING:
    import xarray as xr

# Of the first cell that does not pass; the other variables are those of the last one that does.
_OF_BEYOND = ("reason", "message", "quantity", "needed", "available")
_OWN = {
    "boundary": Variable("number", "last value that passes, from the end that does"),
    "beyond": Variable("number", "next value that was asked and does not pass"),
    "monotone": Variable("flag", "the outcome changes at most once, as far as was asked"),
    "asked": Variable("count", "cells of this row that were asked"),
}


def border_dataset(store: ResultStore) -> xr.Dataset:
    """Variables over the axes that are no boundary; NaN where nothing, or everything, passes."""
    import xarray as xr

    study, axis = store.study, store.study.boundary_axis
    assert axis is not None
    rows, complete_ = searched_rows(store)
    rising = rows.rising
    # Where nothing changes: more friction is what passes, of all else less.
    high = axis.name == "friction" if rising is None else rising
    found = [border(known, high) for known in rows.known]
    unit = target(axis.name, study.method).unit
    columns: dict[str, list[Any]] = {
        "boundary": [_value(axis.points, each.inside) for each in found],
        "beyond": [_value(axis.points, each.beyond) for each in found],
        "monotone": [each.monotone for each in found],
        "asked": [len(known) for known in rows.known],
    }
    records = _records(store, rows, found)
    columns |= {name: [record[name] for record in records] for name in VARIABLES}
    names = [each.name for each in study.grid_axes]
    data: dict[str, Any] = {}
    for name, variable in (_OWN | dict(VARIABLES)).items():
        about = {"long_name": variable.text}
        if variable.kind == "number":
            about["units"] = unit if name in ("boundary", "beyond") else variable.unit
        kind: Any = np.dtypes.StringDType() if variable.kind == "word" else variable.dtype
        data[name] = (names, np.array(columns[name], kind).reshape(rows.shape), about)
    coordinates = {
        each.name: xr.Variable(
            (each.name,),
            np.array(each.points, "f8" if each.numeric else np.dtypes.StringDType()),
            {"units": target(each.name, study.method).unit} if each.numeric else {},
        )
        for each in study.grid_axes
    }
    attributes = {
        "title": study.name or "A study of Stairwright",
        "id": store.id,
        "engine": store.engine,
        "boundary_axis": axis.name,
        "tolerance": (float(axis.points[-1]) - float(axis.points[0])) / rows.n,
        "rising": -1 if rising is None else int(rising),
        "complete": int(complete_),
        "study": study.model_dump_json(),
    }
    return xr.Dataset(data, coordinates, attributes)


def _value(points: tuple[Any, ...], k: int | None) -> float:
    return float("nan") if k is None else float(points[k])


def _records(store: ResultStore, rows: Rows, found: list[Border]) -> list[dict[str, Any]]:
    """A record a row: of the cell inside the border, and what stops the robot beyond it."""
    pairs = [(each.inside, each.beyond, rows.cells[row]) for row, each in enumerate(found)]
    wanted = sorted({int(line[k]) for *ends, line in pairs for k in ends if k is not None})
    known = store.records(wanted) if wanted else {}
    out = []
    for inside, beyond, line in pairs:
        within = None if inside is None else known[int(line[inside])]
        outside = None if beyond is None else known[int(line[beyond])]
        record = dict(within or complete({"state": (outside or {}).get("state", 0)}))
        for name in _OF_BEYOND:
            record[name] = (outside or complete({}))[name]
        out.append(record)
    return out
