"""Files that want to harm: refused or harmless, in little time, and nothing outside is read."""

from __future__ import annotations

import io
import re
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.robot.importing import bounded, upload
from stairwright.robot.importing.local import gather
from stairwright.robot.importing.read import read
from stairwright.robot.importing.upload import Upload, unpack
from tests.robot.importing.files import Design
from tests.robot.importing.written import mjcf, urdf

MJCF, URDF = mjcf(Design()), urdf(Design())
LIGHT = '<light pos="0 0 3"/>'
TETRA = "v -.5 -.1 0\nv .5 -.1 0\nv 0 .1 0\nv 0 0 .7\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


def zipped(**files: str | bytes) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name.replace("__", "/"), content)
    return packed.getvalue()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<!DOCTYPE a [<!ENTITY b 'c'>]>" + MJCF, "entities are not accepted"),
        ("<mujoco>" + "<default>" * 5000 + "</default>" * 5000 + "</mujoco>", "nested deeper"),
        ("<mujoco>" + "<geom/>" * 30000 + "</mujoco>", "more than 20,000 elements"),
        (MJCF.replace(LIGHT, '<replicate count="9999999"><geom/></replicate>'), "<replicate>"),
        (MJCF.replace(LIGHT, '<composite type="cable" count="9999999 1 1"/>'), "<composite>"),
        (MJCF.replace("<option", "<extension/><option"), "<extension>"),
        (MJCF.replace("<option", '<include file="/etc/hostname"/><option'), "was not sent"),
        (MJCF.replace("<option", '<include file="../a.xml"/><option'), "was not sent"),
        (MJCF.replace(LIGHT, '<body><geom size="1"/></body>' * 3000), "more than 500 bodies"),
        (MJCF.replace('mass="7.0"', 'mass="nan"'), "must be finite"),
        (MJCF.replace('pos="0 0 0.6"', 'pos="0 0 nan"'), "finite"),
        (URDF.replace('mass value="7.0"', 'mass value="1e999"'), "must be a finite number"),
        (URDF.replace('mass value="7.0"', 'mass value="-7"'), "-7 kg"),
        ('<robot name="a"><link name="${x}"/></robot>', "xacro"),
        ("<html/>", "neither URDF"),
        ('<robot name="a"/>', "the file has no links"),
        ("hello", "is no XML"),
        ("", "is no XML"),
    ],
)  # fmt: skip
def test_it_is_refused(text: str, says: str) -> None:
    with pytest.raises(InputError, match="file: ") as caught:
        read(Upload("a.xml", text.encode()), {})
    assert says in str(caught.value)


def test_blank_lines_before_the_declaration_are_nothing() -> None:
    """As for MuJoCo and ROS; lines of the file keep their numbers."""
    declared = '\n\n<?xml version="1.0"?>\n'
    read(Upload("a.urdf", (declared + URDF.partition("?>")[2]).encode()), {})
    with pytest.raises(InputError, match="line 4"):
        read(Upload("a.urdf", (declared + "<robot/><robot/>").encode()), {})


def test_other_encodings_cannot_hide_anything() -> None:
    for encoding in ("utf-16", "utf-32"):
        with pytest.raises(InputError, match="not UTF-8"):
            read(Upload("a.xml", MJCF.encode(encoding)), {})


def test_what_only_shows_or_tunes_is_left_out() -> None:
    text = MJCF.replace(
        "<asset>",
        '<size memory="900G"/><asset><texture name="t" type="2d" file="/etc/passwd.png"/>'
        '<hfield name="h" file="/etc/shadow.png" size="1 1 1 1"/>'
        '<texture name="u" type="2d" builtin="checker" width="99999" height="99999"/>',
    )
    assert read(Upload("a.xml", text.encode()), {}).robot.mass == pytest.approx(17.8, abs=0.1)


@pytest.mark.slow
def test_meshes_outside_are_not_read(tmp_path: Path) -> None:
    """Files that exist, in a folder above and at an absolute path, have no effect."""
    inner = tmp_path / "inner"
    inner.mkdir()
    for place in (tmp_path / "out.obj", tmp_path / "body.obj"):
        place.write_text(TETRA)
    (inner / "link.obj").symlink_to(tmp_path / "out.obj")
    trunk = '<geom class="touch" type="box"'
    for reference in (str(tmp_path / "out.obj"), "../out.obj", "../body.obj", "link.obj"):
        text = MJCF.replace("<asset>", f'<asset><mesh name="out" file="{reference}"/>')
        text = text.replace(trunk, f'<geom type="mesh" mesh="out"/>{trunk}')
        file = inner / "a.xml"
        file.write_text(text.replace('meshdir="assets"', ""))
        assert gather(file)[2] == {}
        made = sw.import_robot(file)
        assert any(
            "out.obj" in each or "link.obj" in each or "body.obj" in each for each in made.warnings
        )
        assert max(z for piece in made.robot.trunk.outline for _, z in piece.points) < 0.2


