"""The lattice's sizes, what its poses keep, and what a search on it finds."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Robot

from .legs import LEGS_GAP, make_legs
from .tables import Bounds, Lattice

Floats = NDArray[np.float64]

_WORD = 64  # columns of a row's bitset
_PITCHES = 1.9  # rad; largest pitch searched: the trunk may lean back past vertical

# What lattice poses keep: a little more than the final bounds (strict); as much less as rounding to
# the lattice may take from a pose that is really possible (bold: the polish must repair it); or so
# much less that a search without success settles the matter (hope; the polish repairs many of its
# finds, and sooner than a finer lattice would spare it the work); or what lies between (keen).
# Where bare bounds of lattice poses (plain) leave a way, 19 of 20 become plans.
STRICT = Bounds(trunk=0.006, links=0.006, legs=LEGS_GAP, reach=0.003, thigh=0.0, com=0.005)
PLAIN = Bounds(trunk=0.0, links=0.0, legs=0.0, reach=0.0, thigh=0.0, com=0.0)
BOLD = Bounds(trunk=-0.003, links=-0.003, legs=-0.003, reach=0.0, thigh=-0.02, com=-0.01)
KEEN = Bounds(trunk=-0.006, links=-0.006, legs=-0.006, reach=-0.003, thigh=-0.04, com=-0.015)
HOPE = Bounds(trunk=-0.009, links=-0.009, legs=-0.009, reach=-0.006, thigh=-0.06, com=-0.02)


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


def make_lattice(robot: Robot, fine: float = 1.0) -> Lattice:
    """A lattice for legs of this size; `fine` < 1 refines it."""
    legs = make_legs(robot.planar)
    reach = max(leg.reach_max for leg in legs)
    step = reach / 12.1 * fine
    turn = 0.12 * fine
    half = math.ceil(reach / (0.5 * step))
    row = 8 * math.ceil((2 * round(13 / fine) + 6) / 8)
    assert row <= _WORD, "a row of the lattice must fit into a word"
    return Lattice(
        step=step,
        turn=turn,
        pitches=2 * int(_PITCHES / turn) + 1,
        nt=2 * round(8 / fine) + 1,
        nz=round(17 / fine),
        nx=2 * round(13 / fine),
        row=row,
        low=-round(3 / fine),
        half=half,
    )
