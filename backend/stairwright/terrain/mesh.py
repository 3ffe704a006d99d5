"""Profiles from meshes: a vertical plane cuts the triangles, the upper edge of the cut is kept."""

from __future__ import annotations

import io
import itertools
import math
from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
import shapely

from stairwright.arrays import Floats, Ints
from stairwright.documents import parse
from stairwright.errors import InputError

from .profile import Terrain, simplify

Up = Literal["z", "y"]
Mesh = tuple[Floats, Ints]
"""Vertices (n, 3) [m] and faces (m, 3)."""

FILE_TYPES = ("stl", "obj", "ply", "off")
MAX_BYTES = 32 * 2**20
MAX_TRIANGLES = 500_000
MAX_SEGMENTS = 50_000
MAX_POINTS = 2_000  # of a terrain
JOIN = 1e-4  # m; the cut of a mesh may have gaps of this width where triangles meet
FINEST, COARSEST = 1e-4, 1e-2  # m, tolerances tried to bring a cut below MAX_POINTS


def slice_mesh(
    data: bytes,
    file_type: str,
    origin: tuple[float, float | None] = (0.0, None),
    heading: float = 0.0,
    name: str = "imported",
    *,
    scale: float = 1.0,
    up: Up = "z",
    friction: float = 0.6,
) -> Terrain:
    """The terrain that a robot meets which drives over a mesh in a straight line.

    Args:
        data: Content of the file.
        file_type: One of ``stl``, ``obj``, ``ply``, ``off``.
        origin: A point (x, y) of the cut [m, after scaling], where the profile's x is zero. The
            mesh's own x is kept by default, and without a y the cut goes through its middle.
        heading: Direction of travel, counter-clockwise from +x [rad].
        name: Name of the terrain.
        scale: Metres per unit of the file (0.001 for millimetres).
        up: The file's axis that points up; with ``y`` its x stays and its -z becomes y.
        friction: Coulomb friction, wheel on terrain.

    Raises:
        InputError: If the file cannot be read, is too large, is missed by the plane, or if the cut
            has a gap.
    """
    segments, tall = cut(load_mesh(data, file_type, scale, up), origin, heading)
    profile = simplify(_upper_envelope(segments))
    if not np.all(np.abs(profile) <= 100.0):
        low, high = profile[[0, -1], 0]
        raise InputError(
            f"the profile reaches from x = {low:.4g} to {high:.4g} m and to a height of "
            f"{profile[:, 1].max():.4g} m, further than 100 m: is the scale right "
            "(0.001 for millimetres), and the x that becomes 0?",
            ("scale",),
        )
    profile, tolerance = _thin(profile)
    note = f"Cut of a mesh, {tall} triangles, to {tolerance * 1e3:.1f} mm."
    points = [(float(x), float(z)) for x, z in np.round(profile, 6) + 0.0]
    return parse(
        Terrain, {"name": name, "description": note, "points": points, "friction": friction}
    )


def load_mesh(data: bytes, file_type: str, scale: float = 1.0, up: Up = "z") -> Mesh:
    """The triangles in a file, z up.

    Raises:
        InputError: If it cannot be read, is too large or holds no triangles.
    """
    import trimesh  # slow to import and needed by nobody else

    kind = file_type.lower().lstrip(".")
    if kind not in FILE_TYPES:
        raise InputError(
            f"cannot read {file_type!r}; there are: {', '.join(FILE_TYPES)}", ("file_type",)
        )
    if len(data) > MAX_BYTES:
        raise InputError(f"the file is larger than {MAX_BYTES >> 20} MiB", ("file",))
    if not (math.isfinite(scale) and scale > 0.0):
        raise InputError("must be a number above 0", ("scale",))
    options: dict[str, Any] = {"skip_materials": True} if kind == "obj" else {}
    try:
        mesh: Any = trimesh.load(
            io.BytesIO(data), file_type=kind, force="mesh", process=False, **options
        )
        vertices = np.asarray(mesh.vertices, np.float64).reshape(-1, 3) * scale
        faces = np.asarray(mesh.faces, np.int64).reshape(-1, 3)
    except Exception as error:  # noqa: BLE001 - parsers of broken files raise anything
        reason = " ".join(str(error).split())[:120]
        raise InputError(f"cannot read the {kind.upper()} file: {reason}", ("file",)) from None
    if len(faces) == 0:
        raise InputError("the file holds no triangles", ("file",))
    if len(faces) > MAX_TRIANGLES:
        raise InputError(
            f"the mesh has {len(faces)} triangles, more than {MAX_TRIANGLES}", ("file",)
        )
    if not np.all(np.isfinite(vertices)) or faces.min() < 0 or faces.max() >= len(vertices):
        raise InputError("the mesh holds vertices that are not numbers or are missing", ("file",))
    if up == "y":
        vertices = np.stack([vertices[:, 0], -vertices[:, 2], vertices[:, 1]], axis=1)
    return vertices, faces


