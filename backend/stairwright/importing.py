"""Robots and terrains from files of other tools."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_args

from .arguments import as_friction, as_number
from .errors import InputError
from .library import load_robot, robots
from .robot.importing.bounded import import_bounded
from .robot.importing.holding import checked_hold
from .robot.importing.local import gather
from .robot.importing.report import Imported
from .terrain.mesh import Up
from .terrain.profile import Terrain


def import_robot(
    path: str | os.PathLike[str],
    abduction: float = 0.0,
    *,
    wheel_radius: float | None = None,
    hold: Mapping[str, float] | None = None,
) -> Imported:
    """The robot in a URDF or MJCF file, in a zip that holds one with its meshes, or in our YAML.

    The file is read in a process of its own with little time and memory; meshes are looked for in
    the file's own folder and below, or in the zip, and nowhere else.

    Args:
        path: The file; its ending is .urdf, .xml, .mjcf, .zip, .yaml or .json.
        abduction: Angle at which the legs are locked, outward from upright [rad].
        wheel_radius: Where the file shows none, or another one [m].
        hold: Joints that count as rigid, by the file's names, and where [rad or m, the file's].

    Returns:
        ``.robot``, and what was ``.assumed`` and should be known (``.warnings``).

    Raises:
        InputError: If it is no robot of four legs with a thigh, a calf and a wheel each; names the
            link or joint that does not fit.
    """
    options: dict[str, Any] = {"abduction": as_number(abduction, "abduction")}
    if wheel_radius is not None:
        options["wheel_radius"] = as_number(wheel_radius, "wheel_radius")
        if not 0.0 < options["wheel_radius"] <= 10.0:
            raise InputError("must be above 0 and at most 10 m", ("wheel_radius",))
    options["hold"] = checked_hold(hold or {})
    name, content, files = gather(path)
    return import_bounded(name, content, files, options, [load_robot(each) for each in robots()])


def import_terrain(
    path: str | os.PathLike[str],
    *,
    name: str | None = None,
    friction: float | None = None,
    x: float = 0.0,
    y: float | None = None,
    heading: float = 0.0,
    scale: float = 1.0,
    up: Up = "z",
) -> Terrain:
    """The profile in a CSV, JSON or YAML file; of a mesh, the upper edge of a vertical cut.

    Args:
        path: The file; its ending is .csv, .txt, .json, .yaml, .stl, .obj, .ply or .off.
        name: Of the terrain; the file's by default.
        friction: Coulomb friction, wheel on terrain; what a document says, or 0.6.
        x: Of a mesh that becomes 0 [m, after scaling].
        y: Of the cut [m]; by default the middle of the mesh.
        heading: Direction of travel through a mesh, counter-clockwise from +x [rad].
        scale: Metres per unit of a mesh (0.001 for millimetres).
        up: The axis of a mesh that points up.

    Raises:
        InputError: If the file cannot be read or holds no profile.
    """
    from .jobs import uploads

    if up not in get_args(Up):
        raise InputError(f"must be one of {', '.join(get_args(Up))}", ("up",))
    options: dict[str, Any] = {
        "origin": (as_number(x, "x"), None if y is None else as_number(y, "y")),
        "heading": as_number(heading, "heading"),
        "scale": as_number(scale, "scale"),
        "up": up,
    }
    if not 0.0 < options["scale"] <= 1e3:
        raise InputError("must be above 0 and at most 1000", ("scale",))
    if friction is not None:
        options["friction"] = as_friction(friction)
    file = Path(path)
    try:
        content = file.read_bytes()
    except (OSError, ValueError) as error:  # or a name that no file can have
        raise InputError(f"cannot read {file}: {getattr(error, 'strerror', error)}") from None
    given = options | uploads.name_option(file.name, name)
    return Terrain.model_validate(uploads.import_terrain(content, file.name, given))
