"""Documents to files and back; which formats there are, `table` says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stairwright.complaints import wrong_kind
from stairwright.documents import load_mapping, parse
from stairwright.errors import InputError
from stairwright.library import load_robot, robots
from stairwright.planning.plan import Plan
from stairwright.robot.description import Robot
from stairwright.simulation.result import Rollout

from .npz_file import load_npz
from .table import FORMATS, PLAN_FORMATS, ROBOT_FORMATS, ROLLOUT_FORMATS, Kind, by_ending, by_name

__all__ = [
    "PLAN_FORMATS",
    "ROBOT_FORMATS",
    "ROLLOUT_FORMATS",
    "by_ending",
    "by_name",
    "convert",
    "load",
    "load_plan",
    "load_rollout",
    "save",
]


def save(document: Plan | Rollout | Robot, path: str | Path, rate: float | None = None) -> None:
    """Write a document; the ending picks the format (``.mjcf`` and ``.xml`` are the same).

    Args:
        document: A plan, a rollout or a robot.
        path: Where to.
        rate: Samples per second of timed commands [Hz], where the format has them.

    Raises:
        InputError: For an unknown ending or a path that cannot be written.
    """
    kind = _kind(document)
    _write(Path(path), by_ending(FORMATS[kind], path, kind).write(document, rate))


def load_plan(path: str | Path) -> Plan:
    """Read a plan from a JSON or NPZ file.

    Raises:
        InputError: If the file is not one, or holds something else.
    """
    return parse(Plan, _expect(_load(Path(path)), "plan", path))


def load_rollout(path: str | Path) -> Rollout:
    """Read a rollout from a JSON or NPZ file.

    Raises:
        InputError: If the file is not one, or holds something else.
    """
    return parse(Rollout, _expect(_load(Path(path)), "rollout", path))


def load(path: str | Path) -> Plan | Rollout:
    """Read a plan or a rollout, whichever the file's schema names.

    Raises:
        InputError: If it is neither.
    """
    return _either(_load(Path(path)), path)


def convert(
    source: str | Path,
    format: str | None,  # noqa: A002
    out: str | Path,
    rate: float | None = None,
) -> None:
    """Write a plan, rollout or robot to `out`, as `format` or as the ending of `out` says.

    Args:
        source: A file, or a robot's name.
        format: One of its kind's; None: the ending picks it.
        out: Where to.
        rate: Samples per second of timed commands [Hz].

    Raises:
        InputError: If the file cannot be read, or its kind has no such format.
    """
    document = _document(source)
    kind = _kind(document)
    formats = FORMATS[kind]
    chosen = by_ending(formats, out, kind) if format is None else by_name(formats, format, kind)
    _write(Path(out), chosen.write(document, rate))


def _kind(document: Plan | Rollout | Robot) -> Kind:
    if isinstance(document, Plan):
        return "plan"
    return "rollout" if isinstance(document, Rollout) else "robot"


def _document(source: str | Path) -> Plan | Rollout | Robot:
    if str(source) in robots():
        return load_robot(str(source))
    data = _load(Path(source))
    if str(data.get("schema")).startswith("stairwright/robot/"):
        return parse(Robot, data)
    return _either(data, source)


def _either(data: dict[str, Any], path: str | Path) -> Plan | Rollout:
    if data.get("schema") == "stairwright/rollout/1":
        return parse(Rollout, data)
    return parse(Plan, _expect(data, "plan or rollout", path))


def _load(path: Path) -> dict[str, Any]:
    suffix = path.suffix.lower()
    if suffix in (".json", ".yaml", ".yml"):
        return load_mapping(path)
    if suffix == ".npz":
        return load_npz(path)
    raise InputError(f"{str(path)!r}: only .json and .npz files can be read back", ("path",))


def _expect(data: dict[str, Any], kind: str, path: str | Path) -> dict[str, Any]:
    schema, expected = data.get("schema"), [f"stairwright/{name}/1" for name in kind.split(" or ")]
    if schema not in expected:
        wrong = wrong_kind(schema, " ".join(expected))
        reason = f"is {wrong}" if wrong else f"holds {schema or 'no schema'}, not a {kind}"
        raise InputError(f"{path} {reason}", ("schema",))
    return data


def _write(path: Path, content: bytes) -> None:
    try:
        path.write_bytes(content)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot write {str(path)!r}: {reason}", ("path",)) from None
