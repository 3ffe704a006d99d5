"""A mesh seen from above: its heights on a grid, for choosing the plane to cut it along."""

from __future__ import annotations

import numpy as np
from pydantic import Field

from stairwright.arrays import Floats
from stairwright.documents import Model

from .mesh import Mesh, Up, cut, load_mesh

CELLS = 128  # along the longer side


class MeshHeights(Model):
    """The highest surface at each place of a grid (``stairwright/mesh-heights/1``). Metres."""

    schema_: str = Field("stairwright/mesh-heights/1", alias="schema")
    triangles: int = Field(description="of the file")
    low: tuple[float, float, float] = Field(description="least x, y, z [m]")
    high: tuple[float, float, float] = Field(description="most x, y, z [m]")
    heights: list[list[float | None]] = Field(
        description="rows from least to most y, columns from least to most x: height in the middle "
        "of each cell [m]; null where there is no surface"
    )


def mesh_heights(data: bytes, file_type: str, *, scale: float = 1.0, up: Up = "z") -> MeshHeights:
    """Heights of a mesh on a grid of at most 128 by 128 cells.

    Args:
        data: Content of the file.
        file_type: One of ``stl``, ``obj``, ``ply``, ``off``.
        scale: Metres per unit of the file.
        up: The file's axis that points up.

    Raises:
        InputError: If the file cannot be read.
    """
    vertices, faces = load_mesh(data, file_type, scale, up)
    low, high = vertices[faces].min(axis=(0, 1)), vertices[faces].max(axis=(0, 1))
    size = np.maximum(high - low, 1e-9)[:2]
    columns, rows = (max(1, int(n)) for n in np.ceil(CELLS * size / size.max()))
    x = low[0] + (np.arange(columns) + 0.5) * size[0] / columns
    y = low[1] + (np.arange(rows) + 0.5) * size[1] / rows
    heights = [_along((vertices, faces), x, float(at)) for at in y]
    return MeshHeights(
        triangles=len(faces),
        low=_point(low),
        high=_point(high),
        heights=[[None if np.isnan(z) else round(float(z), 4) for z in row] for row in heights],
    )


def _point(p: Floats) -> tuple[float, float, float]:
    return (float(p[0]), float(p[1]), float(p[2]))


def _along(mesh: Mesh, x: Floats, y: float) -> Floats:
    """Highest surface (n,) at each `x` (n,) of one row; NaN where there is none."""
    vertices, faces = mesh
    side = vertices[faces, 1] - y > -1e-9  # as `cut` takes vertices in the plane
    hit = faces[side.any(axis=1) & ~side.all(axis=1)]
    out = np.full(len(x), -np.inf)
    if len(hit) == 0:
        return np.full(len(x), np.nan)
    segments, _ = cut((vertices, hit), (0.0, y), 0.0)
    order = np.argsort(segments[:, :, 0], axis=1)
    segments = np.take_along_axis(segments, order[:, :, None], axis=1)
    (x0, z0), (x1, z1) = segments[:, 0].T, segments[:, 1].T
    step = x[1] - x[0] if len(x) > 1 else 1.0
    first = np.clip(np.ceil((x0 - x[0]) / step), 0, len(x)).astype(int)
    last = np.clip(np.floor((x1 - x[0]) / step), -1, len(x) - 1).astype(int)
    # Cell by cell of each segment, all segments at once.
    for offset in range(int((last - first).max(initial=-1)) + 1):
        has = first + offset <= last
        at = first[has] + offset
        share = (x[at] - x0[has]) / np.maximum(x1[has] - x0[has], 1e-12)
        np.maximum.at(out, at, z0[has] + share * (z1[has] - z0[has]))
    return np.where(np.isfinite(out), out, np.nan)
