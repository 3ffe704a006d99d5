"""Studies that take a second, and what tests compare datasets with."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

STEP = {
    "schema": "stairwright/study/1",
    "robot": "a1_wheeled",
    "axes": [
        {"name": "step.height", "values": [0.05, 0.3, 1.2]},
        {"name": "friction", "values": [0.3, 0.6]},
    ],
}


def study(*axes: dict[str, Any], **fields: Any) -> dict[str, Any]:
    """A study's document with these axes."""
    return {"schema": "stairwright/study/1", "axes": list(axes), **fields}


LONG = study(
    {"name": "step.height", "from": 0.03, "to": 0.4, "count": 30},
    {"name": "friction", "values": [0.4, 0.5, 0.6, 0.7]},
)


def identical(a: xr.Dataset, b: xr.Dataset) -> bool:
    """Whether two datasets agree in every bit: names, order, attributes of variables, values."""
    if list(a.data_vars) != list(b.data_vars) or a.sizes != b.sizes:
        return False
    for name in [*a.coords, *a.data_vars]:
        x, y = a[name], b[name]
        if x.dtype != y.dtype or x.attrs != y.attrs or x.dims != y.dims:
            return False
        same = (
            x.values.tobytes() == y.values.tobytes()
            if x.dtype.kind in "fib"
            else np.array_equal(x.values.tolist(), y.values.tolist())
        )
        if not same:
            return False
    return True
