"""The trunk: all that does not move against it, seen from the side."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError

from .frame import Frame
from .links import possible
from .lump import lump
from .outline import area, covers, outer
from .pair import tidy
from .report import Notes, listed
from .shapes import solids
from .source import Source

_MOST_PIECES = 32
_THINNEST = 0.01  # m; of a box that is guessed


def trunk_document(
    source: Source, frame: Frame, bodies: list[int], centre: Floats, notes: Notes
) -> dict[str, Any]:
    """The trunk of a robot's document.

    Args:
        source: The model, its abduction joints where they are held.
        frame: Our axes.
        bodies: The trunk's, and those between abduction and thigh.
        centre: (3,) the trunk point in our frame [m].
        notes: For remarks.

    Raises:
        InputError: If it weighs nothing.
    """
    whole = lump(source, frame, bodies)
    if whole.mass < 1e-6:
        raise InputError(f"{source.body(bodies[0])!r}: the trunk weighs nothing", ("file",))
    products = np.abs(whole.inertia[np.triu_indices(3, 1)]).max()
    if products > 0.05 * np.diag(whole.inertia).max():
        notes.assume(
            f"the trunk's products of inertia (up to {products:.3g} kg m^2) are left out: the "
            "model's axes are the principal ones",
            "trunk.inertia",
        )
    com = whole.com - centre
    inertia = possible(np.diag(whole.inertia).tolist())
    pieces = _pieces(source, frame, bodies, centre, notes)
    if not pieces:
        pieces = [_guessed(whole.mass, inertia, com, source.body(bodies[0]), source, notes)]
    polygon, width = pieces[0]
    length, height = np.ptp(polygon, axis=0).tolist()
    return {
        "size": (length, width, height),
        "mass": whole.mass,
        "inertia": inertia,
        "com": tuple(tidy(value) for value in com),
        "outline": [
            {"points": [(tidy(x), tidy(z)) for x, z in points], "width": across}
            for points, across in pieces
        ],
    }


def _pieces(
    source: Source, frame: Frame, bodies: list[int], centre: Floats, notes: Notes
) -> list[tuple[Floats, float]]:
    """Outlines and widths, the largest first; none lies inside another."""
    shapes = solids(source, frame, bodies)
    unseen = [source.body(body) for body in bodies if source.unseen.get(body)]
    if not shapes and not unseen:
        shapes = solids(source, frame, bodies, shown=True)
        if shapes:
            notes.warn("nothing of the trunk collides; what it shows is taken")
    elif unseen and shapes:
        notes.warn(f"{listed(unseen)}: the trunk lacks the shape of a mesh that was not sent")
    found = []
    for shape in shapes:
        cloud = shape.cloud - centre
        found.append((outer(cloud[:, [0, 2]]), 2 * float(np.abs(cloud[:, 1]).max())))
    found.sort(key=lambda piece: -area(piece[0]))
    kept: list[tuple[Floats, float]] = []
    for polygon, width in found:
        holder = next((k for k, (other, _) in enumerate(kept) if covers(other, polygon)), None)
        if holder is None:
            kept.append((polygon, width))
    if len(kept) > _MOST_PIECES:
        rest = np.concatenate([polygon for polygon, _ in kept[_MOST_PIECES - 1 :]])
        width = max(width for _, width in kept[_MOST_PIECES - 1 :])
        notes.warn(
            f"the trunk has {len(kept)} shapes; the hull of the {len(kept) - _MOST_PIECES + 1} "
            "smallest is one of its pieces"
        )
        kept = [*kept[: _MOST_PIECES - 1], (outer(rest), width)]
    return kept


def _guessed(
    mass: float, inertia: tuple[float, float, float], com: Floats, name: str, source: Source,
    notes: Notes,
) -> tuple[Floats, float]:  # fmt: skip
    """The box of even mass that has these moments."""
    half = sum(inertia) / 2
    size = [max(_THINNEST, math.sqrt(max(0.0, 12 * (half - own) / mass))) for own in inertia]
    shown = " x ".join(f"{value:.3g}" for value in size)
    why = "its collision mesh was not sent" if source.unseen else "it has no collision shape"
    text = f"{name!r}: {why}; a box of {shown} m taken, which has its moments of inertia"
    notes.assume(text, "trunk.size", "trunk.outline")
    x, z = size[0] / 2, size[2] / 2
    corners = np.array([(-x, -z), (x, -z), (x, z), (-x, z)])
    return corners + com[[0, 2]], size[1]
