"""The certificate's statics against linear programmes, and its contacts against shapely."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest
import shapely
from scipy.optimize import linprog

from stairwright import _core
from stairwright.planning.certificate.certify import TOUCH
from stairwright.planning.certificate.equilibrium import (
    STRONGEST,
    NearFaces,
    balanced,
    near_faces,
    touching,
)
from tests.shapely_checker import run_out


def rays_of(contacts, friction):
    """(2n, 3) force x, force z, moment of the cones' edges."""
    rows = []
    for x, z, a in contacts:
        nx, nz = -math.sin(a), math.cos(a)
        for side in (friction, -friction):
            fx, fz = nx + side * nz, nz - side * nx
            rows.append((fx, fz, x * fz - z * fx))
    return np.array(rows)


def held_by(contacts, friction):
    """Whether faces at contacts (m, 3) balance a robot whose centre of mass is at x = 0."""
    x, z, a = contacts.T
    points, normals, touched = np.zeros((2, 3, 2)), np.zeros((2, 3, 2)), np.zeros((2, 3), bool)
    at = np.divmod(np.arange(len(contacts)), 3)
    points[at] = np.stack([x, z], axis=1)
    normals[at] = np.stack([-np.sin(a), np.cos(a)], axis=1)
    touched[at] = True
    near = NearFaces(points, normals, np.where(touched, 0.0, np.inf))
    return bool(balanced(near, touched, np.zeros(1), friction)[0])


def needs(rays, bound):
    """Whether the linear programme with factors up to `bound` has a solution."""
    return (
        linprog(
            np.zeros(len(rays)), A_eq=rays.T, b_eq=[0, 1, 0], bounds=(0, bound), method="highs"
        ).status
        == 0
    )


def triples(rays):
    """Largest factor of every triple of rays that holds the weight."""
    for three in combinations(range(len(rays)), 3):
        matrix = rays[list(three)].T
        if np.linalg.cond(matrix) < 1e6:
            factors = np.linalg.solve(matrix, [0.0, 1.0, 0.0])
            if factors.min() > -1e-7:
                yield factors.max()


@pytest.mark.slow
def test_equilibrium_equals_reference_and_linear_programme():
    rng = np.random.default_rng(7)
    held = 0
    for _ in range(300):
        n = int(rng.integers(1, 5))
        contacts = rng.uniform([-0.5, -0.4, -1.5], [0.5, 0.4, 1.5], (n, 3))
        friction = rng.uniform(0.2, 1.2)
        rays = rays_of(contacts, friction)
        answer = held_by(contacts, friction)
        held += answer
        assert answer == (min(triples(rays), default=math.inf) <= STRONGEST)
        if answer:
            assert needs(rays_of(contacts, friction * 1.0001), STRONGEST)
        elif not needs(rays, None):
            assert not needs(rays_of(contacts, friction * 0.9999), None)
    assert 50 < held < 250


def test_touching_faces_are_those_that_shapely_finds():
    rng = np.random.default_rng(4)
    x = np.cumsum(rng.choice([0.0, 0.02, 0.1], 40)) - 1.0
    vertices = np.stack([x, np.cumsum(rng.normal(0.0, 0.05, 40))], axis=1)
    vertices = vertices[np.append(True, np.any(np.diff(vertices, axis=0) != 0.0, axis=1))]
    line = shapely.linestrings(run_out(vertices))
    centres = rng.uniform([x[0] - 0.1, -0.5], [x[-1] + 0.1, 0.5], (400, 2))
    points, normals, found = touching(vertices, centres, 0.1, np.full(400, 0.1))
    distance = shapely.distance(line, shapely.points(centres))
    assert np.array_equal(found[:, 0], distance <= 0.1)
    k = found[:, 0]
    assert points[k, 0] + distance[k, None] * normals[k, 0] == pytest.approx(centres[k])
    assert np.all(np.diff(found.astype(int), axis=1) <= 0)


def test_a_wheel_in_a_corner_touches_both_faces():
    vertices = np.array([[-1.0, 0.0], [0.0, 0.0], [0.0, 0.3], [1.0, 0.3]])
    centres = np.array([[-0.05, 0.05], [-0.3, 0.05]])
    _, normals, found = touching(vertices, centres, 0.052, np.full(2, 0.052))
    assert found.tolist() == [[True, True, False], [True, False, False]]
    assert sorted(map(tuple, np.round(normals[0, :2], 9))) == [(-1.0, 0.0), (0.0, 1.0)]


@pytest.mark.parametrize(("bend", "faces"), [(20.0, 2), (0.5, 1)])
def test_faces_that_hardly_differ_are_one(bend, faces):
    bend = math.radians(bend)
    vertices = np.array([[-1.0, 0.0], [0.0, 0.0], [1.0, math.tan(bend)]])
    centre = np.array([[-0.05 * math.tan(bend / 2), 0.05]])
    assert touching(vertices, centre, 0.0501, np.full(1, 0.0501))[2].sum() == faces


def test_a_wheel_a_millimetre_from_a_wall_does_not_lean_on_it():
    vertices = np.array([[-1.0, 0.0], [0.0, 0.0], [0.0, 0.3], [1.0, 0.3]])
    centres = np.array([[-0.0501, 0.0501], [-0.051, 0.05]])
    found = touching(vertices, centres, 0.052, np.full(2, 0.05 + TOUCH))[2]
    assert found.tolist() == [[True, True, False], [True, False, False]]


def test_balance_on_level_ground_ends_at_the_wheels():
    ground = _core.CertificateGround(np.array([[-1.0, 0.0], [1.0, 0.0]]))
    wheels = np.tile([[0.2, 0.05], [-0.2, 0.05]], (4, 1, 1))
    com = np.array([-0.21, -0.19, 0.19, 0.21])

    def held():
        near = near_faces(ground, wheels.reshape(-1, 2), 0.1)
        return balanced(near, near.touched(0.052, np.full(8, 0.05)), com, 0.5)

    assert held().tolist() == [False, True, True, False]
    wheels[:, :, 1] += 0.01  # in the air
    assert not held().any()
