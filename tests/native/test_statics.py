"""The closed-form CoM interval and friction need agree with scipy's linear programmes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from stairwright._core import (
    NOTHING_HOLDS,
    RAY_LIMIT,
    com_interval,
    com_margin,
    friction_needed,
    held_within,
    least_friction,
)

contact = st.tuples(
    st.floats(-1.0, 1.0), st.floats(-0.5, 0.5), st.floats(-math.pi / 2, math.pi / 2)
)


def rays_of(points, normals, friction):
    """Force and moment (3, 2n) of both edges of every cone, per weight."""
    columns = []
    for (x, z), (nx, nz) in zip(points, normals, strict=True):
        for side in (friction, -friction):
            fx, fz = nx + side * nz, nz - side * nx
            columns.append((fx, fz, x * fz - z * fx))
    return np.array(columns).T


def interval_by_lp(points, normals, friction):
    rays = rays_of(points, normals, friction)
    ends = []
    for sign in (1.0, -1.0):
        answer = linprog(
            sign * rays[2], A_eq=rays[:2], b_eq=[0.0, 1.0], bounds=(0.0, RAY_LIMIT), method="highs"
        )
        if answer.status == 2:
            return None
        assert answer.status == 0
        ends.append(sign * answer.fun)
    return ends[0], ends[1]


def unpack(contacts):
    points = np.array([(x, z) for x, z, _ in contacts])
    normals = np.array([(-math.sin(a), math.cos(a)) for _, _, a in contacts])
    return points, normals


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(st.lists(contact, min_size=1, max_size=4), st.floats(0.05, 1.5))
def test_interval_equals_linear_programme(contacts, friction):
    points, normals = unpack(contacts)
    rays = rays_of(points, normals, friction)
    for i in range(rays.shape[1]):  # nearly parallel rays are decided by rounding
        for j in range(i):
            cross = rays[0, i] * rays[1, j] - rays[1, i] * rays[0, j]
            if 0.0 < abs(cross) < 1e-6:
                return
    expected = interval_by_lp(points, normals, friction)
    low, high = com_interval(points, normals, friction)
    if expected is None or low > high:
        # At the edge of what is possible rounding may decide: loosen a little and ask again.
        if (expected is None) != (low > high):
            a = interval_by_lp(points, normals, friction * 1.000001)
            b = interval_by_lp(points, normals, friction * 0.999999)
            assert (a is None) != (b is None)
        return
    assert low == pytest.approx(expected[0], abs=1e-6)
    assert high == pytest.approx(expected[1], abs=1e-6)


def test_level_ground_holds_the_com_between_the_wheels():
    points, normals = unpack([(0.4, 0.0, 0.0), (0.0, 0.0, 0.0)])
    assert com_interval(points, normals, 0.5) == pytest.approx((0.0, 0.4))
    assert com_margin(com_interval(points, normals, 0.5), 0.1) == pytest.approx(0.1)
    assert com_margin(com_interval(points, normals, 0.5), -0.1) == pytest.approx(-0.1)


def test_slope_needs_its_tangent_as_friction():
    for angle in (0.1, 0.4, 0.7):
        points, normals = unpack([(0.3, 0.3 * math.tan(angle), angle), (0.0, 0.0, angle)])
        assert friction_needed(points, normals, 0.12) == pytest.approx(math.tan(angle), abs=1e-5)
        need, forces = least_friction(points, normals, 0.12)
        assert need == pytest.approx(math.tan(angle), abs=1e-5)
        assert forces[:, 1].sum() == pytest.approx(math.cos(angle), abs=1e-5)


@settings(max_examples=100, deadline=None)
@given(contact, contact, st.floats(-0.5, 0.5))
def test_least_friction_forces_balance_and_agree_with_the_interval(a, b, com):
    points, normals = unpack([a, b])
    if np.hypot(*(points[0] - points[1])) < 0.05:
        return
    need, forces = least_friction(points, normals, com)
    if not need < 5.0:
        return
    tangents = np.stack([normals[:, 1], -normals[:, 0]], axis=1)
    world = forces[:, :1] * tangents + forces[:, 1:] * normals
    assert world.sum(axis=0) == pytest.approx([0.0, 1.0], abs=1e-6)
    moment = np.sum(points[:, 0] * world[:, 1] - points[:, 1] * world[:, 0])
    assert moment == pytest.approx(com, abs=1e-6)
    assert np.all(np.abs(forces[:, 0]) <= need * forces[:, 1] + 1e-6)
    if np.abs(forces).max() < 0.4 * RAY_LIMIT:
        assert friction_needed(points, normals, com) <= need + 1e-4


@settings(max_examples=100, deadline=None)
@given(contact, contact, st.floats(-0.5, 0.5), st.floats(0.05, 1.5))
@example((0.0, -0.5, 0.0), (0.1875, 0.0, 1.0), 0.0, 1.0)  # the CoM right above the one wheel
def test_what_is_held_within_a_friction_needs_no_more(a, b, com, ample):
    points, normals = unpack([a, b])
    need, expected = least_friction(points, normals, com, ample)
    beside = [least_friction(points, normals, com + d, ample)[0] for d in (-1e-6, 1e-6)]
    if min(need, *beside) - 1e-6 < ample < max(need, *beside) + 1e-6:  # decided by rounding
        return
    held, forces = held_within(points, normals, com, ample)
    assert held == (need < ample)
    if held:
        assert forces.tolist() == expected.tolist()


def test_nothing_holds_a_robot_between_frictionless_walls():
    points, normals = unpack([(0.2, 0.0, math.pi / 2), (-0.2, 0.0, -math.pi / 2)])
    low, high = com_interval(points, normals, 1e-6)
    assert low > high
    assert com_margin((low, high), 0.0) == NOTHING_HOLDS
    assert friction_needed(points, normals, 0.0) < 1.0  # but friction can wedge it
