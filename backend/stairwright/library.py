"""Named data files: the presets under ``terrains/`` and ``robots/``, or a path, or a mapping."""

from __future__ import annotations

import functools
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel

from .documents import load_document, mapping_of, parse
from .errors import InputError
from .resources import data_folder
from .robot.description import Robot
from .robot.importing.upload import XML_ENDINGS
from .terrain.generation import terrain_in
from .terrain.profile import Terrain

D = TypeVar("D", bound=BaseModel)
_OWN = (".yaml", ".yml", ".json")
_OTHER_TOOLS = (*XML_ENDINGS, ".zip")


def load_terrain(source: str | os.PathLike[str] | Mapping[str, Any] | Terrain) -> Terrain:
    """A terrain from a preset's name, a file, or a mapping.

    Files are YAML, JSON or CSV, or meshes, see `import_terrain`. A mapping, also one in a file, is
    a whole document or a `kind` with its measures (`stairwright.terrain.generation`):
    ``{"kind": "stair", "rise": 0.18, "run": 0.28, "count": 5}``.

    Raises:
        InputError: If there is no such preset or file, or a value is bad.
    """
    if isinstance(source, (str, os.PathLike)):
        path = Path(source)
        if _is_table_or_mesh(path.suffix):
            from .importing import import_terrain

            return import_terrain(source)
        if path.suffix.lower() in _OWN:
            return terrain_in(mapping_of(Terrain, path))
    if isinstance(source, Mapping):
        return terrain_in(source)
    return _load(Terrain, "terrains", source)


def load_robot(source: str | os.PathLike[str] | Mapping[str, Any] | Robot) -> Robot:
    """A robot from its name, a YAML or JSON file, or a mapping.

    Raises:
        InputError: If there is no such robot or file, or a value is bad.
    """
    if isinstance(source, (str, os.PathLike)) and Path(source).suffix.lower() in _OTHER_TOOLS:
        raise InputError(
            f"{str(source)!r} is another tool's: `stairwright robot import` makes a robot "
            "of it, in Python sw.import_robot"
        )
    return _load(Robot, "robots", source)


def terrains() -> list[str]:
    """Names of the terrain presets."""
    return _names("terrains")


def robots() -> list[str]:
    """Names of the robots."""
    return _names("robots")


def _is_table_or_mesh(suffix: str) -> bool:
    if suffix.lower() in ("", *_OWN):
        return False  # without loading what reads the others
    from .jobs.uploads import READERS

    return suffix.lower().removeprefix(".") in READERS


def _names(folder: str) -> list[str]:
    return sorted(path.stem for path in data_folder(folder).glob("*.yaml"))


@functools.cache
def _preset(model: type[D], path: Path, changed: int) -> D:  # noqa: ARG001 - part of the key
    return load_document(model, path)


def _load(model: type[D], folder: str, source: str | os.PathLike[str] | Mapping[str, Any] | D) -> D:
    if isinstance(source, model):
        return source
    if isinstance(source, Mapping):
        return parse(model, dict(source))
    if not isinstance(source, (str, os.PathLike)):
        raise InputError(f"expected a name, a path or a mapping, got {type(source).__name__}")
    if str(source) in _names(folder):
        preset = data_folder(folder) / f"{source}.yaml"
        loaded: D = _preset(model, preset, preset.stat().st_mtime_ns)
        return loaded
    path = Path(source)
    if path.suffix.lower() in _OWN:
        return load_document(model, path)
    kind = folder.removesuffix("s")
    raise InputError(
        f"no {kind} is called {str(source)!r}; there are: {', '.join(_names(folder))} "
        "(or give a .yaml or .json file)"
    )
