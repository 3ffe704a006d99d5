"""A terrain by its kind and measures, wherever a terrain is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import stairwright as sw
from stairwright.errors import InputError

STAIR = {"kind": "stair", "rise": 0.05, "run": 0.4, "count": 2}


def test_it_is_what_a_plan_is_asked_for() -> None:
    terrain = sw.plan(STAIR).terrain
    assert terrain.points[1:-1] == [(0, 0), (0, 0.05), (0.4, 0.05), (0.4, 0.1)]
    assert terrain == sw.load_terrain(STAIR)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.yaml", "kind: ramp\nheight: 0.2\nangle: 0.3\n"),
        ("a.json", '{"kind": "ramp", "rise": 0.2, "slope": 0.3}'),
    ],
)
def test_it_may_stand_in_a_file(name: str, text: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    made = sw.load_terrain({"kind": "ramp", "rise": 0.2, "slope": 0.3})
    assert sw.load_terrain(tmp_path / name) == made
    assert sw.import_terrain(tmp_path / name) == made
    assert sw.import_terrain(tmp_path / name, name="mine", friction=0.4).friction == 0.4


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"kind": "hill"}, "kind"),
        ({"kind": ["stair"]}, "kind"),
        ({"kind": "stair"}, "rise"),
        (STAIR | {"rise": -0.1}, "rise"),
        (STAIR | {"count": 200, "run": 1.0}, "count"),
        (STAIR | {"points": [[0, 0], [1, 0]]}, "points"),
    ],
)
def test_what_is_bad_is_named(given: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as caught:
        sw.plan(given)
    assert caught.value.field == ("terrain", field)
