"""Meshes of a robot file: those that were sent are handed to MuJoCo, the others are left out."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any

import numpy as np

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
    if suffix != ".stl" or not content[:5].lower() == b"solid":
        return False
    count = int.from_bytes(content[80:84], "little")
    return len(content) != 84 + 50 * count


def _convert(mesh: Any, content: bytes, suffix: str) -> bool:
    """Read what MuJoCo cannot; False if nothing comes of it."""
    kind = suffix.removeprefix(".")
    if suffix not in (".stl", *_CONVERTED):
        return False
    import trimesh

    load: Callable[..., Any] = trimesh.load
    try:
        read = load(io.BytesIO(content), file_type=kind, force="mesh", process=False)
        vertices, faces = np.asarray(read.vertices, float), np.asarray(read.faces, int)
    except Exception:  # noqa: BLE001 - trimesh raises whatever its readers do
        return False
    if not (4 <= len(vertices) <= _MOST_VERTICES and len(faces) and np.isfinite(vertices).all()):
        return False
    mesh.file = ""
    mesh.uservert, mesh.userface = vertices.ravel(), faces.ravel()
    return True
