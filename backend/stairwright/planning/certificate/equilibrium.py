"""Static equilibrium for the certificate: which faces wheels touch, and whether they can hold it.

Written for the certificate alone, as array operations over all samples; the planner's statics
(`stairwright.statics`) are another method.
"""

from __future__ import annotations

from dataclasses import dataclass
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


@dataclass(frozen=True)
class NearFaces:
    """Where wheels (n,) are near to the profile: up to three points, one a face, nearest first.

    Attributes:
        points: (n, 3, 2) of the profile [m].
        normals: (n, 3, 2) from there towards the wheel's centre.
        distances: (n, 3) of the centre; infinite where there is no such face [m].
    """

    points: Floats
    normals: Floats
    distances: Floats

    def touched(self, reach: float, further: Floats) -> Flags:
        """Whether faces (n, 3) are touched.

        The nearest face counts within `reach` of the centre, any other within `further` (n,) [m].
        """
        most = np.repeat(further[:, None], _FACES, axis=1)
        most[:, 0] = reach
        return self.distances <= most


def balanced(near: NearFaces, touched: Flags, com: Floats, friction: float) -> Flags:
    """Whether forces inside the friction cones of all touching faces balance the weight.

    Args:
        near: Faces near to the front and the rear wheel of each of n samples in turn (2 n,).
        touched: (2 n, 3) which of them wheels touch.
        com: (n,) x of the centre of mass [m].
        friction: Coulomb friction.

    Returns:
        (n,) flags.
    """
    n = len(com)
    # Moments are taken about the CoM: what is asked for is then (0, 1, 0) everywhere.
    points = near.points.reshape(n, 2 * _FACES, 2).copy()
    points[..., 0] -= com[:, None]
    normals, found = near.normals.reshape(n, 2 * _FACES, 2), touched.reshape(n, 2 * _FACES)
    out = np.zeros(n, bool)
    counts = found.sum(axis=1)
    for count in np.unique(counts):
        index = np.flatnonzero(counts == count)
        kept = index[:, None], np.nonzero(found[index])[1].reshape(len(index), count)
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
    near = near_faces(vertices, centres, max(reach, float(further.max(initial=0.0))))
    return near.points, near.normals, near.touched(reach, further)


def near_faces(vertices: Floats, centres: Floats, sight: float) -> NearFaces:
    """The faces of the profile (m, 2) within `sight` of wheels at `centres` (n, 2) [m]."""
    n, x = len(centres), vertices[:, 0]
    points, normals = np.zeros((n, _FACES, 2)), np.zeros((n, _FACES, 2))
    distances = np.full((n, _FACES), np.inf)
    first = np.maximum(np.searchsorted(x, centres[:, 0] - sight, side="left") - 1, 0)
    last = np.minimum(np.searchsorted(x, centres[:, 0] + sight, side="right") + 1, len(x) - 1)
    begin = 0
    while begin < n:
        widest = np.maximum.accumulate(np.maximum((last - first)[begin:], 1))
        fits = np.searchsorted(widest * np.arange(1, len(widest) + 1), _BLOCK, side="right")
        part = slice(begin, begin + max(1, int(fits)))
        points[part], normals[part], distances[part] = _nearest_faces(
            vertices, centres[part], first[part], last[part], sight
        )
        begin = part.stop
    return NearFaces(points, normals, distances)


def _nearest_faces(
    vertices: Floats, centres: Floats, first: NDArray[np.int64], last: NDArray[np.int64],
    sight: float,
) -> tuple[Floats, Floats, Floats]:  # fmt: skip
    """`near_faces` for wheels whose segments `first` to `last` (excluded) may be near."""
    n = len(centres)
    k = first[:, None] + np.arange(max(1, int((last - first).max())))
    outside = k >= last[:, None]
    k = np.minimum(k, len(vertices) - 2)
    # By coordinate, which numpy is quicker with than with rows of two.
    (x, z), (dx, dz) = vertices.T, np.diff(vertices, axis=0).T
    px, pz, dx, dz, square = x[k], z[k], dx[k], dz[k], (dx * dx + dz * dz)[k]
    cx, cz = centres[:, 0, None], centres[:, 1, None]
    t = np.clip(((cx - px) * dx + (cz - pz) * dz) / square, 0.0, 1.0)
    px += t * dx
    pz += t * dz
    ax, az = cx - px, cz - pz
    distance = np.sqrt(ax * ax + az * az)
    distance[outside | (distance < 1e-9) | (distance > sight)] = np.inf
    points, normals = np.zeros((n, _FACES, 2)), np.zeros((n, _FACES, 2))
    distances, rows = np.full((n, _FACES), np.inf), np.arange(n)
    for face in range(_FACES):
        nearest = np.argmin(distance[rows], axis=1)
        found = np.isfinite(distance[rows, nearest])
        rows, nearest = rows[found], nearest[found]
        if not len(rows):
            break
        at = rows, nearest
        distances[rows, face] = distance[at]
        points[rows, face, 0], points[rows, face, 1] = px[at], pz[at]
        nx, nz = ax[at] / distance[at], az[at] / distance[at]
        normals[rows, face, 0], normals[rows, face, 1] = nx, nz
        if face + 1 == _FACES:
            break
        cosine = ax[rows] * nx[:, None] + az[rows] * nz[:, None]
        left = distance[rows]
        left[cosine >= _ALIKE * np.where(np.isinf(left), 1.0, left)] = np.inf
        distance[rows] = left
    return points, normals, distances


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
