"""The lattice's sizes, what its poses keep, and what a search on it finds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.robot.description import Robot

_WORD = 64  # columns of a row's bitset
_PITCHES = 1.9  # rad; largest pitch searched: the trunk may lean back past vertical


class Lattice(NamedTuple):
    """The body lattice: x = i * step, z = j * step, pitch = (t - pitches // 2) * turn."""

    step: float  # m
    turn: float  # rad
    pitches: int  # of the whole table
    nt: int  # pitches of one cell's window
    nz: int  # rows of one cell's window
    nx: int  # columns of one cell's window
    row: int  # columns stored per row: the window, its rim, and room for shifts
    low: int  # first row of a window, relative to the mean wheel height
    half: int  # the hip grid spans -half..half of step / 2 round the wheel

    @property
    def native(self) -> _core.Lattice:
        """The same for the native core."""
        return _core.Lattice(
            self.step, self.turn, self.pitches, self.nt, self.nz, self.nx, self.row
        )

    @property
    def windows(self) -> _core.WindowShape:
        """How windows lie round pairs of wheels."""
        return _core.WindowShape(self.native, self.low)


class Bounds(NamedTuple):
    """Bounds that every lattice pose keeps. The obstruction search relaxes one at a time."""

    trunk: float  # least clearance of the trunk [m]
    links: float  # least clearance of the links [m]
    legs: float  # least gap between front and rear leg [m]
    reach: float  # slack of the hip-wheel distance; negative widens the calf's range [m]
    thigh: float  # slack of the thigh joints; negative widens their range [rad]
    com: float  # least CoM margin [m]
    torque: float  # largest static torque, as a share of the motors'; where the search looks at it

    @property
    def tolerances(self) -> _core.Tolerances:
        """What tables need of it."""
        return _core.Tolerances(self.trunk, self.links, self.reach, self.thigh)


# What lattice poses keep: a little more than the final bounds (strict); as much less as rounding to
# the lattice may take from a pose that is really possible (loose: smoothing must repair it); or so
# much less that a search without success settles the matter (loosest; smoothing repairs many of its
# finds, and sooner than a finer lattice would spare it the work); or what lies between (looser).
STRICT = Bounds(
    trunk=0.006, links=0.006, legs=_core.LEGS_GAP, reach=0.003, thigh=0.0, com=0.005, torque=0.95
)
LOOSE = Bounds(
    trunk=-0.003, links=-0.003, legs=-0.003, reach=0.0, thigh=-0.02, com=-0.01, torque=1.1
)
LOOSER = Bounds(
    trunk=-0.006, links=-0.006, legs=-0.006, reach=-0.003, thigh=-0.04, com=-0.015, torque=1.2
)
LOOSEST = Bounds(
    trunk=-0.009, links=-0.009, legs=-0.009, reach=-0.006, thigh=-0.06, com=-0.02, torque=1.3
)


@dataclass(frozen=True)
class LatticePath:
    """What the search found.

    Attributes:
        s: (n, 2) arc lengths of front and rear wheel; None if there is no path.
        body: (n, 3) trunk poses.
        quality: Least quality on the widest path (0 without one).
        reached: (2,) arc lengths of the pair farthest along that was reached, None if none was.
        back: Whether wheels had to roll back.
    """

    s: Floats | None
    body: Floats | None
    quality: int
    reached: tuple[float, float] | None
    back: bool = False

    @property
    def leads_on(self) -> bool:
        """Whether there is a path; one that begins where it is to end is none."""
        return self.s is not None and len(self.s) > 1


def make_lattice(robot: Robot, fine: float = 1.0) -> Lattice:
    """A lattice for legs of this size; `fine` < 1 refines it."""
    reach = max(most for _, most in _core.RobotModel(robot.native).reach)
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