@pytest.mark.slow
def test_a_mesh_that_was_sent_is_read(tmp_path: Path) -> None:
    trunk = '<geom class="touch" type="box"'
    text = MJCF.replace("<asset>", '<asset><mesh name="fin" file="a/b/fin.obj"/>')
    text = text.replace(trunk, f'<geom type="mesh" mesh="fin"/>{trunk}')
    packed = zipped(**{"maker__robot.xml": text, "maker__meshes__fin.obj": TETRA})
    made = read(unpack(packed, "a.zip"), {})
    assert max(z for piece in made.robot.trunk.outline for _, z in piece.points) > 0.6
    (tmp_path / "robot.xml").write_text(text)
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "fin.obj").write_text(TETRA)
    assert sw.import_robot(tmp_path / "robot.xml").robot.trunk == made.robot.trunk


def test_a_mass_that_only_a_mesh_tells_is_asked_for() -> None:
    text = MJCF.replace("<asset>", '<asset><mesh name="fin" file="fin.obj"/>')
    thigh = r'(<body name="FL_thigh"[^>]*>)<inertial[^>]*/>'
    text = re.sub(thigh, r'\1<geom type="mesh" mesh="fin"/>', text)
    with pytest.raises(
        InputError, match="a zip with its meshes: the mass of FL_thigh is theirs alone"
    ):
        read(Upload("a.xml", text.encode()), {})


def test_includes_are_read_from_the_zip_and_only_once() -> None:
    first, last = MJCF.index("<worldbody>"), MJCF.index("</worldbody>") + len("</worldbody>")
    main = MJCF[:first] + '<include file="legs.xml"/>' + MJCF[last:]
    packed = zipped(**{"main.xml": main, "legs.xml": f"<mujoco>{MJCF[first:last]}</mujoco>"})
    parts = Upload("main.xml", main.encode(), {"legs.xml": unpack(packed, "a.zip").content})
    assert read(parts, {}).robot.mass == read(Upload("a.xml", MJCF.encode()), {}).robot.mass
    ring = b'<mujoco><include file="b.xml"/></mujoco>'
    with pytest.raises(InputError, match="included again"):
        read(Upload("main.xml", ring, {"b.xml": ring}), {})


def test_zips() -> None:
    for data, says in (
        (zipped(**{"a.txt": "x"}), "holds no URDF or MJCF"),
        (zipped(**{"a.urdf": URDF, "b.urdf": URDF}), "several robot files"),
        (zipped(**{"..__..__a.urdf": URDF}), "outside itself"),
        (b"PK\x03\x04" + bytes(50), "cannot be read"),
        (URDF.encode(), "'a.zip' is not a zip"),
        (zipped(**{"a.urdf": URDF})[:-30], "cannot be read"),
    ):
        with pytest.raises(InputError, match=says):
            unpack(data, "a.zip")


def test_xacro_by_its_name_is_told_what_to_do() -> None:
    with pytest.raises(InputError, match="run xacro on it first"):
        unpack(URDF.encode(), "a.urdf.xacro")


def test_zip_bombs(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match="unpacks to more than"):
        unpack(zipped(**{"a.urdf": bytes(65 * 2**20)}), "a.zip")
    # A directory that tells a small size does not help.
    data = bytearray(zipped(**{"a.urdf": URDF}))
    at = data.index(b"PK\x01\x02") + 24
    data[at : at + 4] = struct.pack("<I", 10)
    with pytest.raises(InputError, match=r"larger than the zip says|cannot be read"):
        unpack(bytes(data), "a.zip")
    monkeypatch.setattr(upload, "_MOST_FILES", 3)
    with pytest.raises(InputError, match="more than 3 files"):
        unpack(zipped(**{f"{k}.stl": "" for k in range(5)}), "a.zip")


def test_time_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a.urdf"
    file.write_text(URDF)
    monkeypatch.setattr(bounded, "DEADLINE", 0.01)
    with pytest.raises(InputError, match="takes longer than"):
        sw.import_robot(file)


@pytest.mark.slow
def test_memory_is_bounded(tmp_path: Path) -> None:
    big = '<mesh name="big" builtin="supersphere" params="20000 1 1"/>'
    trunk = '<geom class="touch" type="box"'
    text = MJCF.replace("<asset>", f"<asset>{big}")
    file = tmp_path / "a.xml"
    file.write_text(text.replace(trunk, f'<geom type="mesh" mesh="big"/>{trunk}'))
    with pytest.raises(InputError, match="too much"):
        sw.import_robot(file)


@pytest.mark.slow
def test_the_reader_can_open_nothing_and_start_nothing() -> None:
    code = """
import os, socket
from stairwright.robot.importing.child import _seal
from stairwright.robot.importing.rehearsal import rehearse
rehearse(); _seal()
for attempt in (lambda: open('/etc/hostname'), lambda: socket.socket(), lambda: os.pipe()):
    try:
        attempt()
    except OSError as error:
        os.write(1, str(error.errno).encode() + b' ')
rehearse()
os.write(1, b'reads on')
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "24 24 24 reads on"


@pytest.mark.parametrize("path", ["missing.urdf", "a\0b.urdf", "/etc", "robot.step"])
def test_bad_paths(path: str, tmp_path: Path) -> None:
    (tmp_path / "robot.step").write_text("x")
    with pytest.raises(InputError, match="file: "):
        sw.import_robot(tmp_path / path)
