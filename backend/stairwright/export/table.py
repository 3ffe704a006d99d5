"""Every file format: the one table that files, REST, the command line and the page share.

A new format is a file that writes it and a line here. Writers are imported when first used: rosbags
and MuJoCo take a while, and a web process that only needs the names should have neither.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar

from stairwright.errors import InputError

if TYPE_CHECKING:
    from stairwright.planning.plan import Plan
    from stairwright.robot.description import Robot
    from stairwright.simulation.result import Rollout

LEAST_RATE, MOST_RATE, USUAL_RATE = 10.0, 1000.0, 100.0  # of timed commands [Hz]
D = TypeVar("D")
Kind = Literal["plan", "rollout", "robot"]


@dataclass(frozen=True)
class Format(Generic[D]):
    """One format.

    Attributes:
        writer: ``module.function`` of this package: the bytes of a whole file of a document.
        suffix: Of its files.
        media_type: As in HTTP.
        note: For menus, a few words.
        rated: Whether it holds commands at a fixed rate, which can be chosen.
    """

    writer: str
    suffix: str
    media_type: str
    note: str
    rated: bool = False

    def write(self, document: D, rate: float | None = None) -> bytes:
        """The bytes of a whole file, with `rate` commands a second [Hz]; None: the usual rate.

        Raises:
            InputError: If this document cannot be written so, or `rate` is none of the format's.
        """
        self.check_rate(rate)
        module, function = self.writer.split(".")
        write = getattr(importlib.import_module(f".{module}", __package__), function)
        if self.rated:
            return bytes(write(document, USUAL_RATE if rate is None else rate))
        return bytes(write(document))

    def check_rate(self, rate: float | None) -> None:
        """Refuse a rate that the format does not have.

        Raises:
            InputError: If there is no such rate.
        """
        if rate is None:
            return
        if not self.rated:
            raise InputError("this format has no rate: it holds no timed commands", ("rate",))
        if not LEAST_RATE <= rate <= MOST_RATE:
            raise InputError(f"must lie between {LEAST_RATE:g} and {MOST_RATE:g} Hz", ("rate",))


_YAML = "application/yaml"
_JSON, _CSV, _XML = "application/json", "text/csv; charset=utf-8", "application/xml"
_ZIP = "application/zip"
_NPZ, _MCAP, _HTML = "application/x-npz", "application/x-mcap", "text/html; charset=utf-8"

PLAN_FORMATS: dict[str, Format[Plan]] = {
    "json": Format("json_file.document_json", ".json", _JSON, "stairwright/plan/1"),
    "csv": Format("csv_file.plan_csv", ".csv", _CSV, "poses, one a row"),
    "npz": Format("npz_file.plan_npz", ".npz", _NPZ, "arrays for NumPy"),
    "mcap": Format("mcap_file.plan_mcap", ".mcap", _MCAP, "for Foxglove and ROS 2", rated=True),
    "mjcf": Format("mjcf_file.plan_mjcf", ".xml", _XML, "robot and terrain for MuJoCo"),
    "urdf": Format("urdf_file.plan_urdf", ".urdf", _XML, "the robot for ROS 2"),
    "bundle": Format("bundle_file.plan_bundle", ".zip", _ZIP, "player for the robot, in C++"),
}
ROLLOUT_FORMATS: dict[str, Format[Rollout]] = {
    "html": Format("html_file.rollout_html", ".html", _HTML, "3-D replay in one file"),
    "json": Format("json_file.document_json", ".json", _JSON, "stairwright/rollout/1"),
    "csv": Format("csv_file.rollout_csv", ".csv", _CSV, "series, one sample a row"),
    "npz": Format("npz_file.rollout_npz", ".npz", _NPZ, "arrays for NumPy"),
    "mcap": Format("mcap_file.rollout_mcap", ".mcap", _MCAP, "for Foxglove and ROS 2"),
}
ROBOT_FORMATS: dict[str, Format[Robot]] = {
    "yaml": Format("yaml_file.robot_yaml", ".yaml", _YAML, "stairwright/robot"),
    "json": Format("json_file.document_json", ".json", _JSON, "stairwright/robot"),
    "urdf": Format("urdf_file.robot_urdf", ".urdf", _XML, "for ROS 2"),
    "mjcf": Format("mjcf_file.robot_mjcf", ".xml", _XML, "for MuJoCo"),
}
FORMATS: dict[Kind, Mapping[str, Format[Any]]] = {
    "plan": PLAN_FORMATS,
    "rollout": ROLLOUT_FORMATS,
    "robot": ROBOT_FORMATS,
}


def by_name(formats: Mapping[str, Format[D]], name: str, kind: str) -> Format[D]:
    """The format called `name`.

    Raises:
        InputError: If there is none; the message lists the valid names.
    """
    if name not in formats:
        raise InputError(
            f"a {kind} has no format {name!r}; there are: {', '.join(formats)}", ("format",)
        )
    return formats[name]


def by_ending(formats: Mapping[str, Format[D]], path: str | Path, kind: str) -> Format[D]:
    """The format that the ending of `path` names.

    Raises:
        InputError: If it names none; the message lists the valid endings.
    """
    suffix = Path(path).suffix.lower()
    for name, format_ in formats.items():
        if suffix in (format_.suffix, f".{name}"):
            return format_
    usual = [format_.suffix for format_ in formats.values()]
    endings = ", ".join(dict.fromkeys([*(f".{name}" for name in formats), *usual]))
    raise InputError(f"{str(path)!r}: a {kind} can be written as {endings}", ("path",))


def names(kind: Kind) -> str:
    """The names of a kind's formats, as one would say them."""
    *most, last = FORMATS[kind]
    return f"{', '.join(most)} or {last}"
