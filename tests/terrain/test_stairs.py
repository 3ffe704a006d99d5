import math

import numpy as np
import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.terrain.stairs import flat, ramp, stair


def test_stair_points():
    terrain = stair(0.2, 0.3, 2, approach=1.0, platform=0.5)
    assert terrain.points == [
        (-1.0, 0.0), (0.0, 0.0), (0.0, 0.2), (0.3, 0.2), (0.3, 0.4), (0.8, 0.4)
    ]  # fmt: skip


def test_up_and_down_ends_at_the_start_height():
    terrain = stair(0.125, 0.3, 3, direction="up-down", platform=1.5)
    assert terrain.points[-1] == (4.2, 0.0)
    assert terrain.height(1.0) == pytest.approx(0.375)
    rises = np.diff(np.array(terrain.points)[:, 1])
    assert sorted(rises[rises != 0]) == pytest.approx([-0.125] * 3 + [0.125] * 3)


def test_inclined_faces_keep_the_run_between_edges():
    terrain = stair(0.2, 0.3, 2, face_angle=math.radians(60))
    edges = [p[0] for p in terrain.points if p[1] in (0.2, 0.4)][::2]
    assert edges[1] - edges[0] == pytest.approx(0.3)


def test_ramp_slope():
    terrain = ramp(0.25, math.radians(30))
    foot, top = terrain.points[1], terrain.points[2]
    assert math.atan2(top[1] - foot[1], top[0] - foot[0]) == pytest.approx(math.radians(30))


def test_flat_is_two_points():
    assert flat(3.0).points == [(-1.5, 0.0), (1.5, 0.0)]


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ({"rise": 0.0}, "rise"),
        ({"rise": math.nan}, "rise"),
        ({"rise": 0.2, "count": 0}, "count"),
        ({"rise": 0.2, "count": 2.5}, "count"),
        ({"rise": 0.2, "count": 200, "run": 1.0}, "count"),
        ({"rise": 60.0, "face_angle": 0.1}, "rise"),
        ({"rise": 0.2, "direction": "sideways"}, "direction"),
        ({"rise": 0.2, "face_angle": 2.0}, "face_angle"),
        ({"rise": 0.2, "face_angle": 0.1, "count": 2}, "run"),
        ({"rise": 0.2, "friction": 0.0}, "friction"),
    ],
)
def test_bad_measures_name_the_field(arguments, field):
    with pytest.raises(InputError) as error:
        stair(**arguments)
    assert error.value.field[0] == field


def test_presets_have_their_own_names_and_texts():
    for name in sw.terrains():
        terrain = sw.load_terrain(name)
        assert terrain.name == name
        assert terrain.description
    paper = {
        "ramp-30deg-025", "single-stair-030", "single-stair-036", "three-stairs-up",
        "three-stairs-up-down",
    }  # fmt: skip
    assert paper <= set(sw.terrains())


def test_presets_agree_with_the_generators():
    same = {
        "single-stair-036": stair(0.36),
        "three-stairs-up": stair(0.125, 0.30, 3),
        "three-stairs-up-down": stair(0.125, 0.30, 3, direction="up-down", platform=1.5),
        "stairs-building": stair(0.18, 0.28, 5),
        "ramp-30deg-025": ramp(0.25, math.radians(30)),
    }
    for name, terrain in same.items():
        assert np.allclose(sw.load_terrain(name).vertices, terrain.vertices, atol=1e-6), name
