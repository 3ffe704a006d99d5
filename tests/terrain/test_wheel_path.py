"""The wheel-centre curve against an independent geometry library, on random profiles."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

RADIUS = 0.05


@st.composite
def profiles(draw):
    """Random x-monotone polylines with vertical faces, spikes and short segments."""
    n = draw(st.integers(2, 12))
    x, z = 0.0, 0.0
    points = [(-1.0, 0.0), (0.0, 0.0)]
    for _ in range(n):
        x += draw(st.sampled_from([0.0, 0.01, 0.03, 0.11, 0.25]))
        z += draw(st.floats(-0.3, 0.3).filter(lambda v: abs(v) > 1e-3))
        points.append((x, z))
    points.append((x + 1.0, z))
    return Terrain(points=points)


@pytest.mark.slow
@settings(max_examples=80, deadline=None)
@given(profiles())
def test_centres_keep_the_radius_and_never_turn_back(terrain):
    path = wheel_path(terrain, RADIUS)
    s = np.linspace(0, path.length, 1500)
    centres = path.centres(s)
    line = shapely.LineString(terrain.vertices)
    gap = shapely.distance(line, shapely.points(centres))
    assert np.abs(gap - RADIUS).max() < 1e-7
    assert np.diff(centres[:, 0]).min() > -1e-9
    steps = np.hypot(*np.diff(centres, axis=0).T)
    assert steps.max() <= s[1] + 1e-7  # connected, parametrised by arc length


@settings(max_examples=60, deadline=None)
@given(profiles())
def test_length_equals_the_boundary_of_the_dilated_ground(terrain):
    path = wheel_path(terrain, RADIUS)
    v = terrain.vertices
    floor = v[:, 1].min() - 2.0
    ground = shapely.Polygon([*map(tuple, v), (v[-1, 0], floor), (v[0, 0], floor)])
    dilated = ground.buffer(RADIUS, quad_segs=400)
    window = shapely.box(v[0, 0], floor / 2, v[-1, 0], 10.0)
    boundary = dilated.exterior.intersection(window).length
    ends = path.centres(np.array([0.0, path.length]))
    sides = ends[:, 0] - v[[0, -1], 0]  # a first or last segment that slopes starts off the window
    assert path.length == pytest.approx(boundary, abs=2e-3 + 2 * np.abs(sides).sum())


@settings(max_examples=60, deadline=None)
@given(profiles(), st.floats(0, 1))
def test_contact_lies_on_the_terrain_and_projection_inverts(terrain, share):
    path = wheel_path(terrain, RADIUS)
    s = share * path.length
    centre, contact = path.centres([s])[0], path.contacts([s])[0]
    assert shapely.LineString(terrain.vertices).distance(shapely.Point(contact)) < 1e-7
    assert path.centres([path.project(centre)])[0] == pytest.approx(centre, abs=1e-7)


def test_single_stair_by_hand():
    path = wheel_path(Terrain(points=[(-1.5, 0), (0, 0), (0, 0.36), (2, 0.36)]), RADIUS)
    assert path.pieces[:, 0].tolist() == [0, 0, 1, 0]
    assert path.corners == pytest.approx([1.45])
    assert path.length == pytest.approx(1.45 + 0.31 + RADIUS * np.pi / 2 + 2.0)
    assert path.centres([1.45])[0] == pytest.approx([-0.05, 0.05])
    assert path.normals([1.6])[0] == pytest.approx([-1, 0])


@pytest.mark.parametrize(
    ("points", "corners"),
    [
        ([(-1, 0), (1, 0)], 0),  # flat
        ([(-1, 0), (0, 0), (0, 0.5), (0, 0), (1, 0)], 2),  # spike
        ([(-1, 0), (0, 0), (0, -0.4), (0.06, -0.4), (0.06, 0), (1, 0)], 1),  # slit < wheel
        ([(-1, 0), (0, 0), (0, 0.02), (1, 0.02)], 1),  # curb lower than the wheel's radius
        ([(0, 0), (0, 1), (2, 1)], 0),  # begins with a face
    ],
)
def test_odd_profiles_have_a_path(points, corners):
    path = wheel_path(Terrain(points=points), RADIUS)
    assert len(path.corners) == corners


def test_two_thousand_points():
    x = np.linspace(-50, 50, 2000)
    z = np.random.default_rng(1).normal(0, 0.02, 2000).cumsum()
    path = wheel_path(Terrain(points=np.c_[x, z].tolist()), RADIUS)
    gap = shapely.distance(
        shapely.LineString(np.c_[x, z]),
        shapely.points(path.centres(np.linspace(0, path.length, 5000))),
    )
    assert np.abs(gap - RADIUS).max() < 1e-7
    assert path.at_x(3.0) == pytest.approx(path.project(path.centres([path.at_x(3.0)])[0]))
