"""Where the data that ships with the program lies: a checkout's top level, or inside the wheel."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def data_folder(name: str) -> Path:
    """The folder `name` (``terrains``, ``robots``) of the checkout or of the installed wheel."""
    shipped = _PACKAGE / "data" / name
    return shipped if shipped.is_dir() else _PACKAGE.parents[1] / name
