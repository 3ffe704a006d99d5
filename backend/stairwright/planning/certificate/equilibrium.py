"""Static equilibrium for the certificate: which faces wheels touch, and whether they can hold it.

Written for the certificate alone, as array operations over all samples; the planner's statics
(`stairwright.statics`) are another method.
"""

from __future__ import annotations

from functools import cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

WHEEL_GAP = 0.002  # m; a wheel this near to the ground touches it
TOUCH = 1.01e-4  # m; a second face no farther from a wheel is touched truly, not just nearly
STRONGEST = 8.0  # robot weights; larger contact forces are not taken as equilibrium
_FACES = 3  # most faces that one wheel touches
_ALIKE = 0.9999  # cosine between normals of what counts as one face
_BLOCK = 20_000  # segments times samples handled at once


def balanced(
    vertices: Floats, wheels: Floats, com: Floats, reach: float, friction: float, further: Floats
) -> Flags:
    """Whether forces inside the friction cones of all touching faces balance the weight.

    Args:
        vertices: (m, 2) profile [m].
        wheels: (n, 2, 2) wheel centres, front and rear [m].
        com: (n,) x of the centre of mass [m].
        reach: The nearest face within this distance of a wheel's centre is touched [m].
        friction: Coulomb friction.
        further: (n, 2) any other face within this distance is touched too [m].

    Returns:
        (n,) flags.
    """
    n = len(wheels)
    points, normals, found = touching(vertices, wheels.reshape(-1, 2), reach, further.ravel())
    # Moments are taken about the CoM: what is asked for is then (0, 1, 0) everywhere.
    points = points.reshape(n, 2 * _FACES, 2) - np.stack([com, np.zeros(n)], axis=1)[:, None]
    normals, found = normals.reshape(n, 2 * _FACES, 2), found.reshape(n, 2 * _FACES)
    out = np.zeros(n, bool)
    counts = found.sum(axis=1)
    order = np.argsort(~found, axis=1, kind="stable")
    for count in np.unique(counts):
        index = np.flatnonzero(counts == count)
        kept = index[:, None], order[index, :count]
        out[index] = in_cone(_rays(points[kept], normals[kept], friction))
    return out


def touching(
    vertices: Floats, centres: Floats, reach: float, further: Floats
) -> tuple[Floats, Floats, Flags]:
    """Where wheels at `centres` (n, 2) touch the profile, one contact per face, nearest first.

    The nearest face counts within `reach` of the centre, any other within `further` (n,) [m].

    Returns:
        (n, 3, 2) points, (n, 3, 2) unit normals towards the centre, (n, 3) whether there is one.
    """
    n, x = len(centres), vertices[:, 0]
    points, normals = np.zeros((n, _FACES, 2)), np.zeros((n, _FACES, 2))
    found = np.zeros((n, _FACES), bool)
    first = np.maximum(np.searchsorted(x, centres[:, 0] - reach, side="left") - 1, 0)
    last = np.minimum(np.searchsorted(x, centres[:, 0] + reach, side="right") + 1, len(x) - 1)
    begin = 0
    while begin < n:
        widest = np.maximum.accumulate(np.maximum((last - first)[begin:], 1))
        fits = np.searchsorted(widest * np.arange(1, len(widest) + 1), _BLOCK, side="right")
        part = slice(begin, begin + max(1, int(fits)))
        points[part], normals[part], found[part] = _nearest_faces(
            vertices, centres[part], first[part], last[part], reach, further[part]
        )
        begin = part.stop
    return points, normals, found


def _nearest_faces(
    vertices: Floats, centres: Floats, first: NDArray[np.int64], last: NDArray[np.int64],
    reach: float, further: Floats,
) -> tuple[Floats, Floats, Flags]:  # fmt: skip
    """`touching` for samples whose segments `first` to `last` (excluded) may be near."""
    n = len(centres)
    k = first[:, None] + np.arange(max(1, int((last - first).max())))
    inside = k < last[:, None]
    k = np.minimum(k, len(vertices) - 2)
    p, d = vertices[k], vertices[k + 1] - vertices[k]
    t = ((centres[:, None] - p) * d).sum(axis=2) / (d * d).sum(axis=2)
    near = p + np.clip(t, 0.0, 1.0)[..., None] * d
    away = centres[:, None] - near
    distance = np.hypot(away[..., 0], away[..., 1])
    distance = np.where(inside & (distance >= 1e-9), distance, np.inf)
    away /= np.where(np.isfinite(distance), distance, 1.0)[..., None]
    points, normals = np.zeros((n, _FACES, 2)), np.zeros((n, _FACES, 2))
    found, rows = np.zeros((n, _FACES), bool), np.arange(n)
    for face in range(_FACES):
        nearest = np.argmin(distance, axis=1)
        touches = distance[rows, nearest] <= (further if face else reach)
        if not touches.any():
            break
        found[:, face] = touches
        points[:, face], normals[:, face] = near[rows, nearest], away[rows, nearest]
        alike = np.einsum("nkc,nc->nk", away, normals[:, face]) >= _ALIKE
        distance[alike] = np.inf
    return points, normals, found


def _rays(points: Floats, normals: Floats, friction: float) -> Floats:
    """Edges (n, 2 m, 3) of the friction cones of contacts (n, m, 2): force x, force z, moment."""
    rays = []
    for side in (friction, -friction):
        fx = normals[..., 0] + side * normals[..., 1]
        fz = normals[..., 1] - side * normals[..., 0]
        rays.append(np.stack([fx, fz, points[..., 0] * fz - points[..., 1] * fx], axis=2))
    return np.concatenate(rays, axis=1)


@cache
def _triples(count: int) -> NDArray[np.int64]:
    """All choices (3, k) of three of `count`."""
    return np.array(list(combinations(range(count), 3)), int).reshape(-1, 3).T


def in_cone(rays: Floats) -> Flags:
    """Whether (0, 1, 0) is a sum of `rays` (n, m, 3) with factors between 0 and `STRONGEST`.

    By Caratheodory's theorem three rays are enough: every triple is solved by Cramer's rule. For
    this right-hand side the factors are minors of force x and moment over the determinant.
    """
    n, m = rays.shape[:2]
    triples = _triples(m)
    if not triples.size:
        return np.zeros(n, bool)
    x, z, moment = np.moveaxis(rays, 2, 0)

    def minor(a: NDArray[np.int64], b: NDArray[np.int64]) -> Floats:
        product: Floats = x[:, b] * moment[:, a] - x[:, a] * moment[:, b]
        return product

    u, v, w = triples
    minors = np.stack([minor(v, w), minor(w, u), minor(u, v)])
    det = np.sum(minors * np.stack([z[:, u], z[:, v], z[:, w]]), axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        factors = minors / det
    fits = np.all((factors >= -1e-7) & (factors <= STRONGEST), axis=0) & (np.abs(det) > 1e-12)
    balanced_somehow: Flags = fits.any(axis=1)
    return balanced_somehow
