"""Terrain files from outside, read in a worker that can open nothing and may use little memory."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import PurePath
from typing import Any

from stairwright.errors import InputError
from stairwright.sent import sent_mapping, sent_text
from stairwright.terrain.generation import terrain_in
from stairwright.terrain.mesh import FILE_TYPES, slice_mesh
from stairwright.terrain.mesh_heights import mesh_heights
from stairwright.terrain.profile import Terrain
from stairwright.terrain.tables import parse_table

Options = Mapping[str, Any]


def import_terrain(data: bytes, file_name: str, options: Options) -> dict[str, Any]:
    """The terrain document in a file; the ending of its name says how to read it.

    Args:
        data: The file.
        file_name: Its name.
        options: What a mesh or a table does not say itself: ``name``, ``friction``, and for a
            mesh ``origin`` (x, y) [m], ``heading`` [rad], ``scale`` [m per unit] and ``up``.

    Raises:
        InputError: If it cannot be read.
    """
    suffix = PurePath(file_name).suffix.lower().removeprefix(".")
    if suffix not in READERS:
        raise InputError(
            f"cannot read a file that ends with {suffix or 'nothing'!r}; "
            f"there are: {', '.join(READERS)}",
            ("file",),
        )
    terrain = READERS[suffix](data, suffix, options)
    return terrain.model_dump(mode="json")


def name_option(file_name: str, name: str | None) -> dict[str, Any]:
    """How a terrain is called: as was said, as its document says, or as its file is called."""
    if name is not None:
        return {"name": name}
    file = PurePath(file_name)
    if file.suffix.lower() in (".json", ".yaml", ".yml"):
        return {}
    kept = "".join(c if c.isalnum() or c in " .+-_" else "-" for c in file.stem).strip()
    return {"name": kept[:100] or "imported"}


def look_at_mesh(data: bytes, file_name: str, options: Options) -> dict[str, Any]:
    """Heights of the mesh in a file, with ``scale`` and ``up`` among the options.

    Raises:
        InputError: If it cannot be read.
    """
    suffix = PurePath(file_name).suffix
    return mesh_heights(data, suffix, **options).model_dump(mode="json")


def _mesh(data: bytes, suffix: str, options: Options) -> Terrain:
    return slice_mesh(
        data,
        suffix,
        options.get("origin", (0.0, None)),
        options.get("heading", 0.0),
        options.get("name", "imported"),
        scale=options.get("scale", 1.0),
        up=options.get("up", "z"),
        friction=options.get("friction", 0.6),
    )


def _table(data: bytes, _: str, options: Options) -> Terrain:
    name, friction = options.get("name", "imported"), options.get("friction", 0.6)
    return parse_table(sent_text(data), name, friction)


def _document(data: bytes, suffix: str, options: Options) -> Terrain:
    given = {key: options[key] for key in ("name", "friction") if key in options}
    return terrain_in({**sent_mapping(data, suffix, "stairwright/terrain/1"), **given})


READERS: dict[str, Callable[[bytes, str, Options], Terrain]] = {
    **dict.fromkeys(FILE_TYPES, _mesh),
    "csv": _table,
    "txt": _table,
    "json": _document,
    "yaml": _document,
    "yml": _document,
}


def rehearse() -> None:
    """Read one small file of each kind, so that every module that this takes is loaded."""
    ground = ((0, 0, 0), (4, 0, 0), (4, 1, 0), (0, 1, 0))
    corners = "\n".join(" ".join(map(str, corner)) for corner in ground)
    facets = "".join(
        "facet normal 0 0 1\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in (ground[i] for i in triangle))
        + "endloop\nendfacet\n"
        for triangle in ((0, 1, 2), (0, 2, 3))
    )
    ply = (
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
    )
    samples = {
        "a.stl": f"solid a\n{facets}endsolid a\n",
        "a.obj": "".join(f"v {x} {y} {z}\n" for x, y, z in ground) + "f 1 2 3\nf 1 3 4\n",
        "a.off": f"OFF\n4 2 0\n{corners}\n3 0 1 2\n3 0 2 3\n",
        "a.ply": f"{ply}{corners}\n3 0 1 2\n3 0 2 3\n",
        "a.csv": "x,z\n0,0\n1,0\n",
        "a.json": '{"points": [[0, 0], [1, 0]]}',
        "a.yaml": "points: [[0, 0], [1, 0]]\n",
    }
    for name, text in samples.items():
        import_terrain(text.encode(), name, {})
    look_at_mesh(samples["a.obj"].encode(), "a.obj", {})
