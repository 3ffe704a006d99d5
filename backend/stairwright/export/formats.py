"""All file formats by name: the one table that files, REST and the command line share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

from stairwright.documents import load_mapping, parse
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.simulation.result import Rollout

from .csv_file import plan_csv, rollout_csv
from .json_file import document_json
from .npz_file import load_npz, plan_npz, rollout_npz

D = TypeVar("D", Plan, Rollout)
READABLE = ("json", "npz")


@dataclass(frozen=True)
class Format(Generic[D]):
    """One format: `write` gives the bytes of a whole file."""

    media_type: str
    suffix: str
    write: Callable[[D], bytes]


# rosbags and MuJoCo take a while to import: only those who write these formats pay.
def _plan_mcap(plan: Plan) -> bytes:
    from .mcap_file import plan_mcap

    return plan_mcap(plan)


def _rollout_mcap(rollout: Rollout) -> bytes:
    from .mcap_file import rollout_mcap

    return rollout_mcap(rollout)


def _plan_mjcf(plan: Plan) -> bytes:
    from .mjcf_file import plan_mjcf

    return plan_mjcf(plan)


def _rollout_html(rollout: Rollout) -> bytes:
    from .html_file import rollout_html

    return rollout_html(rollout)


PLAN_FORMATS: dict[str, Format[Plan]] = {
    "json": Format("application/json", ".json", document_json),
    "csv": Format("text/csv; charset=utf-8", ".csv", plan_csv),
    "npz": Format("application/x-npz", ".npz", plan_npz),
    "mcap": Format("application/x-mcap", ".mcap", _plan_mcap),
    "mjcf": Format("application/xml", ".xml", _plan_mjcf),
}
ROLLOUT_FORMATS: dict[str, Format[Rollout]] = {
    "json": Format("application/json", ".json", document_json),
    "csv": Format("text/csv; charset=utf-8", ".csv", rollout_csv),
    "npz": Format("application/x-npz", ".npz", rollout_npz),
    "mcap": Format("application/x-mcap", ".mcap", _rollout_mcap),
    "html": Format("text/html; charset=utf-8", ".html", _rollout_html),
}


def save_plan(plan: Plan, path: str | Path) -> None:
    """Write a plan; the ending picks the format (``.mjcf`` and ``.xml`` are the same).

    Raises:
        InputError: For an unknown ending or a path that cannot be written.
    """
    _write(Path(path), by_ending(PLAN_FORMATS, path, "plan").write(plan))


def save_rollout(rollout: Rollout, path: str | Path) -> None:
    """Write a rollout; the ending picks the format.

    Raises:
        InputError: For an unknown ending or a path that cannot be written.
    """
    _write(Path(path), by_ending(ROLLOUT_FORMATS, path, "rollout").write(rollout))


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
    data = _load(Path(path))
    if data.get("schema") == "stairwright/rollout/1":
        return parse(Rollout, data)
    return parse(Plan, _expect(data, "plan or rollout", path))


def convert(path: str | Path, format: str | None, out: str | Path) -> None:  # noqa: A002
    """Write the plan or rollout in `path` to `out`, as `format` or as the ending of `out` says.

    Raises:
        InputError: If the file cannot be read, or its kind has no such format.
    """
    document = load(path)
    if isinstance(document, Plan):
        chosen = _choose(PLAN_FORMATS, format, out, "plan")
        _write(Path(out), chosen.write(document))
    else:
        picked = _choose(ROLLOUT_FORMATS, format, out, "rollout")
        _write(Path(out), picked.write(document))


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
    endings = ", ".join(f".{name}" for name in formats)
    raise InputError(f"{str(path)!r}: a {kind} can be written as {endings}", ("path",))


def _choose(
    formats: Mapping[str, Format[D]], name: str | None, out: str | Path, kind: str
) -> Format[D]:
    return by_ending(formats, out, kind) if name is None else by_name(formats, name, kind)


def _load(path: Path) -> dict[str, Any]:
    suffix = path.suffix.lower()
    if suffix in (".json", ".yaml", ".yml"):
        return load_mapping(path)
    if suffix == ".npz":
        return load_npz(path)
    raise InputError(f"{str(path)!r}: only .json and .npz files can be read back", ("path",))


def _expect(data: dict[str, Any], kind: str, path: str | Path) -> dict[str, Any]:
    schema = data.get("schema")
    if schema not in [f"stairwright/{name}/1" for name in kind.split(" or ")]:
        raise InputError(f"{path} holds {schema or 'no schema'}, not a {kind}", ("schema",))
    return data


def _write(path: Path, content: bytes) -> None:
    try:
        path.write_bytes(content)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot write {str(path)!r}: {reason}", ("path",)) from None
