"""What a stored study can be taken along as: media type and ending by name."""

from __future__ import annotations

from collections.abc import Mapping

FORMATS: Mapping[str, tuple[str, str]] = {
    "netcdf": ("application/x-netcdf", ".nc"),
    "zarr": ("application/zip", ".zarr.zip"),
    "csv": ("text/csv; charset=utf-8", ".csv"),
    "json": ("application/json", ".json"),
}
