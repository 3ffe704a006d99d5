"""Robot files from outside, read in a worker that can open nothing and may use little memory.

What reads them is imported by the worker only: the web process names these functions, and does
without MuJoCo.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from stairwright.documents import parse
from stairwright.robot.description import Robot


def import_robot(
    data: bytes, file_name: str, options: Mapping[str, Any], known: Sequence[Mapping[str, Any]]
) -> dict[str, Any]:
    """The robot in a file, as a `report.Imported` document.

    Args:
        data: The file: URDF, MJCF, a zip that holds one with its meshes, or a document of ours.
        file_name: Its name.
        options: ``abduction`` [rad], ``wheel_radius`` [m], ``hold`` [rad or m by joint].
        known: Documents of the presets, to compare with.

    Raises:
        InputError: If it is no robot of four legs with wheels; names the link or joint.
    """
    from stairwright.robot.importing.read import read_file

    robots = [parse(Robot, dict(document)) for document in known]
    return read_file(data, file_name, options, robots).model_dump(mode="json")


def rehearse() -> None:
    """Read small ones, so that every module that this takes is loaded."""
    from stairwright.robot.importing import rehearsal

    rehearsal.rehearse()