def cut(mesh: Mesh, origin: tuple[float, float | None], heading: float) -> tuple[Floats, int]:
    """Segments (n, 2, 2) of (x along the heading, z) where the vertical plane cuts triangles."""
    vertices, faces = mesh
    if not math.isfinite(heading):
        raise InputError("must be a finite angle in rad", ("heading",))
    x, y = origin
    if y is None:
        y = float(vertices[:, 1].min() + vertices[:, 1].max()) / 2
    if not (math.isfinite(x) and math.isfinite(y)):
        raise InputError("must be finite", ("origin",))
    c, s = math.cos(heading), math.sin(heading)
    across = -s * (vertices[:, 0] - x) + c * (vertices[:, 1] - y)
    along = c * (vertices[:, 0] - x) + s * (vertices[:, 1] - y)
    # A plane through vertices would cut triangles in single points: shift it by a nanometre.
    across = np.where(np.abs(across) < 1e-9, 1e-9, across)
    flat = np.stack([along, vertices[:, 2]], axis=1)
    hit = faces[np.ptp(np.sign(across[faces]), axis=1) > 0]
    if len(hit) == 0:
        raise InputError("the plane misses the mesh: choose another origin or heading", ("origin",))
    if len(hit) > MAX_SEGMENTS:
        raise InputError(
            f"the plane cuts {len(hit)} triangles, more than {MAX_SEGMENTS}", ("file",)
        )
    # Turn each triangle so that its first vertex is alone on its side.
    sides = across[hit] > 0
    alone = np.argmax(sides == (sides.sum(axis=1) == 1)[:, None], axis=1)
    rows = np.arange(len(hit))
    a = hit[rows, alone]
    ends = []
    for turn in (1, 2):
        b = hit[rows, (alone + turn) % 3]
        share = across[a] / (across[a] - across[b])
        ends.append(flat[a] + share[:, None] * (flat[b] - flat[a]))
    return np.stack(ends, axis=1), len(faces)


def _upper_envelope(segments: Floats) -> Floats:
    """Highest points (m, 2) of `segments` (n, 2, 2) over their whole extent, x never decreasing.

    Raises:
        InputError: If no segment covers some stretch of x.
    """
    order = np.argsort(segments[:, :, 0], axis=1)
    segments = np.take_along_axis(segments, order[:, :, None], axis=1)
    sloped = segments[segments[:, 1, 0] - segments[:, 0, 0] > 1e-9]
    if len(sloped) == 0:
        raise InputError("the plane cuts only vertical faces", ("origin",))
    sloped = sloped[np.argsort(sloped[:, 0, 0], kind="stable")]
    cuts = np.unique(np.round(sloped[:, :, 0].ravel(), 9))
    out: list[tuple[float, float]] = []
    active: list[int] = []
    following = 0
    for a, b in itertools.pairwise(cuts):
        while following < len(sloped) and sloped[following, 0, 0] <= a + 1e-9:
            active.append(following)
            following += 1
        active = [k for k in active if sloped[k, 1, 0] >= b - 1e-9]
        if active:
            out.extend(_highest(sloped[active], a, b))
        elif b - a > JOIN:
            raise InputError(
                f"the cut has a gap from x = {a:.4g} to {b:.4g} m: the mesh has no surface there",
                ("origin",),
            )
    return np.array(out)


def _highest(lines: Floats, a: float, b: float) -> Iterator[tuple[float, float]]:
    """Upper envelope on [a, b] of segments that all cover it."""
    slope = (lines[:, 1, 1] - lines[:, 0, 1]) / (lines[:, 1, 0] - lines[:, 0, 0])
    at_a = lines[:, 0, 1] + slope * (a - lines[:, 0, 0])
    best = int(np.lexsort((slope, at_a))[-1])
    x = a
    yield x, float(at_a[best])
    while True:
        faster = slope > slope[best] + 1e-12
        if not faster.any():
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            meet = a + (at_a[best] - at_a) / (slope - slope[best])
        meet = np.where(faster, np.maximum(meet, x), np.inf)
        rival = int(np.lexsort((-slope, meet))[0])
        if meet[rival] >= b:
            break
        best, x = rival, float(meet[rival])
        yield x, float(at_a[best] + slope[best] * (x - a))
    yield b, float(at_a[best] + slope[best] * (b - a))


def _thin(profile: Floats) -> tuple[Floats, float]:
    """The profile with at most MAX_POINTS corners, and the tolerance [m] that it took."""
    tolerance = FINEST
    while tolerance <= COARSEST:
        line = shapely.simplify(shapely.LineString(profile), tolerance, preserve_topology=False)
        thin = np.asarray(shapely.get_coordinates(line), float)
        if len(thin) <= MAX_POINTS:
            return thin, tolerance
        tolerance *= 2
    raise InputError(
        f"the cut needs more than {MAX_POINTS} points even at {COARSEST * 1e3:g} mm", ("file",)
    )
