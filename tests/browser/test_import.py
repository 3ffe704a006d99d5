"""Profiles from outside: a mesh and the plane that cuts it, and what is said of a bad file."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest
from playwright.sync_api import expect

from .conftest import DESK, PHONE, TERRAIN, Product

pytestmark = [pytest.mark.browser]

FAULTS = Path(__file__).with_name("overlap.js").read_text(encoding="utf-8")


@pytest.fixture
def product(fresh: Product) -> Product:
    """The page that these tests share, showing three stairs."""
    return fresh


def _box(x0: float, x1: float, height: float) -> str:
    """A kerb with ground before and behind it, as ASCII STL."""

    def quad(*corners: tuple[float, float, float]) -> str:
        a, b, c, d = (f"vertex {x} {y} {z}\n" for x, y, z in corners)
        facet = "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n"
        return facet.format(a + b + c) + facet.format(a + c + d)

    def strip(a: tuple[float, float], b: tuple[float, float]) -> str:
        return quad((a[0], -1, a[1]), (b[0], -1, b[1]), (b[0], 1, b[1]), (a[0], 1, a[1]))

    line = [(x0 - 3, 0.0), (x0, 0.0), (x0, height), (x1, height), (x1, 0.0), (x1 + 3, 0.0)]
    faces = "".join(strip(a, b) for a, b in itertools.pairwise(line))
    return f"solid kerb\n{faces}endsolid kerb\n"


def _risers(product: Product) -> list[tuple[float, float]]:
    """(x, rise) of every vertical face [m]."""
    points = [product.corner(i) for i in range(product.corners())]
    return [(a[0], b[1] - a[1]) for a, b in itertools.pairwise(points) if a[0] == b[0]]


def test_a_mesh_is_cut_by_a_plane_that_is_dragged(product: Product) -> None:
    page = product.page
    product.drop("kerb.stl", _box(0.0, 2.0, 0.12))
    dialog = page.get_by_role("dialog", name="Cut kerb.stl into a profile")
    dialog.get_by_text("6 corners, x −3.00 to 5.00 m, z 0.00 to 0.12 m").wait_for()
    plane = dialog.get_by_role("slider", name="Plane")
    y = dialog.get_by_label("Plane at y in metres")
    assert y.input_value() == "0.000"
    view = dialog.locator(".from-above svg").bounding_box()
    assert view is not None
    middle = (view["x"] + view["width"] / 2, view["y"] + view["height"] / 2)
    page.mouse.move(*middle)
    page.mouse.down()
    page.mouse.move(middle[0], middle[1] - 20, steps=4)
    page.mouse.up()
    dragged = float(y.input_value())
    assert 0.2 < dragged < 0.8
    plane.press("ArrowDown")
    expect(y).to_have_value(f"{dragged - 0.01:.3f}")
    # Off the mesh there is nothing to import, and the dialog says why.
    y.fill("5")
    dialog.get_by_role("alert").get_by_text("misses the mesh").wait_for()
    assert dialog.get_by_role("button", name="Import").is_disabled()
    y.fill("0.1")
    dialog.get_by_label("Metres per unit of the file").fill("0.5")
    dialog.get_by_text("z 0.00 to 0.06 m").wait_for()
    dialog.get_by_role("button", name="Import").click()
    dialog.wait_for(state="detached")
    assert _risers(product.planned()) == [
        (0.0, pytest.approx(0.06)),
        (1.0, pytest.approx(-0.06)),
    ]


def test_a_mesh_keeps_its_x_and_may_be_turned(product: Product) -> None:
    page = product.page
    product.drop("kerb.stl", _box(0.35, 2.0, 0.12))
    dialog = page.get_by_role("dialog", name="Cut kerb.stl into a profile")
    dialog.get_by_text("6 corners").wait_for()
    tip = dialog.get_by_role("slider", name="Heading").locator("path").bounding_box()
    assert tip is not None
    x, at = tip["x"] + tip["width"] / 2, tip["y"] + tip["height"] / 2
    page.mouse.move(x, at)
    page.mouse.down()
    page.mouse.move(x, at - 30, steps=4)
    page.mouse.up()
    heading = dialog.get_by_label("Heading in degrees")
    assert 5 < float(heading.input_value()) < 40
    heading.fill("0")
    for size in (DESK, PHONE):
        page.set_viewport_size(size)
        assert page.evaluate(FAULTS) == []
    page.set_viewport_size(DESK)
    dialog.get_by_role("button", name="Import").click()
    dialog.wait_for(state="detached")
    assert [x for x, _ in _risers(product.planned())] == [0.35, 2.0]


def test_a_bad_table_is_told_by_its_lines_where_it_was_imported(product: Product) -> None:
    page = product.page
    bad = "x,z\n0,0\n1,0\n\n0.5,0.2\n"
    words = "kerb.csv is not imported. Line 5: x must never decrease, but 0.5 lies behind 1 in"
    product.drop("kerb.csv", bad)
    told = page.get_by_role("alert").filter(has_text=words)
    told.wait_for()
    assert "point" not in told.inner_text()
    page.get_by_role("button", name="Dismiss").click()
    page.get_by_role("button", name=TERRAIN).click()
    menu = page.get_by_role("dialog", name="Terrain")
    file = {"name": "kerb.csv", "mimeType": "text/csv", "buffer": bad.encode()}
    page.get_by_label("Terrain file").set_input_files(files=[file])
    menu.get_by_role("alert").filter(has_text=words).wait_for()
    assert page.locator(".import-error").count() == 1
    page.get_by_label("Terrain file").set_input_files(
        files=[{**file, "buffer": bad.replace("0.5,", "1,").encode()}]
    )
    menu.wait_for(state="detached")
    product.has_corners(3)


def test_a_file_that_is_no_mesh_is_told_in_the_dialog(product: Product) -> None:
    product.drop("kerb.obj", "hello\n")
    dialog = product.page.get_by_role("dialog", name=re.compile("^Cut kerb.obj"))
    dialog.get_by_role("alert").wait_for()
    assert dialog.get_by_role("button", name="Import").is_disabled()
    dialog.get_by_role("button", name="Cancel").click()
    dialog.wait_for(state="detached")
