"""Which wrenches the ground can give: facets of the cone that contact forces span."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from stairwright.terrain.wheel_path import WheelPath

Floats = NDArray[np.float64]

NEAR_CORNER = 0.001  # m; a wheel this near to a corner touches both faces
_BESIDE = 2e-4  # m
_CONTACTS = 4
_FIRST, _SECOND = np.array(list(itertools.combinations(range(2 * _CONTACTS), 2))).T
_THIN = 1e-9
_INSIDE = 1e-7


def touched(path: WheelPath, wheels: Floats) -> tuple[Floats, Floats]:
    """Contact points and unit normals (n, 4, 2) of wheels at arc lengths (n, 2).

    Two for each wheel; they are the same where it touches one face.
    """
    corners = np.concatenate([[-np.inf], path.corners, [np.inf]])
    places = []
    for s in wheels.T:
        after = np.searchsorted(corners, s)
        before = corners[after - 1]
        near = np.where(s - before < corners[after] - s, before, corners[after])
        beside = np.where(np.abs(s - near) < NEAR_CORNER, _BESIDE, 0.0)
        at = np.where(beside > 0.0, near, s)
        places += [at - beside, at + beside]
    points = np.stack([path.contacts(s) for s in places], axis=1)
    return points, np.stack([path.normals(s) for s in places], axis=1)


def facets(points: Floats, normals: Floats, about: Floats, friction: float) -> Floats:
    """Inward unit normals (n, m, 3) of the cone of wrenches (force x, z, moment about +y).

    A wrench can be given if its product with none of them is negative. Rows of zeros fill up.

    Args:
        points: (n, 4, 2) contacts [m].
        normals: (n, 4, 2) out of the terrain.
        about: (n, 2) where moments are taken [m].
        friction: Coulomb coefficient.
    """
    lever = points - about[:, None]
    tangents = np.stack([normals[..., 1], -normals[..., 0]], axis=-1)
    forces = np.concatenate([normals + friction * tangents, normals - friction * tangents], axis=1)
    forces /= np.linalg.norm(forces, axis=-1, keepdims=True)
    lever = np.concatenate([lever, lever], axis=1)
    moment = lever[..., 1] * forces[..., 0] - lever[..., 0] * forces[..., 1]
    rays = np.concatenate([forces, moment[..., None]], axis=-1)
    planes = np.cross(rays[:, _FIRST], rays[:, _SECOND])
    size = np.linalg.norm(planes, axis=-1, keepdims=True)
    planes = np.where(size > _THIN, planes / np.maximum(size, _THIN), 0.0)
    sides = planes @ rays.transpose(0, 2, 1)
    inward = (sides >= -_INSIDE).all(axis=-1)
    outward = (sides <= _INSIDE).all(axis=-1) & ~inward
    planes *= (inward.astype(float) - outward)[..., None]
    full = np.abs(planes).sum(axis=-1) > 0.0
    most = int(full.sum(axis=1).max())
    order = np.argsort(~full, axis=1, kind="stable")[:, :most, None]
    return np.take_along_axis(planes, order, axis=1)
