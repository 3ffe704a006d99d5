"""What is wrong with a document, in words of files and JSON rather than of Python."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping, Sequence
from typing import Any, get_args

from pydantic import BaseModel

Error = Mapping[str, Any]

_WORDINGS = {
    **dict.fromkeys(
        ("model_type", "model_attributes_type", "dict_type", "mapping_type"),
        "must be a mapping of names to values",
    ),
    **dict.fromkeys(("tuple_type", "list_type"), "must be a list"),
    "too_short": "must hold at least {min_length}, not {actual_length}",
    "too_long": "must hold at most {max_length}, not {actual_length}",
    **dict.fromkeys(("float_parsing", "float_type"), "must be a number"),
    **dict.fromkeys(("int_parsing", "int_type", "int_from_float"), "must be a whole number"),
}
_SCHEMA = re.compile(r"stairwright/([a-z]+)/\d+")
SEVERAL = ("trials", "margins")  # kinds that are called by a plural
_MOST_NAMES = 20
_ALIKE = 0.7  # of difflib's ratio, from which on a name is taken for a misspelt one


def wording(error: Error, *documents: Any) -> str:
    """What one of pydantic's errors says.

    Args:
        error: Of `pydantic.ValidationError.errors`.
        documents: Types of what was validated, to tell which fields there are.
    """
    if error["type"] == "extra_forbidden":
        return _unknown_field(error["loc"], documents)
    if _is_of_schema(error):
        wrong = wrong_kind(error.get("input"), error["ctx"]["expected"])
        if wrong:
            return f"this is {wrong}"
    words = _WORDINGS.get(error["type"], "{msg}")
    return words.format_map({**error.get("ctx", {}), "msg": error["msg"]})


def foremost(errors: Sequence[Error]) -> list[Error]:
    """The errors, those first that explain others; of a wrong kind of document only that one."""
    wrong = [error["loc"][:-1] for error in errors if _is_of_schema(error)]
    kept = [
        error
        for error in errors
        if _is_of_schema(error) or not any(error["loc"][: len(loc)] == loc for loc in wrong)
    ]
    return sorted(kept, key=lambda error: error["type"] != "extra_forbidden")


def wrong_kind(schema: Any, expected: str) -> str | None:
    """What a document of that schema is and is not; None where its kind is one that is expected.

    Args:
        schema: What the document says that it is.
        expected: Text with the schemas that may be here.
    """
    kinds = list(dict.fromkeys(_SCHEMA.findall(expected)))
    found = _SCHEMA.fullmatch(schema) if isinstance(schema, str) else None
    if found is None or found[1] in kinds:
        return None
    return f"{described(schema)}, not {' or '.join(map(_one, kinds))}"


def schema_in(data: bytes) -> str | None:
    """The schema that a JSON or YAML file names near its beginning, without reading all of it."""
    named = re.search(rb"""schema["']?\s*:\s*["']?(stairwright/[a-z]+/\d+)""", data[:4096])
    return named[1].decode() if named else None


def described(schema: str) -> str:
    """A document by its kind, and its schema."""
    return f"{_one(schema.split('/')[1])} ({schema})"


def _one(kind: str) -> str:
    return kind if kind in SEVERAL else f"a {kind}"


def _is_of_schema(error: Error) -> bool:
    return bool(error["type"] == "literal_error") and tuple(error["loc"][-1:]) == ("schema",)


def _unknown_field(where: Sequence[str | int], documents: Sequence[Any]) -> str:
    *path, name = where
    models = [model for each in documents for model in _models(each)]
    for part in path:
        models = [
            inner for model in models for inner in _models(_fields(model).get(str(part)))
        ] or models
    names = list(dict.fromkeys(name for model in models for name in _fields(model)))
    meant = difflib.get_close_matches(str(name), names, 1, _ALIKE)
    if meant:
        return f"unknown field; did you mean {meant[0]!r}?"
    if 0 < len(names) <= _MOST_NAMES:
        return f"unknown field; there are: {', '.join(names)}"
    return "unknown field"


def _fields(model: type[BaseModel]) -> dict[str, Any]:
    """Types of a model's fields by the names that documents know them by."""
    return {each.alias or name: each.annotation for name, each in model.model_fields.items()}


def _models(annotation: Any) -> list[type[BaseModel]]:
    """The models that a type is made of: of a union each, of a list its elements'."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    parts = get_args(getattr(annotation, "__value__", annotation))
    return [model for part in parts for model in _models(part)]
