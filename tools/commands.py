"""The commands of `./dev`, by their names."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from .arm64 import arm64
from .building import build_alone, setup, studies, wheel
from .locks import lock
from .places import LOCKS
from .running import SetupError
from .serving import up
from .testing import atlas, bench, check_alone, test

WITH_ARGUMENTS: dict[str, Callable[[Sequence[str]], int]] = {
    "up": up,
    "test": test,
    "bench": bench,
    "atlas": atlas,
}
WITHOUT: dict[str, Callable[[], int | None]] = {
    "setup": lambda: setup(LOCKS[:1]),
    "studies": studies,
    "build": build_alone,
    "wheel": wheel,
    "arm64": arm64,
    "check": check_alone,
    "lock": lock,
}


def carry_out(command: str, arguments: Sequence[str]) -> int:
    """The exit status."""
    if command in WITH_ARGUMENTS:
        return WITH_ARGUMENTS[command](arguments)
    if arguments:
        raise SetupError(f"./dev {command} takes no arguments.")
    if command not in WITHOUT:
        known = ", ".join([*WITH_ARGUMENTS, *WITHOUT])
        raise SetupError(f"./dev knows no {command!r}: {known}.")
    return WITHOUT[command]() or 0
