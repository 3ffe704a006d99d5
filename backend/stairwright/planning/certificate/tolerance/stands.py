"""On what a robot stands at the samples of a motion, and how far that may be off.

The trunk keeps its pitch and follows the ground under the wheels by the load they carry; the legs
reach for the ground (native/src/control/leg_fit.cpp).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from stairwright.arrays import Flags, Floats, Ints
from stairwright.planning.certificate.equilibrium import WHEEL_GAP
from stairwright.planning.certificate.motion import Samples
from stairwright.planning.certificate.tolerance.balance import Contacts, load_shares
from stairwright.planning.certificate.tolerance.ground import (
    STEPS,
    Footing,
    Geometry,
    VariedGround,
    groups,
)
from stairwright.planning.certificate.tolerance.legs import VariedLeg
from stairwright.planning.tolerance import Tolerance

SecondFaces = Callable[[Samples], Floats]
# Of what is off in x and z, from -1 to 1, and of the range of the load's shares, from 0 to 1.
Part = tuple[tuple[float, float], tuple[float, float], tuple[float, float]]

WHOLE: Part = ((-1.0, 1.0), (-1.0, 1.0), (0.0, 1.0))
_BACK = 5e-4  # m that interpolated wheels may stray


class Stands:
    """Samples (n) of a motion on ground that may be off.

    Attributes:
        second: (n, 2) how near a second face must be to a wheel for balance to lean on it [m].
        ground: What may be off.
    """

    def __init__(self, samples: Samples, tolerance: Tolerance, second: SecondFaces) -> None:
        motion = samples.motion
        self.samples, self.robot = samples, motion.robot
        self.second = second(samples)
        self.ground = VariedGround(motion.vertices, tolerance.place, tolerance.height)

    @cached_property
    def touched(self) -> list[Flags]:
        """Which segments front and rear wheels (n, m - 1) touch."""
        wheels = self.samples.frames.wheels
        return [self.ground.touched(wheels[:, pair], self.second[:, pair]) for pair in range(2)]

    @cached_property
    def stands(self) -> list[tuple[Ints, Footing, Footing]]:
        """Samples whose wheels touch the same segments, and what front and rear ones go by."""
        return [
            (index, self._footing(0, index[0]), self._footing(1, index[0]))
            for index in groups(*self.touched, *self.ahead)
        ]

    def _footing(self, pair: int, sample: int) -> Footing:
        ahead = int(np.argmax(self.ahead[pair][sample]))
        return self.ground.footing(self.touched[pair][sample], ahead, self.back[pair])

    @cached_property
    def ahead(self) -> list[Flags]:
        """How far front and rear wheels are from the face ahead: flags (n, steps + 1)."""
        out = []
        for pair, touched in enumerate(self.touched):
            centres = self.samples.frames.wheels[:, pair]
            steps = self.ground.ahead(centres, touched, self.robot.wheel.radius)
            out.append(steps[:, None] == np.arange(STEPS + 1))
        return out

    @cached_property
    def back(self) -> list[bool]:
        """Whether front and rear wheels ever roll back."""
        steps = np.diff(self.samples.frames.wheels[..., 0], axis=0)
        return [bool(np.any(steps[:, pair] < -_BACK)) for pair in range(2)]

    @cached_property
    def apart(self) -> Floats:
        """(n, 2) how far front and rear wheels may stand otherwise to each other than drawn [m]."""
        off = np.zeros((len(self.samples.slack), 2))
        for index, front, rear in self.stands:
            off[index] = self.ground.apart(front, rear)
        return off

    def contacts(self, friction: float) -> Contacts:
        motion = self.samples.motion
        return Contacts.of(
            motion.vertices, self.samples.frames.wheels, self.samples.com[:, 0],
            self.robot.wheel.radius + WHEEL_GAP, self.second, friction,
        )  # fmt: skip

    @cached_property
    def shares(self) -> Floats:
        """(n, 2) least and largest share of the load on the front wheels."""
        return load_shares(self.contacts(self.samples.motion.friction))

    def legs(self, index: Ints, part: Part = WHOLE) -> list[VariedLeg]:
        """Front and rear leg at samples (k,): each takes the part of what is off that its load does
        not. Of how wheels stand to each other, and of the load, a `part` counts.
        """
        (x0, x1), (z0, z1), (s0, s1) = part
        apart, share = self.apart[index], self.shares[index]
        low, high = apart * (x0, z0), apart * (x1, z1)
        wide = share[:, 1] - share[:, 0]
        least, most = share[:, :1] + s0 * wide[:, None], share[:, :1] + s1 * wide[:, None]
        weights = ((1.0 - most, 1.0 - least), (-most, -least))
        out = []
        for pair, ends in enumerate(weights):
            corners = np.stack([weight * end for weight in ends for end in (low, high)])
            out.append(
                VariedLeg(self.samples, index, pair, corners.min(axis=0), corners.max(axis=0))
            )
        return out

    @cached_property
    def of_trunk(self) -> list[tuple[Ints, Geometry]]:
        """Groups of samples, and the ground as the trunk may see it there."""
        out = []
        for index, *footings in self.stands:
            # Against the ground the trunk is off by what the wheels are, by the load they carry.
            of_front, of_rear = (self.ground.off(footing) for footing in footings)
            low, high = self.shares[index, 0].min(), self.shares[index, 1].max()
            ends = [w * of_front + (1.0 - w) * of_rear for w in (low, high)]
            off = np.stack([np.minimum(*ends)[0], np.maximum(*ends)[1]])
            out.append((index, self._ground(off, index)))
        return out

    @cached_property
    def of_wheel(self) -> list[list[tuple[Ints, Geometry]]]:
        """The same for front and rear wheels."""
        out = []
        for pair, touched in enumerate(self.touched):
            seen = []
            for index in groups(touched, self.ahead[pair]):
                footing = self._footing(pair, index[0])
                seen.append((index, self._ground(self.ground.off(footing), index, footing.touched)))
            out.append(seen)
        return out

    def _ground(self, off: Floats, samples: Ints, touched: Flags | None = None) -> Geometry:
        """All places of the ground that the robot may meet at some samples."""
        x, reach = self.samples.motion.body[samples, 0], self.robot.body.span
        reach += 2 * max(leg.reach for leg in self.robot.legs)
        return self.ground.where(off, x.min() - reach, x.max() + reach, touched)
