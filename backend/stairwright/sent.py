"""Documents of ours in files from outside, which may be anything."""

from __future__ import annotations

from typing import Any

from .complaints import schema_in, wrong_kind
from .documents import parse_mapping
from .errors import InputError

MAX_TEXT = 4 * 2**20  # bytes of a JSON or CSV file
MAX_YAML = 2**18  # characters; read by plain Python
MAX_DEPTH = 20  # of brackets in YAML


def sent_text(data: bytes) -> str:
    """The text in a file.

    Raises:
        InputError: If it is too long, or not UTF-8.
    """
    if len(data) > MAX_TEXT:
        raise InputError(f"a text file may have at most {MAX_TEXT >> 20} MiB", ("file",))
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        raise InputError("the file is not UTF-8 text", ("file",)) from None


def sent_mapping(data: bytes, suffix: str, schema: str) -> dict[str, Any]:
    """What a JSON or YAML file holds, not yet validated.

    Args:
        data: The file.
        suffix: The ending of its name, without the dot.
        schema: What its kind of document calls itself.

    Raises:
        InputError: If it cannot be read, or says that it is of another kind.
    """
    wrong = wrong_kind(schema_in(data), schema)
    if wrong:
        raise InputError(f"the file is {wrong}", ("file",))
    text = sent_text(data)
    if suffix == "json":
        if not text.lstrip().startswith("{"):
            raise InputError("the file must hold a JSON object", ("file",))
    else:
        _refuse_deep_yaml(text)
    try:
        return parse_mapping(text, "the file")
    except InputError as error:
        raise error.within("file") from None


def without_readonly(value: Any) -> Any:
    """GET adds `readonly` to a document; what was got can be sent back as it is."""
    if isinstance(value, dict) and isinstance(value.get("readonly"), bool):
        return {key: each for key, each in value.items() if key not in ("readonly", "version")}
    return value


def _refuse_deep_yaml(text: str) -> None:
    """YAML takes its reader time that grows with the square of the nesting."""
    if len(text) > MAX_YAML:
        raise InputError(f"a YAML file may have at most {MAX_YAML >> 10} KiB", ("file",))
    depth = 0
    for character in text:
        depth += (character in "[{") - (character in "]}")
        if depth > MAX_DEPTH:
            raise InputError(f"the file nests deeper than {MAX_DEPTH} levels", ("file",))
