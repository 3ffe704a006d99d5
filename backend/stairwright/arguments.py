"""Arguments of Python calls: checked like documents, so that a bad one is an `InputError`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

from .documents import Model, parse
from .errors import InputError

M = TypeVar("M", bound=Model)

MOST_FRICTION = 5.0
MOST_SEED = 2**31 - 1


def as_model(model: type[M], value: Any, field: str) -> M:
    """`value` itself if it is a `model`; else what a mapping (or None: no values) describes.

    Raises:
        InputError: For the first bad value; its path starts at `field`.
    """
    if isinstance(value, model):
        return value
    data = {} if value is None else dict(value) if isinstance(value, Mapping) else value
    try:
        return parse(model, data)
    except InputError as error:
        raise error.within(field) from None


def as_friction(value: Any) -> float:
    """A Coulomb friction coefficient.

    Raises:
        InputError: If it is none.
    """
    number = as_number(value, "friction")
    if not 0.0 < number <= MOST_FRICTION:
        raise InputError(f"must be a number above 0 and at most {MOST_FRICTION:g}", ("friction",))
    return number


def as_number(value: Any, field: str) -> float:
    """A number, numpy's too.

    Raises:
        InputError: If it is none.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise InputError("must be a number", (field,))
    try:
        return float(value)
    except OverflowError:
        raise InputError("is too large", (field,)) from None


def as_whole(value: Any, low: int, high: int, field: str) -> int:
    """A whole number from `low` to `high`.

    Raises:
        InputError: If it is none.
    """
    whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not whole or not low <= value <= high:
        raise InputError(f"must be a whole number from {low} to {high:,}", (field,))
    return int(value)
