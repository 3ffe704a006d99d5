"""The certificate's statics against linear programmes, and its contacts against shapely."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from stairwright.planning.equilibrium import STRONGEST, balanced, in_cone, touching

contact = st.tuples(
    st.floats(-0.6, 0.6), st.floats(-0.5, 0.5), st.floats(-math.pi / 2, math.pi / 2)
)


def rays_of(contacts, friction):
    """(2n, 3) force x, force z, moment of the cones' edges."""
    rows = []
    for x, z, a in contacts:
        nx, nz = -math.sin(a), math.cos(a)
        for side in (friction, -friction):
            fx, fz = nx + side * nz, nz - side * nx
            rows.append((fx, fz, x * fz - z * fx))
    return np.array(rows)


def strength_needed(rays):
    """Least bound on the factors of three rays that hold the weight; inf if none do."""
    best = math.inf
    for i in range(len(rays)):
        for j in range(i):
            for k in range(j):
                three = np.vstack([rays[[i, j, k]].T, [0.0, 0.0, 0.0]])
                lp = linprog(
                    [0, 0, 0, 1],
                    A_eq=np.hstack([three[:3], np.zeros((3, 1))]),
                    b_eq=[0, 1, 0],
                    A_ub=np.hstack([np.eye(3), -np.ones((3, 1))]),
                    b_ub=np.zeros(3),
                    method="highs",
                )
                if lp.status == 0:
                    best = min(best, lp.fun)
    return best


@settings(max_examples=25, deadline=None)
@given(st.lists(contact, min_size=1, max_size=3), st.floats(0.1, 1.2))
def test_equilibrium_equals_linear_programmes(contacts, friction):
    answer = bool(in_cone(rays_of(contacts, friction)[None])[0])
    needed = strength_needed(rays_of(contacts, friction))
    if 0.98 * STRONGEST < needed < 1.02 * STRONGEST:
        return
    if answer != (needed < STRONGEST):  # at the edge of what is possible rounding may decide
        more = strength_needed(rays_of(contacts, friction * 1.0001)) < STRONGEST
        less = strength_needed(rays_of(contacts, friction * 0.9999)) < STRONGEST
        assert more != less


def test_touching_faces_are_those_that_shapely_finds():
    rng = np.random.default_rng(4)
    x = np.cumsum(rng.choice([0.0, 0.02, 0.1], 40)) - 1.0
    vertices = np.stack([x, np.cumsum(rng.normal(0.0, 0.05, 40))], axis=1)
    vertices = vertices[np.append(True, np.any(np.diff(vertices, axis=0) != 0.0, axis=1))]
    line = shapely.linestrings(vertices)
    centres = rng.uniform([x[0] - 0.1, -0.5], [x[-1] + 0.1, 0.5], (400, 2))
    points, normals, found = touching(vertices, centres, 0.1)
    distance = shapely.distance(line, shapely.points(centres))
    assert np.array_equal(found[:, 0], distance <= 0.1)
    k = found[:, 0]
    assert points[k, 0] + distance[k, None] * normals[k, 0] == pytest.approx(centres[k])
    assert np.all(np.diff(found.astype(int), axis=1) <= 0)


def test_a_wheel_in_a_corner_touches_both_faces():
    vertices = np.array([[-1.0, 0.0], [0.0, 0.0], [0.0, 0.3], [1.0, 0.3]])
    _, normals, found = touching(vertices, np.array([[-0.05, 0.05], [-0.3, 0.05]]), 0.052)
    assert found.tolist() == [[True, True, False], [True, False, False]]
    assert sorted(map(tuple, np.round(normals[0, :2], 9))) == [(-1.0, 0.0), (0.0, 1.0)]


def test_balance_on_level_ground_ends_at_the_wheels():
    vertices = np.array([[-1.0, 0.0], [1.0, 0.0]])
    wheels = np.tile([[0.2, 0.05], [-0.2, 0.05]], (4, 1, 1))
    com = np.array([-0.21, -0.19, 0.19, 0.21])
    assert balanced(vertices, wheels, com, 0.052, 0.5).tolist() == [False, True, True, False]
    wheels[:, :, 1] += 0.01  # in the air
    assert not balanced(vertices, wheels, com, 0.052, 0.5).any()
