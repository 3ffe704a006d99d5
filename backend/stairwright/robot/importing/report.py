"""What an import answers: the robot, and all that was not read but taken."""

from __future__ import annotations

from collections.abc import Mapping

from pydantic import Field

from stairwright.documents import Model
from stairwright.robot.description import Robot

_MOST, _LONGEST = 200, 500  # remarks, and characters of one


class JointMap(Model):
    """How a joint of ours follows from one of the file's: ours = sign * theirs + offset."""

    name: str = Field(description="in the file")
    sign: float = Field(description="+1 or -1: the file's axis against ours")
    offset: float = Field(description="our angle where the file's joint is at 0 [rad]")


class Imported(Model):
    """A robot that was read from a file.

    `assumed` lists numbers that the file does not give, `warnings` what its reader should know.
    """

    robot: Robot
    assumed: list[str]
    warnings: list[str]
    joints: dict[str, JointMap] = Field(description="of the 12 joints, by our names")
    locked: dict[str, float] = Field(
        description="the file's other joints, and where they are held [rad or m]"
    )


class Notes:
    """Remarks that gather while a file is read."""

    def __init__(self) -> None:
        self.assumed: list[str] = []
        self.assumed_fields: dict[str, int] = {}
        self.warnings: list[str] = []

    def assume(self, text: str, *fields: str) -> None:
        """A number that was taken because the file gives none, and where the document has it."""
        if (sentence := _add(self.assumed, text)) is not None:
            self.assumed_fields |= dict.fromkeys(fields, sentence)

    def warn(self, text: str) -> None:
        """Something that was read and may not be what was meant."""
        _add(self.warnings, text)


def listed(names: list[str] | Mapping[str, object]) -> str:
    """The first few names, and how many there are."""
    every = list(names)
    return ", ".join(every[:4]) + (f" and {len(every) - 4} more" if len(every) > 4 else "")


def _add(remarks: list[str], text: str) -> int | None:
    """Which of the remarks it is; None where there are too many."""
    text = " ".join(text.split())[:_LONGEST]
    if text not in remarks:
        if len(remarks) == _MOST:
            return None
        remarks.append(text)
    return remarks.index(text)
