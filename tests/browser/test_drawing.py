"""Terrains that are drawn, typed and saved: pen, hand, table, other windows."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import pytest

import stairwright as sw

from .conftest import TERRAIN, Product

if TYPE_CHECKING:
    from playwright.sync_api import FloatRect

    from tests.conftest import Server

pytestmark = [pytest.mark.browser]


@pytest.fixture
def product(fresh: Product) -> Product:
    """The page that these tests share, showing three stairs."""
    return fresh


def _canvas(product: Product) -> FloatRect:
    box = product.page.locator(".ed").bounding_box()
    assert box is not None
    return box


def test_clicks_with_the_pen_draw_corners_and_risers_stand_upright(product: Product) -> None:
    page = product.page
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_role("button", name="New", exact=True).click()
    page.keyboard.press("p")
    box = _canvas(product)
    for x, y in ((150, 330), (250, 330), (252, 300), (400, 300)):
        page.mouse.click(box["x"] + x, box["y"] + y)
    product.planned()
    points = [product.corner(i) for i in range(product.corners())]
    foot = next(i for i in range(1, len(points)) if points[i][1] > points[i - 1][1] + 0.02)
    assert points[foot][0] == points[foot - 1][0]
    page.keyboard.press("Control+z")  # the last click
    assert product.corners() < len(points) or product.corner(product.corners() - 1) != points[-1]
    page.keyboard.press("Escape")


def test_a_line_drawn_by_hand_keeps_its_risers_upright(product: Product) -> None:
    page = product.page
    product.choose_terrain("flat")
    page.keyboard.press("p")
    box = _canvas(product)
    page.mouse.move(box["x"] + 200, box["y"] + 330)
    page.mouse.down()
    for x, y in ((260, 330), (262, 315), (263, 290), (264, 280), (340, 280)):
        page.mouse.move(box["x"] + x, box["y"] + y, steps=4)
    page.mouse.up()
    product.planned()
    points = [product.corner(i) for i in range(product.corners())]
    rises = [(a, b) for a, b in itertools.pairwise(points) if b[1] - a[1] > 0.05]
    assert rises
    assert all(a[0] == b[0] for a, b in rises)


def test_an_x_beyond_a_neighbour_says_where_it_stopped(product: Product) -> None:
    product.vertex(3).focus()
    field = product.page.get_by_label("x of the corner in metres")
    field.fill("99")
    field.press("Enter")
    limit = product.corner(4)[0]
    product.page.locator(".ro em").get_by_text(f"x stops at {limit:.3f} m").wait_for()
    words = product.vertex(3).get_attribute("aria-label") or ""
    assert "drop" not in words
    product.page.keyboard.press("Escape")


def test_the_terrain_is_a_table_to_type_paste_and_save(product: Product) -> None:
    page = product.page
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_role("button", name="Points", exact=True).click()
    sheet = page.get_by_role("dialog", name="Points of three-stairs-up")
    field = sheet.get_by_label("z of point 7 in metres")
    field.fill("0.4")
    field.press("Enter")
    assert product.corner(6)[1] == pytest.approx(0.4)
    for form, words in (("CSV", "0.6,0.4"), ("YAML", "- [0.6, 0.4]")):
        with page.expect_download() as saved:
            sheet.get_by_role("button", name=form).click()
        assert saved.value.suggested_filename == f"three-stairs-up.{form.lower()}"
        assert words in saved.value.path().read_text()
    field.focus()
    page.evaluate(
        """text => {
          const data = new DataTransfer();
          data.setData("text/plain", text);
          document.activeElement.dispatchEvent(
            new ClipboardEvent("paste", { clipboardData: data, bubbles: true, cancelable: true }));
        }""",
        "-1.5\t0\n0\t0\n0\t0.1\n2\t0.1\n",
    )
    product.has_corners(4)
    assert product.corner(2) == (0.0, pytest.approx(0.1))
    page.get_by_role("button", name="Close").click()


def test_saving_over_a_terrain_can_be_undone_and_descriptions_can_be_edited(
    product: Product,
) -> None:
    page = product.page
    product.drag(6, 0, -20).planned()
    page.keyboard.press("Control+s")
    page.locator(".toast").get_by_text("Saved as three-stairs-up-mine").wait_for()
    first = product.corner(6)
    product.drag(6, 0, -20).planned()
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_label("Description").fill("higher")
    page.get_by_role("button", name="Save", exact=True).click()
    page.locator(".toast").get_by_text("three-stairs-up-mine is replaced").wait_for()
    page.locator(".toast").get_by_role("button", name="Undo").click()
    product.choose_terrain("ramp-30deg-025")
    product.choose_terrain("three-stairs-up-mine")
    assert product.corner(6) == first
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_role("button", name="Delete three-stairs-up-mine").click()
    page.keyboard.press("Escape")


def test_what_another_window_saved_is_offered_and_not_replaced_in_silence(
    product: Product, server: Server
) -> None:
    page = product.page
    product.drag(6, 0, -20).planned()
    name = "three-stairs-up-mine"
    points = [(-1.5, 0.0), (0.0, 0.0), (0.0, 0.05), (2.0, 0.05)]
    with sw.Client(server.url) as service:
        service.save_terrain(sw.Terrain(name=name, points=points))
        page.keyboard.press("Control+s")
        page.locator(".toast").get_by_text(f"{name} is replaced").wait_for()
        service.save_terrain(sw.Terrain(name="of-another-window", points=points))
    product.choose_terrain("of-another-window")
    assert product.corners() == 4
    page.get_by_role("button", name=TERRAIN).click()
    for saved in (name, "of-another-window"):
        page.get_by_role("button", name=f"Delete {saved}").click()
    page.keyboard.press("Escape")
