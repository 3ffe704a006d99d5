"""Whether contact forces hold the robot wherever within the tolerance its wheels stand.

The front wheels stand by r = (r_x, r_z) otherwise to the rear ones than drawn. The trunk follows
the ground by the share w of the load that the front wheels carry, so the contacts move by (1 - w) r
and -w r against it. Forces f in the cones of the contacts as drawn stay in them (faces keep their
slopes) and change their moment about the mass centre by r_x (phi - w) - r_z h: phi is the share of
the weight that f puts on the front wheels, h the force along x there. Two such forces, one with a
moment above zero for all r and one below, have a mixture that balances, for every r.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from stairwright.arrays import Flags, Floats, Ints
from stairwright.planning.certificate.equilibrium import MOST_FACES, STRONGEST, touching

_SMALL = 1e-12


@dataclass(frozen=True)
class Contacts:
    """Edges of the friction cones at samples (n); forces in weights, moments about the mass centre.

    Attributes:
        rays: (n, m, 3) force x, force z, moment [m]; zero where there is no contact.
        points: (n, m, 2) where they push [m].
        front: (m,) which are of the front wheels.
    """

    rays: Floats
    points: Floats
    front: Flags

    @classmethod
    def of(
        cls, vertices: Floats, wheels: Floats, com: Floats, reach: float, further: Floats,
        friction: float,
    ) -> Contacts:  # fmt: skip
        """Of wheels (n, 2, 2) that touch a profile; see `equilibrium.balanced`."""
        n = len(wheels)
        points, normals, found = touching(vertices, wheels.reshape(-1, 2), reach, further.ravel())
        points, normals = (
            points.reshape(n, 2 * MOST_FACES, 2),
            normals.reshape(n, 2 * MOST_FACES, 2),
        )
        normals = normals * found.reshape(n, 2 * MOST_FACES, 1)
        arms = points - np.stack([com, np.zeros(n)], axis=1)[:, None]
        rays = []
        for side in (friction, -friction):
            fx = normals[..., 0] + side * normals[..., 1]
            fz = normals[..., 1] - side * normals[..., 0]
            rays.append(np.stack([fx, fz, arms[..., 0] * fz - arms[..., 1] * fx], axis=2))
        front = np.tile(np.arange(2 * MOST_FACES) < MOST_FACES, 2)
        return cls(np.concatenate(rays, axis=1), np.concatenate([points] * 2, axis=1), front)


def load_shares(contacts: Contacts) -> Floats:
    """Least and largest share (n, 2) of the weight on the front wheels in equilibrium as drawn.

    The extremes of a linear function over all forces that balance are among those of three rays;
    0 and 1 where none do.
    """
    x, z, moment = np.moveaxis(contacts.rays, 2, 0)
    n, m = x.shape
    low, high = np.full(n, np.inf), np.full(n, -np.inf)
    for triple in combinations(range(m), 3):
        u, v, w = triple
        minors = np.stack(
            [x[:, b] * moment[:, a] - x[:, a] * moment[:, b] for a, b in ((v, w), (w, u), (u, v))]
        )
        up = z[:, triple].T
        with np.errstate(divide="ignore", invalid="ignore"):
            factors = minors / np.sum(minors * up, axis=0)
        ok = np.all((factors >= -1e-7) & (factors <= STRONGEST), axis=0)
        share = np.sum(np.where(ok, factors, 0.0) * up * contacts.front[list(triple), None], axis=0)
        low = np.where(ok, np.minimum(low, share), low)
        high = np.where(ok, np.maximum(high, share), high)
    none = low > high
    low[none], high[none] = 0.0, 1.0
    shares: Floats = np.clip(np.stack([low, high], axis=1), 0.0, 1.0)
    return shares


@dataclass(frozen=True)
class Pushes:
    """Forces that carry the weight and no more, along two rays each: (n, k) of them.

    Attributes:
        pairs: (k, 2) which rays.
        factors: (n, k, 2) of the rays; NaN where they cannot carry it.
        moment: About the mass centre [m].
        front: Share of the weight on the front wheels.
        along: Force on the front wheels along x.
    """

    pairs: Ints
    factors: Floats
    moment: Floats
    front: Floats
    along: Floats

    @classmethod
    def of(cls, contacts: Contacts) -> Pushes:
        """All of them."""
        rays, of_front = contacts.rays, contacts.front
        pairs = np.array(list(combinations(range(rays.shape[1]), 2)))
        a, b = rays[:, pairs[:, 0]], rays[:, pairs[:, 1]]
        det = a[..., 0] * b[..., 1] - b[..., 0] * a[..., 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            factors = np.stack([-b[..., 0] / det, a[..., 0] / det], axis=2)
        ok = (np.abs(det) > _SMALL) & np.all((factors >= -1e-9) & (factors <= STRONGEST), axis=2)
        factors = np.where(ok[..., None], factors, np.nan)
        in_front = of_front[pairs] * factors
        moment = factors[..., 0] * a[..., 2] + factors[..., 1] * b[..., 2]
        front = in_front[..., 0] * a[..., 1] + in_front[..., 1] * b[..., 1]
        along = in_front[..., 0] * a[..., 0] + in_front[..., 1] * b[..., 0]
        return cls(pairs, factors, moment, front, along)

    def lost(self, off: Floats, shares: Floats, com: Floats) -> Floats:
        """The most (n, k) by which moments change [m].

        Args:
            off: (n, 2) how far the wheels may stand otherwise to each other in x and z [m].
            shares: (n, 2) least and largest share of the load on the front wheels.
            com: (n,) how far the mass centre may move along x against the trunk [m].
        """
        uneven = np.max(np.abs(self.front[..., None] - shares[:, None]), axis=2)
        lost: Floats = off[:, :1] * uneven + off[:, 1:] * np.abs(self.along) + com[:, None]
        return lost

    def forces(self, rays: Floats, choice: Ints) -> Floats:
        """Forces (n, m, 2) along every ray of one choice (n,) for each sample, in weights."""
        rows = np.arange(len(rays))
        out = np.zeros((*rays.shape[:2], 2))
        for side in range(2):
            ray = self.pairs[choice, side]
            out[rows, ray] += self.factors[rows, choice, side, None] * rays[rows, ray, :2]
        return out
