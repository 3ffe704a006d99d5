"""The core's geometry, kinematics and statics against independent forms of the same."""

import copy
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog
from shapely import LineString, Point, Polygon

import stairwright as sw
from stairwright import _core

RISES = st.lists(
    st.tuples(st.floats(0.01, 0.4), st.floats(-0.4, 0.4)), min_size=2, max_size=8
).filter(lambda steps: sum(run for run, _ in steps) > 0.3)


def profile(steps):
    """Corners with x never falling, level ground at both ends."""
    points = [(-1.0, 0.0), (0.0, 0.0)]
    for run, rise in steps:
        x, z = points[-1]
        points += [(x, z + rise), (x + run, z + rise)]
    points.append((points[-1][0] + 1.0, points[-1][1]))
    out = [points[0]]
    for point in points[1:]:
        if math.dist(point, out[-1]) > 1e-6:
            out.append(point)
    return np.array(out)


def ground(vertices):
    low = vertices[:, 1].min() - 5.0
    return Polygon([*vertices, (vertices[-1, 0], low), (vertices[0, 0], low)]).buffer(0)


@settings(max_examples=100, deadline=None)
@given(RISES, st.floats(-0.3, 1.0), st.floats(-0.5, 0.8), st.floats(0, 6.3), st.floats(0.01, 0.3))
def test_clearance_of_links_is_the_distance_from_the_ground(steps, x, z, angle, length):
    vertices = profile(steps)
    a, b = (x, z), (x + length * math.cos(angle), z + length * math.sin(angle))
    want = ground(vertices).distance(LineString([a, b]))
    got = _core.Terrain(vertices).link_clearance(*a, *b, 0.01, 0.3)
    if want > 1e-9:
        assert got == pytest.approx(min(want, 0.31) - 0.01, abs=1e-9)
    else:
        assert got < 0.0


@settings(max_examples=100, deadline=None)
@given(RISES, st.floats(-0.3, 1.0), st.floats(-0.3, 0.8), st.floats(-1.5, 1.5))
def test_clearance_of_the_trunk_is_the_distance_from_the_ground(steps, x, z, pitch):
    vertices = profile(steps)
    outline = np.array([(-0.12, -0.05), (0.1, -0.06), (0.2, 0.0), (0.1, 0.06), (-0.12, 0.05)])
    c, s = math.cos(pitch), math.sin(pitch)
    placed = [(x + c * u + s * v, z - s * u + c * v) for u, v in outline]
    want = ground(vertices).distance(Polygon(placed))
    got = _core.Terrain(vertices).polygon_clearance(_core.Polygon(outline), x, z, pitch, 0.3)
    if want > 1e-9:
        assert got == pytest.approx(min(want, 0.3), abs=1e-9)
    else:
        assert got < 0.0


@settings(max_examples=60, deadline=None)
@given(RISES, st.floats(0.03, 0.15))
def test_the_wheel_path_keeps_one_radius_from_the_ground(steps, radius):
    vertices = profile(steps)
    path = _core.WheelPath(vertices, radius)
    below, length = ground(vertices), path.length
    rows = path.sample(np.linspace(0.0, length, 200))
    for x, z, nx, nz in rows:
        assert below.distance(Point(x, z)) == pytest.approx(radius, abs=2e-6)
        assert below.boundary.distance(Point(x - radius * nx, z - radius * nz)) < 2e-6
    steps_along = np.hypot(*np.diff(rows[:, :2], axis=0).T)
    assert steps_along.max() <= length / 199 + 1e-9, "the curve has no gaps"
    for s in np.linspace(0.1, length - 0.1, 7):
        x, z = path.sample(np.array([s]))[0, :2]
        assert path.project(x, z, 0.0, length) == pytest.approx(s, abs=1e-6)


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(st.integers(1, 4), st.floats(0.1, 1.2), st.randoms(use_true_random=False))
def test_com_intervals_are_those_of_a_linear_programme(count, friction, random):
    points = np.array(
        [[random.uniform(-0.4, 0.4), random.uniform(-0.2, 0.4)] for _ in range(count)]
    )
    angles = [random.uniform(-1.6, 1.6) for _ in range(count)]
    normals = np.array([[math.sin(a), math.cos(a)] for a in angles])
    rays, moments = [], []
    for (x, z), (nx, nz) in zip(points, normals, strict=True):
        for side in (friction, -friction):
            fx, fz = nx + side * nz, nz - side * nx
            rays.append((fx, fz))
            moments.append(x * fz - z * fx)
    ends = []
    for sign in (1.0, -1.0):
        found = linprog(sign * np.array(moments), A_eq=np.array(rays).T, b_eq=[0, 1], bounds=(0, 1))
        ends.append(found.fun * sign if found.status == 0 else None)
    low, high = _core.com_interval(points, normals, friction)
    if ends[0] is None:
        assert low > high
    elif low <= high:  # what holds by a rounding error alone is either way
        assert (low, high) == pytest.approx(tuple(ends), abs=1e-6)


def test_the_robot_is_that_of_the_document():
    robot = sw.load_robot("a1_wheeled_x")
    native = robot.native
    assert native.mass == pytest.approx(robot.mass)
    assert [leg.knee for leg in native.legs] == [robot.joints.front.knee, robot.joints.rear.knee]
    other = copy.copy(native)
    assert other.mass == native.mass
