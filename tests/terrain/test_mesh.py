import math

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from stairwright.errors import InputError
from stairwright.terrain.mesh import slice_mesh
from stairwright.terrain.mesh_heights import mesh_heights
from stairwright.terrain.profile import height_at


def _box(x0, x1, z0, z1, width=1.0):
    move = trimesh.transformations.translation_matrix([(x0 + x1) / 2, 0, (z0 + z1) / 2])
    return trimesh.creation.box(extents=[x1 - x0, width, z1 - z0], transform=move)


@pytest.fixture(scope="module")
def stairs():
    """A floor and three overlapping boxes: rise 0.125, run 0.3, first face at x = 0."""
    boxes = [_box(-1, 3, -0.1, 0)] + [_box(0.3 * i, 3, 0, 0.125 * (i + 1)) for i in range(3)]
    return trimesh.util.concatenate(boxes)


EXPECTED = [
    (-1, 0), (0, 0), (0, 0.125), (0.3, 0.125), (0.3, 0.25), (0.6, 0.25), (0.6, 0.375), (3, 0.375)
]  # fmt: skip


@pytest.mark.parametrize("kind", ["stl", "obj", "ply", "off"])
def test_stairs_of_boxes(stairs, kind):
    data = stairs.export(file_type=kind)
    data = data.encode() if isinstance(data, str) else data
    terrain = slice_mesh(data, kind, origin=(0.0, 0.1))
    assert np.allclose(terrain.points, EXPECTED, atol=1e-6)


def test_a_mesh_keeps_its_x(stairs):
    for shift in (0.0, 1.5):
        moved = stairs.copy().apply_translation([shift, 7.0, 0.0])
        terrain = slice_mesh(moved.export(file_type="stl"), "stl")
        assert np.allclose(terrain.points, [(x + shift, z) for x, z in EXPECTED], atol=1e-6)


def test_y_may_point_up(stairs):
    turned = stairs.copy()
    turned.apply_transform(trimesh.transformations.rotation_matrix(-math.pi / 2, [1, 0, 0]))
    terrain = slice_mesh(turned.export(file_type="stl"), "stl", up="y")
    assert np.allclose(terrain.points, EXPECTED, atol=1e-6)


def test_heights_seen_from_above_are_the_cut_s(stairs):
    seen = mesh_heights(stairs.export(file_type="stl"), "stl")
    assert seen.triangles == len(stairs.faces)
    assert seen.low == pytest.approx((-1, -0.5, -0.1), abs=1e-6)
    assert seen.high == pytest.approx((3, 0.5, 0.375), abs=1e-6)
    heights = np.array(seen.heights)
    assert heights.shape == (32, 128)
    x = -1 + (np.arange(128) + 0.5) * 4 / 128
    terrain = slice_mesh(stairs.export(file_type="stl"), "stl")
    away = np.abs(x[:, None] - [0, 0.3, 0.6]).min(axis=1) > 1e-6
    expected = height_at(terrain.vertices, x)
    assert np.allclose(heights[:, away], expected[away], atol=1e-4)


def test_heights_leave_holes_open():
    apart = trimesh.util.concatenate([_box(0, 1, -0.1, 0), _box(1.2, 2, -0.1, 0)])
    seen = mesh_heights(apart.export(file_type="stl"), "stl")
    x = (np.arange(128) + 0.5) * 2 / 128
    assert [z is None for z in seen.heights[10]] == [1 < at < 1.2 for at in x]


def test_backwards_is_mirrored(stairs):
    terrain = slice_mesh(stairs.export(file_type="stl"), "stl", (0.0, 0.0), heading=math.pi)
    assert np.allclose(terrain.points, [(-x, z) for x, z in reversed(EXPECTED)], atol=1e-6)


def test_across_the_stairs_treads_grow_longer(stairs):
    heading = math.radians(20)
    terrain = slice_mesh(stairs.export(file_type="stl"), "stl", (0.0, 0.0), heading)
    faces = [a[0] for a, b in zip(terrain.points, terrain.points[1:], strict=False) if a[0] == b[0]]
    assert np.diff(faces) == pytest.approx([0.3 / math.cos(heading)] * 2, abs=1e-6)


def test_millimetres(stairs):
    big = stairs.copy()
    big.apply_scale(1000.0)
    terrain = slice_mesh(big.export(file_type="stl"), "stl", (0.0, 0.0), scale=0.001)
    assert np.allclose(terrain.points, EXPECTED, atol=1e-5)
    with pytest.raises(InputError, match="scale"):
        slice_mesh(big.export(file_type="stl"), "stl", (0.0, 0.0))


def test_long_rough_cut_is_thinned():
    x = np.linspace(0, 10, 3000)
    z = 0.1 * np.sin(7 * x) + 0.005 * np.random.default_rng(0).standard_normal(len(x))
    grid = np.stack([np.repeat(x, 2), np.tile([0.0, 1.0], len(x)), np.repeat(z, 2)], axis=1)
    i = 2 * np.arange(len(x) - 1)
    faces = np.concatenate([np.stack([i, i + 1, i + 2], 1), np.stack([i + 1, i + 3, i + 2], 1)])
    data = trimesh.Trimesh(grid, faces, process=False).export(file_type="stl")
    terrain = slice_mesh(data, "stl", (0.0, 0.5))
    assert len(terrain.points) <= 2000
    assert np.abs(height_at(terrain.vertices, x) - z).max() < 0.011


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(-1, 1), st.floats(0.05, 1), st.floats(0.01, 0.5)),
        min_size=1,
        max_size=6,
    )
)
def test_envelope_is_the_highest_box(boxes):
    shapes = [_box(-3, 3, -0.2, 0.0)] + [_box(x, x + w, -0.1, h) for x, w, h in boxes]
    data = trimesh.util.concatenate(shapes).export(file_type="stl")
    terrain = slice_mesh(data, "stl", (0.0, 0.123))
    x = np.random.default_rng(0).uniform(-2.9, 2.9, 200)
    edges = np.array([e for b in boxes for e in (b[0], b[0] + b[1])])
    x = x[np.min(np.abs(x[:, None] - edges), axis=1) > 1e-3]
    expected = [max([0.0, *(h for b, w, h in boxes if b < value < b + w)]) for value in x]
    assert np.allclose(height_at(terrain.vertices, x), expected, atol=2e-4)


@pytest.mark.parametrize("data", [b"", b"garbage", b"solid x\nfacet", bytes(200)])
@pytest.mark.parametrize("kind", ["stl", "obj", "ply", "off"])
def test_broken_files_are_input_errors(data, kind):
    with pytest.raises(InputError):
        slice_mesh(data, kind)


def test_bad_questions(stairs):
    data = stairs.export(file_type="stl")
    with pytest.raises(InputError, match="misses"):
        slice_mesh(data, "stl", (0.0, 5.0))
    with pytest.raises(InputError, match="there are"):
        slice_mesh(data, "step")
    with pytest.raises(InputError, match="finite"):
        slice_mesh(data, "stl", heading=math.nan)


def test_gap_is_named():
    apart = trimesh.util.concatenate([_box(0, 1, -0.1, 0), _box(1.2, 2, -0.1, 0)])
    with pytest.raises(InputError, match=r"gap from x = 1 to 1\.2"):
        slice_mesh(apart.export(file_type="stl"), "stl", (0.0, 0.0))
