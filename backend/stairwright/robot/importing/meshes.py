"""Meshes of a robot file: those that were sent are handed to MuJoCo, the others are left out."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any

import numpy as np

from stairwright.arrays import Floats, Ints
from stairwright.errors import InputError

from .collada import corners
from .upload import Upload

_NATIVE = (".stl", ".obj", ".msh")  # read by MuJoCo
_CONVERTED = (".ply", ".off")
_MOST_VERTICES = 500_000


def provide(spec: Any, upload: Upload) -> dict[str, str]:
    """Give `spec` every mesh from memory; the names and files of those that it cannot have.

    Afterwards no mesh names a file that MuJoCo would look for on the disk.
    """
    missing: dict[str, str] = {}
    assets = {}
    for k, mesh in enumerate(list(spec.meshes)):
        if not mesh.file:
            continue  # its vertices stand in the file
        reference = mesh.file
        path = upload.find(reference)
        suffix = PurePosixPath(reference).suffix.lower()
        content = None if path is None else upload.files[path]
        if content is not None and suffix in _NATIVE and not _is_text_stl(content, suffix):
            mesh.file = f"mesh_{k}{suffix}"
            assets[mesh.file] = content
        elif content is None or not _convert(mesh, content, suffix):
            missing[mesh.name] = PurePosixPath(reference).name
    spec.assets = assets
    spec.meshdir = spec.compiler.meshdir = ""
    return missing


def _is_text_stl(content: bytes, suffix: str) -> bool:
    if suffix != ".stl" or content[:5].lower() != b"solid":
        return False
    count = int.from_bytes(content[80:84], "little")
    return len(content) != 84 + 50 * count


def _convert(mesh: Any, content: bytes, suffix: str) -> bool:
    """Read what MuJoCo cannot; False if nothing comes of it."""
    read = None
    if suffix == ".dae":
        read = _read_collada(content)
    elif suffix in (".stl", *_CONVERTED):
        read = read_mesh(content, suffix.removeprefix("."))
    if read is None:
        return False
    vertices, faces = read
    if not (4 <= len(vertices) <= _MOST_VERTICES and np.isfinite(vertices).all()):
        return False
    mesh.file = ""
    mesh.uservert = vertices.ravel()
    if len(faces):  # else MuJoCo takes the hull
        mesh.userface = faces.ravel()
    return True


def _read_collada(content: bytes) -> tuple[Floats, Ints] | None:
    """Corners of the hull, without triangles; None if it cannot be read."""
    try:
        points = corners(content, "the mesh")
    except InputError:
        return None
    return None if points is None else (points, np.zeros((0, 3), np.int64))


def read_mesh(content: bytes, kind: str) -> tuple[Floats, Ints] | None:
    """Vertices (n, 3) and triangles (m, 3) of a mesh; None if it cannot be read."""
    import trimesh

    load: Callable[..., Any] = trimesh.load
    try:
        read = load(io.BytesIO(content), file_type=kind, force="mesh", process=False)
        return np.asarray(read.vertices, float), np.asarray(read.faces, np.int64)
    except MemoryError:
        raise
    except Exception:  # noqa: BLE001 - trimesh raises whatever its readers do
        return None
