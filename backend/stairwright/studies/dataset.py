"""Results as an `xarray.Dataset`, and as files."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from stairwright.errors import InputError

from .store import SUFFIX, ResultStore, consolidate
from .variables import VARIABLES

if TYPE_CHECKING:
    import xarray as xr

ENDINGS = (".zarr", ".nc", ".csv")


def dataset_of(store: ResultStore) -> xr.Dataset:
    """The dataset of a study, in memory."""
    if store.study.boundary_axis is None:
        return grid_dataset(store)
    from .border_dataset import border_dataset

    return border_dataset(store)


def grid_dataset(store: ResultStore) -> xr.Dataset:
    """Every variable over all axes, in memory."""
    import xarray as xr

    # without chunks: nothing is asked of a cluster that the caller's process may be a client of
    opened: xr.Dataset = xr.open_zarr(store.path, consolidated=False, chunks=None).load()
    ordered: xr.Dataset = opened[list(VARIABLES)]
    return ordered


def check_ending(path: str | Path) -> Path:
    """A file name that says what to write.

    Raises:
        InputError: If its ending is none of ours.
    """
    chosen = Path(path)
    if chosen.suffix.lower() not in ENDINGS:
        raise InputError(f"cannot write {chosen.name!r}; endings are: {', '.join(ENDINGS)}")
    return chosen


def save(dataset: xr.Dataset, path: str | Path) -> None:
    """Write a dataset as .zarr, .nc (NetCDF 3) or .csv; a file that is there is replaced.

    Raises:
        InputError: If the ending is unknown or the place cannot be written.
    """
    chosen = check_ending(path)
    try:
        if chosen.suffix.lower() == SUFFIX:
            if chosen.exists():
                shutil.rmtree(chosen)
            dataset.to_zarr(chosen, mode="w", consolidated=False, zarr_format=3)
            consolidate(chosen)
        elif chosen.suffix.lower() == ".nc":
            chosen.write_bytes(netcdf(dataset))
        else:
            chosen.write_text(csv(dataset), encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot write {chosen}: {error.strerror or error}") from None


def netcdf(dataset: xr.Dataset) -> bytes:
    """NetCDF 3 (64-bit offsets), which every tool reads."""
    return bytes(dataset.to_netcdf(engine="scipy"))


def csv(dataset: xr.Dataset) -> str:
    """A row a cell: its place on the axes, then the variables."""
    text: str = dataset.to_dataframe().to_csv(lineterminator="\n")
    return text
