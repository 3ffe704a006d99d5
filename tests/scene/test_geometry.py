"""Meshes that are drawn, and the distances that colour them."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from stairwright.library import load_robot
from stairwright.robot.spatial import turn
from stairwright.scene import camera, shapes
from stairwright.scene.clearance import clearance
from stairwright.scene.overlays import aim
from stairwright.terrain.profile import Terrain
from tests.scene.example import example_terrain


def solid(mesh: shapes.Mesh) -> trimesh.Trimesh:
    found = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    found.merge_vertices(merge_tex=True, merge_norm=True)
    found.update_faces(found.nondegenerate_faces())
    return found


@pytest.mark.parametrize("name", ["a1_wheeled", "a1_wheeled_x"])
def test_parts_have_the_planners_outlines(name):
    robot = load_robot(name)
    np.testing.assert_allclose(solid(shapes.trunk(robot)).extents, robot.trunk.size)
    tyre = solid(shapes.tyre(robot))
    assert tyre.extents[1] == pytest.approx(robot.wheel.width)
    assert tyre.extents[0] == pytest.approx(2 * robot.wheel.radius, rel=1e-2)
    link = solid(shapes.link(robot.thigh.length, robot.thigh.radius, 0.02))
    assert (link.bounds[0, 2], link.bounds[1, 2]) == (-robot.thigh.length, 0.0)


@pytest.mark.parametrize(
    "mesh",
    [
        shapes.link(0.2, 0.015, 0.03),
        shapes.joint(0.02, 0.03),
        shapes.sphere(0.01),
        shapes.ring(0.05, 0.036, 0.03, 0.005),
    ],
)
def test_solids_are_closed_and_face_outward(mesh):
    found = solid(mesh)
    assert found.is_watertight
    assert found.volume > 0


def test_extruded_terrain_is_the_profile_times_its_width():
    terrain = example_terrain()
    p, depth, half = terrain.vertices, 0.25, 0.5
    parts = shapes.extrude(p, half, depth)
    found = solid(shapes.merge(parts.treads, parts.risers, parts.flanks))
    area = np.trapezoid(p[:, 1] - p[:, 1].min() + depth, p[:, 0])
    # Without its floor the mesh is open below; seen from the origin at floor level that adds 0.
    found.vertices[:, 2] -= p[:, 1].min() - depth
    assert found.volume == pytest.approx(area * 2 * half)
    up = trimesh.Trimesh(*parts.treads).face_normals
    assert (up[:, 2] > 0.9).all()
    assert np.abs(trimesh.Trimesh(*parts.risers).face_normals[:, 0] + 1).max() < 1e-9


def test_a_plain_floor_has_no_risers_but_still_draws():
    flat = Terrain(points=[(-1, 0), (1, 0)])
    parts = shapes.extrude(flat.vertices, 0.5, 0.2)
    assert trimesh.Trimesh(*parts.risers).area == 0
    assert trimesh.Trimesh(*parts.treads).area == pytest.approx(2.0)


@given(st.lists(st.tuples(st.floats(-1.0, 2.0), st.floats(-0.3, 1.0)), min_size=1, max_size=8))
def test_clearance_is_shapelys_distance(points):
    terrain = example_terrain()
    line = shapely.LineString(terrain.vertices)
    found = clearance(terrain.vertices, np.array(points))
    for value, (x, z) in zip(found, points, strict=True):
        assert abs(value) == pytest.approx(line.distance(shapely.Point(x, z)), abs=1e-9)
        if abs(value) > 1e-6:
            assert (value < 0) == (z < terrain.height(x))


@given(st.lists(st.floats(-1, 1), min_size=3, max_size=3).filter(lambda v: np.hypot(*v[:2]) > 0.1))
def test_aim_turns_z_to_the_direction(vector):
    direction = np.array([vector]) / np.linalg.norm(vector)
    np.testing.assert_allclose(turn(aim(direction), np.array([0.0, 0, 1])), direction, atol=1e-9)


def test_aim_handles_straight_down():
    down = np.array([[0.0, 0.0, -1.0]])
    np.testing.assert_allclose(turn(aim(down), np.array([0.0, 0, 1])), down, atol=1e-12)


def test_a_robot_in_a_pit_is_looked_at_past_the_ground_that_would_hide_it():
    pit = np.array([[-1.5, 0], [0, 0], [0, -1], [0.6, -1], [0.6, 0], [2, 0]], float)
    above, inside = np.array([[-0.5, 0.0, 0.3]]), np.array([[0.1, 0.0, -0.4]])
    usual = camera.view("follow", above[0])
    turned = camera.view("follow", above[0], camera.following_direction(above, pit))
    np.testing.assert_allclose(turned, usual)
    across = camera.following_direction(np.concatenate([above, inside]), pit)
    at = inside[0] + across * 0.5 / -across[1]  # where the line of sight leaves the ground
    assert 0.0 < at[0] < 0.6 or at[2] > 0.0
