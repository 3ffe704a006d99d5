"""What a path is asked to keep beyond its bounds, for ground that is not as drawn."""

from __future__ import annotations

from typing import NamedTuple

from stairwright import _core
from stairwright.planning.lattice.body_lattice import Bounds

IN_SEARCH = 0.6  # share that lattice poses keep; the smoothing finds the rest


class ExtraMargins(NamedTuple):
    """More of each margin than a path must have: clearances and reach [m], joint ranges [rad]."""

    trunk: float = 0.0
    links: float = 0.0
    legs: float = 0.0
    reach: float = 0.0
    joints: float = 0.0

    @property
    def native(self) -> _core.ExtraMargins:
        """The same for the smoothing."""
        return _core.ExtraMargins(*self)

    def within(self, bounds: Bounds, share: float) -> Bounds:
        """Bounds of lattice poses that leave a share of it."""
        if self == NO_EXTRA:
            return bounds
        trunk, links, legs, reach, joints = (share * value for value in self)
        return bounds._replace(
            trunk=bounds.trunk + trunk,
            links=bounds.links + links,
            legs=bounds.legs + legs,
            reach=bounds.reach + reach,
            thigh=bounds.thigh + joints,
        )


NO_EXTRA = ExtraMargins()
