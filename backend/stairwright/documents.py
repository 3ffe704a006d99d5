"""Documents: the validated, hashable data that files, REST bodies and Python objects share."""

from __future__ import annotations

import hashlib
import json
import pkgutil
from collections.abc import Callable, Generator, Mapping
from pathlib import Path
from typing import Any, Self, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, Discriminator, Tag, ValidationError

from .complaints import foremost, wording, wrong_kind
from .errors import InputError

MAX_FILE_BYTES = 64 * 2**20

_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

# The last three are how PyYAML's constructors fail: a 13th month, "!!int x", "!!bool x".
_UNREADABLE = (yaml.YAMLError, RecursionError, ValueError, AttributeError, KeyError)


class Model(BaseModel):
    """A frozen record without unknown fields, NaN or infinities."""

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
        populate_by_name=True,
        serialize_by_alias=True,
        protected_namespaces=(),
    )

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy with some fields replaced, unchecked; nothing that was cached comes along."""
        copied = super().model_copy(update=update, deep=deep)
        for name in copied.__dict__.keys() - type(self).model_fields.keys():
            del copied.__dict__[name]
        return copied

    def __iter__(self) -> Generator[tuple[str, Any]]:
        """Names and values of the fields."""
        for name, value in super().__iter__():
            yield name, Deferred.read(value)

    @classmethod
    def trusted(cls, **values: Any) -> Self:
        """A record of values that are our own, unchecked: all its fields, by name, in their order.

        It equals what `model_construct` makes of them, in a third of the time.
        """
        record = cls.__new__(cls)
        for name, content in (
            ("__dict__", values),
            ("__pydantic_fields_set__", set(values)),
            ("__pydantic_extra__", None),
            ("__pydantic_private__", None),
        ):
            object.__setattr__(record, name, content)
        return record


M = TypeVar("M", bound=BaseModel)


class Deferred:
    """Stands in a record for a value that takes long to make, until it is needed.

    It equals that value, and what is pickled or copied deeply is the value.
    """

    def __init__(self, make: Callable[[], Any], source: Any = None) -> None:
        """`source` is what `make` makes it of, for those who need no more than that."""
        self._make: Callable[[], Any] | None = make
        self._made: Any = None
        self.source = source

    @property
    def value(self) -> Any:
        """The value, made once; threads that meet here may each make it."""
        make = self._make
        if make is not None:
            self._made, self._make = make(), None  # and what it is made of is let go
            self.source = None
        return self._made

    @staticmethod
    def source_of(record: BaseModel, name: str) -> Any:
        """What a field of a record is still to be made of; None where it is there, or untold."""
        value = record.__dict__.get(name)
        return value.source if isinstance(value, Deferred) else None

    @staticmethod
    def read(value: Any) -> Any:
        """`value`, or what it stands for: serialises a field that may be deferred."""
        return value.value if isinstance(value, Deferred) else value

    def __eq__(self, other: object) -> bool:
        return bool(self.value == Deferred.read(other))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return repr(self.value)

    def __reduce__(self) -> tuple[Any, ...]:
        return Deferred.read, (self.value,)


class _DeferrableField:
    """Reads a record's field, and makes its value first where that is deferred."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, record: BaseModel | None, owner: type | None = None) -> Any:
        if record is None or self._name not in record.__dict__:
            raise AttributeError(self._name)
        value = record.__dict__[self._name]
        if isinstance(value, Deferred):
            value = record.__dict__[self._name] = value.value
        return value

    def __set__(self, record: BaseModel, value: Any) -> None:
        record.__dict__[self._name] = value


def deferrable(*names: str) -> Callable[[type[M]], type[M]]:
    """Lets fields of a model be `Deferred` in records that are made without validation.

    Such a field is serialised through `Deferred.read`.
    """

    def decorate(model: type[M]) -> type[M]:
        for name in names:
            setattr(model, name, _DeferrableField(name))
        return model

    return decorate


