"""The terrain document: what is accepted, what is refused and how."""

import math

import numpy as np
import pytest

from stairwright.errors import InputError
from stairwright.library import load_terrain, terrains
from stairwright.terrain.profile import height_at, simplify


def terrain(points, **more):
    return load_terrain({"points": points, **more})


@pytest.mark.parametrize(
    ("data", "path", "words"),
    [
        ({"points": [[0, 0], [1, 0], [0.5, 1]]}, "points.2", "overhang"),
        ({"points": [[0, 0], [1, math.nan]]}, "points.1.1", "finite"),
        ({"points": [[0, 0], [1, math.inf]]}, "points.1.1", "finite"),
        ({"points": [[0, 0], [101, 0]]}, "points.1.0", "100"),
        ({"points": [[0, 0]]}, "points", "must hold at least 2, not 1"),
        ({"points": [[0, 0], [0, 1]]}, "points", "extend along x"),
        ({"points": [[i / 100, 0] for i in range(2001)]}, "points", "2000"),
        ({"points": [[0, 0], [1, "1 m"]]}, "points.1.1", "must be a number"),
        ({"points": [[0, 0], [1, 0]], "friction": 0}, "friction", "greater than 0"),
        ({"points": [[0, 0], [1, 0]], "start": 2}, "start", "between 0 and 1"),
        ({"points": [[0, 0], [1, 0]], "start": 0.5, "goal": 0.2}, "goal", "ahead of the start"),
        ({"points": [[0, 0], [1, 0]], "colour": 1}, "colour", "unknown field"),
        ({}, "points", "required"),
    ],
)
def test_bad_terrain_is_refused_at_its_field(data, path, words):
    with pytest.raises(InputError) as caught:
        load_terrain(data)
    assert caught.value.path == path
    assert words in caught.value.message


def test_overhang_names_the_two_points():
    with pytest.raises(InputError, match=r"point 3 .* behind point 2"):
        terrain([[0, 0], [1, 0], [2, 1], [1.5, 2]])


def test_unknown_preset_lists_the_known_ones():
    with pytest.raises(InputError, match="single-stair-036"):
        load_terrain("single-stair-037")


def test_missing_file_is_an_input_error(tmp_path):
    for name in ("none.yaml", "no\0name.yaml"):
        with pytest.raises(InputError, match="cannot read"):
            load_terrain(tmp_path / name)


def test_file_that_is_no_mapping_or_no_yaml(tmp_path):
    for text, words in (
        ("- 1", "mapping"),
        ("a: [", "cannot be read"),
        ("a: &x 1\nb: *x", "aliases"),
        ("name: 2001-13-45", "cannot be read"),
        ("friction: !!bool x", "cannot be read"),
        ("friction: !!timestamp x", "cannot be read"),
        ('{"friction": ' + "9" * 5000 + "}", "cannot be read"),
    ):
        path = tmp_path / "bad.yaml"
        path.write_text(text)
        with pytest.raises(InputError, match=words):
            load_terrain(path)


def test_repeated_points_merge_and_slits_close_but_spikes_stay():
    assert len(terrain([[0, 0], [0, 0], [1, 0], [1, 0]]).vertices) == 2
    slit = terrain([[-1, 0], [0, 0], [0, -0.5], [0, 0], [1, 0]])
    assert slit.vertices.tolist() == [[-1, 0], [1, 0]]
    spike = terrain([[-1, 0], [0, 0], [0, 0.5], [0, 0], [1, 0]])
    assert spike.vertices.tolist() == [[-1, 0], [0, 0], [0, 0.5], [0, 0], [1, 0]]


def test_simplify_joins_straight_runs():
    x = np.linspace(0, 1, 50)
    assert len(simplify(np.c_[x, 2 * x])) == 2


def test_height_takes_the_upper_end_of_a_face():
    stair = terrain([[-1, 0], [0, 0], [0, 0.3], [1, 0.3], [1, 0.1], [2, 0.1]])
    x = np.array([-2, -0.5, 0, 0.5, 1, 1.5, 9.0])
    assert height_at(stair.vertices, x).tolist() == [0, 0, 0.3, 0.3, 0.3, 0.1, 0.1]


def test_hash_depends_on_shape_alone():
    a = terrain([[0, 0], [1, 0]], name="a")
    assert a.hash == terrain([[0, 0], [1, 0]], name="b").hash
    assert a.hash != terrain([[0, 0], [1.1, 0]]).hash


def test_every_preset_loads():
    assert "single-stair-036" in terrains()
    for name in terrains():
        assert load_terrain(name).name == name
