"""`import_robot`: a robot from a URDF or MJCF file, with the presets to compare it with."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from .arguments import as_number
from .errors import InputError
from .library import load_robot, robots
from .robot.importing.bounded import import_bounded
from .robot.importing.holding import checked_hold
from .robot.importing.local import gather
from .robot.importing.report import Imported


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
