"""Collision meshes in every format that makers use, in a zip as they pack it."""

from __future__ import annotations

import io
import zipfile
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from stairwright.robot.importing.collada import corners
from stairwright.robot.importing.read import read
from stairwright.robot.importing.upload import unpack
from tests.robot.importing.files import Design
from tests.robot.importing.written import mjcf, urdf

RADIUS, WIDTH = 0.093, 0.05
TURN = trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0))
TYRE = trimesh.creation.cylinder(RADIUS, WIDTH, sections=64, transform=TURN)


def collada(vertices: np.ndarray, *, unit: float = 1.0, node: str = "") -> bytes:
    """A COLLADA file with one mesh; `node` holds its transforms."""
    numbers = " ".join(map(repr, vertices.ravel().tolist()))
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="some" meter="{unit}"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="{vertices.size}">{numbers}</float_array>
<technique_common><accessor source="#a" stride="3"/></technique_common></source>
<source id="n"><float_array id="b" count="3">9 9 9</float_array></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node><node>{node}
<instance_geometry url="#g"/></node></node></visual_scene>
</library_visual_scenes></COLLADA>""".encode()


def text_stl(mesh: trimesh.Trimesh) -> bytes:
    return trimesh.exchange.stl.export_stl_ascii(mesh).encode()


TYRES = {
    "dae": lambda: collada(1000 * TYRE.vertices, unit=0.001),
    "stl": lambda: TYRE.export(file_type="stl"),
    "STL": lambda: text_stl(TYRE),
    "obj": lambda: TYRE.export(file_type="obj").encode(),
    "ply": lambda: TYRE.export(file_type="ply"),
    "off": lambda: TYRE.export(file_type="off").encode(),
}


def packed(robot: str, name: str, mesh: bytes) -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("maker_description/urdf/maker.urdf", robot)
        archive.writestr(f"maker_description/meshes/{name}", mesh)
        archive.writestr("maker_description/README.md", "hello")
    return made.getvalue()


@pytest.mark.parametrize("kind", TYRES)
def test_wheels_of_meshes(kind: str) -> None:
    robot = urdf(replace(Design(), wheel_mesh=True)).replace("tyre.dae", f"tyre.{kind}")
    made = read(unpack(packed(robot, f"tyre.{kind}", TYRES[kind]()), "a.zip"), {})
    assert made.robot.wheel.radius == pytest.approx(RADIUS, rel=1e-6)
    assert made.robot.wheel.width == pytest.approx(WIDTH, rel=1e-6)
    assert not any("guess" in each or "not sent" in each for each in made.warnings)


def test_a_trunk_of_a_mesh_is_its_hull_of_few_corners() -> None:
    ball = trimesh.creation.icosphere(3, 0.15)
    trunk = '<geom class="touch" type="box"'
    text = mjcf(Design(head=False)).replace("<asset>", '<asset><mesh name="ball" file="ball.stl"/>')
    text = text.replace(trunk, f'<geom type="mesh" mesh="ball" pos="0.03 0 0.1"/>{trunk}')
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        archive.writestr("robot.xml", text)
        archive.writestr("assets/ball.stl", ball.export(file_type="stl"))
    outline = read(unpack(made.getvalue(), "a.zip"), {}).robot.trunk.outline
    shape = max(outline, key=lambda piece: max(z for _, z in piece.points))
    assert len(shape.points) <= 16
    assert shape.width == pytest.approx(0.3, rel=0.01)
    corner = np.array(shape.points) - (0.0, 0.04)  # the hips' middle is at (0.03, 0.06)
    assert 0.149 < np.hypot(*corner.T).max() < 0.157


def test_nodes_move_a_mesh() -> None:
    points = np.array([(1.0, 0, 0), (0, 2.0, 0), (0, 0, 3.0), (0, 0, 0)])
    steps = (
        "<translate>1 0 0</translate><rotate>0 0 1 90</rotate><scale>2 2 2</scale>"
        "<matrix>1 0 0 0 0 1 0 0 0 0 1 5 0 0 0 1</matrix>"
    )
    read_back = corners(collada(points, node=steps), "a.dae")
    expected = [(1, 2, 10), (-3, 0, 10), (1, 0, 16), (1, 0, 10)]
    np.testing.assert_allclose(read_back, expected, atol=1e-12)
    inches = corners(collada(points, unit=0.0254), "a.dae")
    np.testing.assert_allclose(inches, 0.0254 * points)


@pytest.mark.slow
def test_broken_meshes_are_as_if_they_were_not_sent() -> None:
    robot = urdf(replace(Design(), wheel_mesh=True))
    for content in (
        b"",
        b"<COLLADA/>",
        b"solid",
        bytes(100),
        collada(np.array([[np.nan] * 3] * 5)),
    ):
        made = read(unpack(packed(robot, "tyre.dae", content), "a.zip"), {})
        assert any("tyre.dae" in each for each in made.warnings)
