"""The profile editor's view: what is in it, what covers what, zoom."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from stairwright.terrain.stairs import stair

from .conftest import DESK, PHONE, Product

if TYPE_CHECKING:
    from playwright.sync_api import (
        FloatRect,
        Locator,
    )

pytestmark = [pytest.mark.browser]


@pytest.fixture
def product(fresh: Product) -> Product:
    """The page that these tests share, showing three stairs."""
    return fresh


# Two frames: what a new size changes has been laid out then.
DRAWN = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
# The corners whose middle something that floats over the canvas takes from the pointer.
COVERED = """() => [...document.querySelectorAll("[data-vertex]")].filter(vertex => {
  const box = vertex.querySelector("rect").getBoundingClientRect();
  const at = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
  return at?.closest(".ro, .hint");
}).length"""


@pytest.mark.parametrize(("terrain", "corner"), [("three-stairs-up-down", 3), ("loading-dock", 6)])
def test_the_read_out_covers_no_corner(product: Product, terrain: str, corner: int) -> None:
    product.choose_terrain(terrain)
    try:
        for viewport in (DESK, PHONE):
            product.page.set_viewport_size(viewport)
            product.vertex(corner).focus()
            product.page.locator(".ro").wait_for()
            product.page.evaluate(DRAWN)
            assert product.page.evaluate(COVERED) == 0, viewport
    finally:
        product.page.set_viewport_size(DESK)


def test_wheel_zooms_and_fit_returns(product: Product) -> None:
    zoom = product.page.locator(".zoom")
    assert zoom.inner_text() == "100 %"
    product.page.locator(".ed").hover(position={"x": 500, "y": 250})
    product.page.mouse.wheel(0, -400)
    product.page.wait_for_function("() => document.querySelector('.zoom').innerText !== '100 %'")
    product.page.get_by_role("button", name="Fit to view").click()
    assert zoom.inner_text() == "100 %"


def test_all_of_a_long_flight_is_in_view(product: Product) -> None:
    flight = stair(0.17, 0.29, 120)
    product.drop("flight.json", flight.model_dump_json())
    last = product.vertex(len(flight.points) - 1)
    last.wait_for()
    canvas = product.page.locator(".canvas").bounding_box()
    assert canvas is not None
    for corner in (product.vertex(0), last):
        box = corner.bounding_box()
        assert box is not None
        assert canvas["x"] < box["x"] < canvas["x"] + canvas["width"]
        assert canvas["y"] < box["y"] < canvas["y"] + canvas["height"]


def test_fit_leaves_room_for_dimensions_and_end_corners(product: Product) -> None:
    """Flat ground is as wide as the canvas: its numbers lay on the line, its ends half outside."""
    product.choose_terrain("flat")

    def box(found: Locator) -> FloatRect:
        where = found.bounding_box()
        assert where is not None
        return where

    canvas, label = box(product.page.locator(".ed")), box(product.page.locator(".dimbg"))
    first, last = (box(product.vertex(i).locator("rect")) for i in (0, 1))
    assert label["y"] > first["y"] + first["height"]
    assert first["x"] > canvas["x"] + 40  # past the ruler
    assert last["x"] + last["width"] < canvas["x"] + canvas["width"]


# Numbers of poses that are cut off, or that the legend lies over.
UNREADABLE = """() => {
  const canvas = document.querySelector(".canvas").getBoundingClientRect();
  const words = [...document.querySelectorAll(".lg span")].map(s => s.getBoundingClientRect());
  return [...document.querySelectorAll(".kb g")].filter(number => {
    const b = number.lastElementChild.getBoundingClientRect();
    return b.top < canvas.top + 20 || words.some(w =>
      w.left < b.right && b.left < w.right && w.top < b.bottom && b.top < w.bottom);
  }).map(number => number.textContent);
}"""


def test_a_tall_flight_leaves_the_numbers_of_its_poses_readable(product: Product) -> None:
    page = product.page
    page.set_viewport_size({"width": 1280, "height": 720})
    try:
        product.draw_flight(20)
        assert page.locator(".kb g").count() > 10
        assert page.evaluate(UNREADABLE) == []
    finally:
        page.set_viewport_size(DESK)


def test_a_typed_rise_that_leaves_the_view_is_shown_but_where_the_user_chose(
    product: Product,
) -> None:
    page = product.page
    page.set_viewport_size({"width": 1280, "height": 720})
    canvas = page.locator(".canvas").bounding_box()
    assert canvas is not None

    def higher(than: str, rise: str) -> float:
        """Height of the last corner in the window after the rise was typed [px]."""
        page.get_by_role("button", name=f"Rise {than} m").first.dblclick()
        page.get_by_label("Rise in metres").fill(rise)
        page.keyboard.press("Enter")
        product.planned()
        corner = product.vertex(product.corners() - 1).locator("rect").bounding_box()
        assert corner is not None
        return corner["y"]

    try:
        assert higher("0.125", "1.400") > canvas["y"] + 20
        page.keyboard.press("Control+z")
        product.planned()
        page.locator(".ed").hover(position={"x": 250, "y": 150})
        page.mouse.wheel(0, 100)
        assert higher("0.125", "2.500") < canvas["y"] + 20
    finally:
        page.set_viewport_size(DESK)


def test_two_fingers_zoom_and_change_nothing(product: Product) -> None:
    before = [product.corner(i) for i in range(product.corners())]
    box = product.vertex(3).bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    touch = product.page.context.new_cdp_session(product.page)

    def fingers(kind: str, apart: float) -> None:
        points = [{"x": x, "y": y, "id": 0}, {"x": x + apart, "y": y - apart, "id": 1}]
        touch.send(
            "Input.dispatchTouchEvent",
            {"type": kind, "touchPoints": [] if kind == "touchEnd" else points},
        )

    fingers("touchStart", 80)
    for apart in (100, 130, 160):
        fingers("touchMove", apart)
    fingers("touchEnd", 160)
    product.page.wait_for_function(
        "() => Number(document.querySelector('.zoom').innerText.replace(' %', '')) > 150"
    )
    assert [product.corner(i) for i in range(product.corners())] == before
    product.page.get_by_role("button", name="Fit to view").click()
