"""Robots as the page downloads them come back through import."""

from __future__ import annotations

from pathlib import Path

import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.export.table import ROBOT_FORMATS
from stairwright.robot.importing.read import read_file
from stairwright.robot.importing.report import Imported

ROBOTS = Path(__file__).parents[3] / "robots"


def written(name: str, file_format: str) -> bytes:
    return bytes(ROBOT_FORMATS[file_format].write(sw.load_robot(name)))


def read(content: bytes, file_name: str = "mine.yaml", **options: object) -> Imported:
    return read_file(content, file_name, {"abduction": 0.0, "hold": {}, **options})


@pytest.mark.parametrize("file_format", ["yaml", "json"])
@pytest.mark.parametrize("name", ["m20", "a1_wheeled"])
def test_a_robot_comes_back_as_it_was_written(name: str, file_format: str) -> None:
    imported = read(written(name, file_format), f"mine.{file_format}")
    robot = sw.load_robot(name)
    assert imported.robot.schema_ == "stairwright/robot/2"
    assert imported.robot.legs == robot.legs
    assert imported.robot.mass == robot.mass
    assert imported.assumed == list(robot.assumed)
    assert imported.warnings == []


def test_it_comes_back_from_its_file(tmp_path: Path) -> None:
    path = tmp_path / "Mine.YML"
    path.write_bytes(written("d1", "yaml"))
    assert sw.import_robot(path).robot == sw.load_robot("d1")


def refused(content: bytes, **options: object) -> InputError:
    with pytest.raises(InputError) as caught:
        read(content, **options)
    return caught.value


def test_what_is_no_robot_is_refused_by_field() -> None:
    own = written("go2w", "yaml")
    terrain = (ROBOTS.parent / "terrains" / "curb-015.yaml").read_bytes()
    assert "a terrain (stairwright/terrain/1), not a robot" in refused(terrain).message
    assert refused(own.replace(b"wheel:", b"wheels:", 1)).field[0] == "wheels"
    assert "nests deeper" in refused(b"[" * 50).message
    assert "UTF-8" in refused(b"\xff\xfe" + own).message
    assert refused(own, hold={"arm": 0.1}).field == ("hold",)
    assert refused(own, wheel_radius=0.1).field == ("wheel_radius",)
