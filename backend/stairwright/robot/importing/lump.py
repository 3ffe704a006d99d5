"""Bodies that move together as one: mass, mass centre and inertia."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats

from .frame import Frame
from .source import Source


@dataclass(frozen=True)
class Lump:
    """Rigid bodies as one.

    Attributes:
        mass: [kg]
        com: (3,) in our frame [m].
        inertia: (3, 3) about `com` in our axes [kg m^2].
    """

    mass: float
    com: Floats
    inertia: Floats


def lump(source: Source, frame: Frame, bodies: Sequence[int]) -> Lump:
    """All of `bodies`, where they stand now."""
    model, data = source.model, source.data
    masses = model.body_mass[list(bodies)]
    total = float(masses.sum())
    places = frame.place(data.xipos[list(bodies)]).reshape(-1, 3)
    com = masses @ places / total if total > 0 else np.zeros(3)
    inertia = np.zeros((3, 3))
    for body, mass, place in zip(bodies, masses, places, strict=True):
        axes = frame.axes @ data.ximat[body].reshape(3, 3)
        off = place - com
        inertia += axes @ np.diag(model.body_inertia[body]) @ axes.T
        inertia += mass * (off @ off * np.eye(3) - np.outer(off, off))
    return Lump(total, com, inertia)