def _number_or_other(value: Any) -> str:
    return "~other" if isinstance(value, (list, tuple, Mapping, Model)) else "~number"


# For a number or something of several: `Annotated[Annotated[float, NUMBER] | Annotated[..., OTHER],
# EITHER]`. Tagged, or a bad value would be reported for both, under names of pydantic's own.
NUMBER, OTHER, EITHER = Tag("~number"), Tag("~other"), Discriminator(_number_or_other)


def parse(model: type[M], data: Any) -> M:
    """Validate `data` as `model`.

    Raises:
        InputError: For the first bad value, with its field path.
    """
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise first_error(error, model) from None


def first_error(error: ValidationError, model: type[BaseModel]) -> InputError:
    """What was wrong first, and where."""
    first = foremost(error.errors(include_url=False))[0]
    # A part that begins with ~ names an alternative of the model, nothing that the data has.
    where = tuple(part for part in first["loc"] if not str(part).startswith("~"))
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, InputError):
        return cause.within(*where)
    return InputError(wording(first, model), where)


def load_document(model: type[M], path: Path) -> M:
    """The document in one YAML or JSON file.

    Raises:
        InputError: If the file cannot be read, is of another kind, or for its first bad value.
    """
    return parse(model, mapping_of(model, path))


def mapping_of(model: type[BaseModel], path: Path) -> dict[str, Any]:
    """What a file that may hold such a document holds, not yet validated.

    Raises:
        InputError: If the file cannot be read, or says that it is of another kind.
    """
    data = load_mapping(path)
    expected = model.model_fields["schema_"].annotation
    wrong = wrong_kind(data.get("schema"), str(expected))
    if wrong:
        raise InputError(f"{path} is {wrong}")
    return data


def load_mapping(path: Path) -> dict[str, Any]:
    """Read one YAML or JSON file that holds a mapping.

    Raises:
        InputError: If the file is missing, too large, not text or not a mapping.
    """
    try:
        if path.stat().st_size > MAX_FILE_BYTES:
            raise InputError(f"{path} is larger than {MAX_FILE_BYTES >> 20} MiB")
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise InputError(f"{path} is not UTF-8 text") from None
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    except ValueError as error:  # a name that no file can have
        raise InputError(f"cannot read {str(path)!r}: {error}") from None
    return parse_mapping(text, str(path))


def parse_mapping(text: str, origin: str) -> dict[str, Any]:
    """Parse YAML (of which JSON is a part) that must hold a mapping; aliases are refused."""
    try:
        data = json.loads(text) if text.lstrip().startswith("{") else _read_yaml(text)
    except _UNREADABLE as error:
        reason = " ".join(str(error).split())[:200]
        raise InputError(f"{origin} cannot be read as YAML or JSON: {reason}") from None
    if not isinstance(data, dict):
        raise InputError(f"{origin} must hold a mapping of names to values")
    return data


def _read_yaml(text: str) -> Any:
    # Aliases let a few bytes stand for gigabytes.
    if any(isinstance(event, yaml.AliasEvent) for event in yaml.parse(text, _Loader)):
        raise yaml.YAMLError("YAML aliases are not accepted here")
    return yaml.load(text, _Loader)  # noqa: S506 - both loaders are the safe ones


def content_hash(data: Any) -> str:
    """``sha256:`` and 16 hex digits of the canonical JSON of plain data or of a model."""
    if isinstance(data, BaseModel):
        data = data.model_dump(mode="json")
    text = json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return "sha256:" + hashlib.sha256(text.encode()).hexdigest()[:16]


def save(document: Model, path: str, rate: float | None = None) -> None:
    """Write a plan, a rollout or a robot; see `stairwright.export.formats.save`.

    Exports import the documents that they write, so documents know them by name alone.
    """
    pkgutil.resolve_name("stairwright.export.formats:save")(document, path, rate)
