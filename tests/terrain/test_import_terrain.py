"""`sw.import_terrain`, and every place that takes a terrain's file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import stairwright as sw
from stairwright.errors import InputError

TABLE = "x,z\n-1,0\n0,0\n0,0.05\n1,0.05\n"
POINTS = [(-1.0, 0.0), (0.0, 0.0), (0.0, 0.05), (1.0, 0.05)]


@pytest.fixture
def table(tmp_path: Path) -> Path:
    path = tmp_path / "kerb?1.csv"
    path.write_text(TABLE)
    return path


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    """A block of 2 by 2 by 0.1 m on the ground, in millimetres, y up."""
    trimesh = pytest.importorskip("trimesh")
    path = tmp_path / "block.stl"
    block = trimesh.creation.box((2000.0, 100.0, 2000.0))
    block.apply_translation((0.0, 50.0, 0.0))
    block.export(path)
    return path


def test_a_table_is_called_as_its_file(table: Path) -> None:
    terrain = sw.import_terrain(table)
    assert (terrain.name, terrain.points) == ("kerb-1", POINTS)
    assert sw.load_terrain(str(table)) == terrain
    own = sw.import_terrain(table, name="own", friction=0.4)
    assert (own.name, own.friction) == ("own", 0.4)


def test_a_document_keeps_its_own_name(tmp_path: Path) -> None:
    path = tmp_path / "other.json"
    path.write_text(sw.load_terrain("curb-015").model_dump_json())
    assert sw.import_terrain(path) == sw.load_terrain("curb-015")


def test_a_mesh_is_scaled_turned_up_and_cut(mesh: Path) -> None:
    terrain = sw.import_terrain(mesh, scale=1e-3, up="y", x=0.5)
    assert terrain.points == [(-1.5, pytest.approx(0.1)), (0.5, pytest.approx(0.1))]


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"scale": 0.0}, "scale"),
        ({"up": "x"}, "up"),
        ({"heading": "north"}, "heading"),
        ({"y": True}, "y"),
        ({"friction": -1}, "friction"),
        ({"friction": 10**400}, "friction"),
    ],
)
def test_a_bad_option_is_named(table: Path, options: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as caught:
        sw.import_terrain(table, **options)
    assert caught.value.field == (field,)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read .*none\.csv: No such file"):
        sw.load_terrain(tmp_path / "none.csv")
