"""Plan's layout: splitters that remember, swap, maximise, inspector, nothing over anything."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from .conftest import DESK, Product

if TYPE_CHECKING:
    from playwright.sync_api import FloatRect, Locator

pytestmark = [pytest.mark.browser]


@pytest.fixture
def product(shared: Product) -> Iterator[Product]:
    """The page that these tests share."""
    shared.errors.clear()
    shared.page.keyboard.press("Escape")
    yield shared
    assert shared.errors == []


def _box(found: Locator) -> FloatRect:
    where = found.bounding_box()
    assert where is not None
    return where


def _editor(product: Product) -> FloatRect:
    return _box(product.page.get_by_role("region", name="Profile editor"))


def _scene(product: Product) -> FloatRect:
    return _box(product.page.get_by_role("region", name="3-D scene"))


def test_profile_and_scene_are_equals_and_the_splitter_remembers(product: Product) -> None:
    page = product.page
    assert _editor(product)["width"] == pytest.approx(_scene(product)["width"], abs=1)
    assert _editor(product)["height"] == pytest.approx(_scene(product)["height"], abs=1)
    bar = page.get_by_role("separator", name="Width of profile and scene")
    at = _box(bar)
    x, y = at["x"] + at["width"] / 2, at["y"] + at["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 120, y, steps=4)
    page.mouse.up()
    wide = _editor(product)["width"]
    assert wide == pytest.approx(_scene(product)["width"] + 240, abs=3)
    page.reload()
    product.planned()
    assert _editor(product)["width"] == pytest.approx(wide, abs=1)
    bar.press("Home")
    assert bar.get_attribute("aria-valuenow") == "25"
    bar.press("ArrowRight")
    assert bar.get_attribute("aria-valuenow") == "27"
    bar.dblclick()
    assert bar.get_attribute("aria-valuenow") == "50"


def test_the_dock_has_a_splitter(product: Product) -> None:
    bar = product.page.get_by_role("separator", name="Height of results and plots")
    plot = product.page.get_by_role("region", name="Pitch, nose-up", exact=True)
    before = _box(plot)["height"]
    bar.press("Shift+ArrowUp")
    assert _box(plot)["height"] == pytest.approx(before + 90, abs=1)
    bar.press("Enter")
    assert _box(plot)["height"] == pytest.approx(before, abs=1)


def test_swap_maximise_and_restore(product: Product) -> None:
    page = product.page
    assert _editor(product)["x"] < _scene(product)["x"]
    page.keyboard.press("x")
    assert _editor(product)["x"] > _scene(product)["x"]
    page.get_by_role("button", name="Swap profile and scene").first.click()
    assert _editor(product)["x"] < _scene(product)["x"]
    both = _editor(product)["width"] + _scene(product)["width"]
    page.get_by_role("button", name="Maximise the scene").click()
    assert _scene(product)["width"] == pytest.approx(both, abs=1)
    assert not page.get_by_role("region", name="Profile editor").is_visible()
    page.keyboard.press("Escape")
    page.locator(".edit").hover()
    page.keyboard.press("m")
    assert _editor(product)["width"] == pytest.approx(both, abs=1)
    page.keyboard.press("m")
    assert _scene(product)["width"] == pytest.approx(both / 2, abs=1)


def test_a_closed_inspector_leaves_its_room_to_the_stage(product: Product) -> None:
    page = product.page
    before = _scene(product)["width"] + _editor(product)["width"]
    page.keyboard.press("i")
    assert _scene(product)["width"] + _editor(product)["width"] > before + 200
    page.get_by_role("button", name="Expand inspector").click()
    assert _scene(product)["width"] + _editor(product)["width"] == pytest.approx(before, abs=1)


def test_a_tablet_has_two_panels_and_the_inspector_beside_them(product: Product) -> None:
    page = product.page
    try:
        for width, least in ((1200, 440), (1024, 360), (900, 300)):
            page.set_viewport_size({"width": width, "height": 768})
            for panel in (_editor(product), _scene(product)):
                assert panel["width"] > least
                assert panel["height"] > 250
            page.keyboard.press("i")
            assert _scene(product)["width"] > width / 2 - 40
            page.keyboard.press("i")
    finally:
        page.set_viewport_size(DESK)


def test_bars_of_margins_reach_as_far_as_the_timeline_at_any_width(product: Product) -> None:
    page = product.page
    try:
        for width in (1440, 1024, 820, 390):
            page.set_viewport_size({"width": width, "height": 900})
            tracks = _box(page.locator(".rows .track").first)
            ticks = _box(page.locator(".ticks"))
            assert tracks["x"] == pytest.approx(ticks["x"], abs=1)
            assert tracks["width"] == pytest.approx(ticks["width"], abs=1)
    finally:
        page.set_viewport_size(DESK)


def test_the_pose_keeps_to_its_row_at_any_width(product: Product) -> None:
    page = product.page
    page.get_by_role("slider", name="Time").press("Home")
    row = page.get_by_role("region", name="Pose at the cursor")
    try:
        for width in (1220, 1280, 1361, 1400, 1440):
            page.set_viewport_size({"width": width, "height": 900})
            assert row.evaluate("e => e.scrollWidth <= e.clientWidth"), width
    finally:
        page.set_viewport_size(DESK)


def test_a_tablet_standing_up_shows_everything_at_once(product: Product) -> None:
    page = product.page
    page.set_viewport_size({"width": 820, "height": 1180})
    try:
        assert not page.get_by_role("navigation", name="Areas").is_visible()
        for name, least in (("Profile editor", 300), ("3-D scene", 200), ("Inspector", 200)):
            box = _box(page.get_by_role("region", name=name, exact=True))
            assert box["height"] > least, name
        assert _editor(product)["width"] == pytest.approx(820, abs=1)
        page.wait_for_function("document.querySelectorAll('.plot').length === 3")
        pose = page.get_by_role("region", name="Pose at the cursor")
        assert pose.evaluate("e => e.scrollWidth <= e.clientWidth")
    finally:
        page.set_viewport_size(DESK)


def test_results_fit_their_dock(product: Product) -> None:
    """Every figure can be seen without scrolling, from the smallest desk up."""
    page = product.fresh("curb-015").page
    product.run()
    card = page.get_by_role("region", name="Results", exact=True)
    try:
        for width, height in ((1440, 900), (1280, 720), (1024, 768)):
            page.set_viewport_size({"width": width, "height": height})
            page.wait_for_function(
                "e => e.scrollHeight <= e.clientHeight && e.scrollWidth <= e.clientWidth",
                arg=card.element_handle(),
            )
            for title in ("Mean speed", "On the stairs", "Cost of transport", "Link contacts"):
                assert card.get_by_role("rowheader", name=title).is_visible(), (width, title)
            planned = re.findall(r"(?:plan|planned)\s+(\d+ J|0\.\d\d)", card.inner_text())
            assert len(planned) == 2, (width, card.inner_text())
    finally:
        page.set_viewport_size(DESK)
