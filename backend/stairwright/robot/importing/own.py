"""A robot's document of ours, as the page and the command line write it: all of it is known."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.robot.conversion import LATEST, to_latest
from stairwright.robot.description import Robot
from stairwright.sent import sent_mapping, without_readonly

from .report import Imported

OWN_ENDINGS = (".yaml", ".yml", ".json")


def read_own(data: bytes, suffix: str, options: Mapping[str, Any]) -> Imported:
    """The robot in a document, in the newest schema.

    Raises:
        InputError: If it is none, for its first bad value, or for an option of other files.
    """
    for option, value in options.items():
        if value:
            raise InputError("is for URDF and MJCF: a document of ours says it itself", (option,))
    mapping = sent_mapping(data, suffix.removeprefix("."), LATEST)
    robot = to_latest(parse(Robot, without_readonly(mapping)))
    return Imported(robot=robot, assumed=list(robot.assumed), warnings=[], joints={}, locked={})
