"""Stored studies as bytes for a download; carried out by worker processes."""

from __future__ import annotations

import io
import tempfile
import zipfile
from pathlib import Path

import orjson
import xarray as xr

from .blocks import blocks_of, joined
from .dataset import csv, dataset_of, netcdf, save
from .store import ResultStore


def cells(path: str) -> bytes:
    """All known cells as one block of JSON."""
    return orjson.dumps(joined(blocks_of(ResultStore(Path(path)))))


def export(path: str, form: str) -> bytes:
    """The dataset in one of `formats.FORMATS`."""
    if form == "json":
        return cells(path)
    dataset = dataset_of(ResultStore(Path(path)))
    if form == "netcdf":
        return netcdf(dataset)
    if form == "csv":
        return csv(dataset).encode()
    return _zipped(dataset)


def _zipped(dataset: xr.Dataset) -> bytes:
    """A Zarr group in a zip, as `zarr.storage.ZipStore` reads it."""
    with tempfile.TemporaryDirectory(prefix="stairwright-study-") as folder:
        place = Path(folder) / "study.zarr"
        save(dataset, place)
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_STORED) as archive:
            for file in sorted(place.rglob("*")):
                if file.is_file():
                    archive.write(file, file.relative_to(place).as_posix())
        return packed.getvalue()


def record(path: str, cell: int) -> bytes:
    """One cell as JSON, by the names of its variables."""
    store = ResultStore(Path(path))
    values = store.records([cell])[cell]
    return orjson.dumps(values)  # NaN becomes null
