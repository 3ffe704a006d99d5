"""Profiles from tables: two columns, x and z in metres."""

from __future__ import annotations

import math
import re

from stairwright.documents import parse
from stairwright.errors import InputError

from .profile import MOST_COORDINATE, Terrain

Point = tuple[float, float]
MAX_ROWS = 100_000


def parse_table(text: str, name: str = "imported", friction: float = 0.6) -> Terrain:
    """A terrain from lines of ``x, z``: comma, semicolon, tab or blank between the columns.

    Empty lines and lines that start with ``#`` are left out, and so is one header line. Decimal
    commas are read where the columns are separated by something else.

    Raises:
        InputError: For a line that does not hold two numbers, lies behind the one before it or
            too far away (with its number), or for too many lines.
    """
    points: list[tuple[float, float]] = []
    lines: list[int] = []  # of the points
    seen_header = False
    for number, line in enumerate(text.removeprefix("\ufeff").splitlines(), start=1):
        row = line.strip()
        if not row or row.startswith("#"):
            continue
        if len(points) >= MAX_ROWS:
            raise InputError(f"the table has more than {MAX_ROWS} rows", ("file",))
        pair = _numbers(row)
        if pair is not None:
            _check(pair, number, points, lines)
            points.append(pair)
            lines.append(number)
        elif not points and not seen_header:
            seen_header = True
        else:
            raise InputError(
                f"line {number} must hold two numbers, x and z in m, but is: {row[:60]!r}",
                ("file",),
            )
    if len(points) < 2:
        raise InputError("the table must hold at least two rows of x and z", ("file",))
    return parse(Terrain, {"name": name, "points": points, "friction": friction})


def _check(pair: Point, number: int, points: list[Point], lines: list[int]) -> None:
    """Refuse what no terrain can hold in the words of the table: by its lines."""
    if max(map(abs, pair)) > MOST_COORDINATE:
        raise InputError(
            f"line {number}: x and z must lie within {MOST_COORDINATE:g} m, but are "
            f"{pair[0]:g} and {pair[1]:g}",
            ("file",),
        )
    if points and pair[0] < points[-1][0]:
        raise InputError(
            f"line {number}: x must never decrease, but {pair[0]:g} lies behind "
            f"{points[-1][0]:g} in line {lines[-1]}: overhangs are not supported",
            ("file",),
        )


def _numbers(row: str) -> tuple[float, float] | None:
    for separator in (r"\s*;\s*", r"\s*\t\s*", r"\s*,\s*", r"\s+"):
        cells = re.split(separator, row.strip())
        if len(cells) != 2:
            continue
        try:
            x, z = (float(cell.strip().strip('"').replace(",", ".")) for cell in cells)
        except ValueError:
            continue
        if math.isfinite(x) and math.isfinite(z):
            return x, z
    return None
