"""The lattice's sizes, and what a search on it finds."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Robot

from .legs import make_legs
from .tables import Lattice

Floats = NDArray[np.float64]

LAG = 0.02  # m; how late a wheel may arrive at a corner


@dataclass(frozen=True)
class Finding:
    """What the search found.

    Attributes:
        s: (n, 2) arc lengths of front and rear wheel; None if there is no way.
        body: (n, 3) trunk poses.
        quality: Least quality on the widest way (0 without one).
        reached: (2,) arc lengths of the pair farthest along that was reached, None if none was.
        back: Whether wheels had to roll back.
    """

    s: Floats | None
    body: Floats | None
    quality: int
    reached: tuple[float, float] | None
    back: bool = False


def make_lattice(robot: Robot, pitches: float, fine: float = 1.0) -> Lattice:
    """A lattice for legs of this size; `fine` < 1 refines it, `pitches` is the largest pitch."""
    legs = make_legs(robot.planar)
    reach = max(leg.reach_max for leg in legs)
    step = reach / 12.1 * fine
    turn = 0.12 * fine
    half = math.ceil(reach / (0.5 * step))
    return Lattice(
        step=step,
        turn=turn,
        pitches=2 * int(pitches / turn) + 1,
        nt=2 * round(8 / fine) + 1,
        nz=round(17 / fine),
        nx=2 * round(13 / fine),
        row=8 * math.ceil((2 * round(13 / fine) + 6) / 8),
        low=-round(3 / fine),
        half=half,
    )
