"""Nothing lies over anything and nothing is cut off, in any state, at any size."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from .conftest import DESK, PHONE, TERRAIN, Product

if TYPE_CHECKING:
    from playwright.sync_api import Route, ViewportSize

pytestmark = [pytest.mark.browser, pytest.mark.slow]

FAULTS = Path(__file__).with_name("overlap.js").read_text(encoding="utf-8")
SIZES: list[ViewportSize] = [
    {"width": 1280, "height": 720},
    DESK,
    {"width": 1920, "height": 1080},
    {"width": 1024, "height": 768},
    {"width": 820, "height": 1180},
    PHONE,
]
# A desk's layout, a tablet's and a phone's at their smallest: states other than the first one.
NARROW: list[ViewportSize] = [SIZES[0], SIZES[3], PHONE]
TABS = ("Scene", "Results", "Profile")
# Two frames: what a new size changes has been laid out then.
DRAWN = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"


def _faults(product: Product) -> list[str]:
    product.page.evaluate(DRAWN)
    return [str(fault) for fault in product.page.evaluate(FAULTS)]


def _everywhere(
    product: Product,
    sizes: Sequence[ViewportSize] = NARROW,
    themes: Sequence[str] = ("light",),
) -> list[str]:
    """The faults at these sizes; where tabs are, in each of them."""
    page = product.page
    found = []
    for theme in themes:
        if page.evaluate("document.documentElement.dataset.theme") != theme:
            page.locator("[aria-label*=theme]").click()
        for size in sizes:
            page.set_viewport_size(size)
            areas = page.get_by_role("navigation", name="Areas")
            for tab in TABS if areas.is_visible() else ("",):
                if tab:
                    areas.get_by_role("button", name=tab).click()
                found += [f"{theme} {size['width']} {tab}: {f}" for f in _faults(product)]
    page.set_viewport_size(DESK)
    return found


@pytest.fixture
def product(fresh: Product) -> Product:
    """The page that these tests share, showing three stairs."""
    return fresh


def test_the_check_finds_what_is_cut_off_or_covered(product: Product) -> None:
    page = product.page
    assert _faults(product) == []
    for style in ("width: 20px; overflow: hidden", "position: relative; left: 60px"):
        page.locator(".bar h2").evaluate("(h, style) => { h.style.cssText = style }", style)
        assert any("Profile" in fault for fault in _faults(product))
    page.locator(".bar h2").evaluate("h => { h.style.cssText = '' }")
    canvas = page.locator(".canvas")
    canvas.evaluate("e => { e.style.cssText = 'margin-top: -30px; z-index: 9' }")
    assert any("covered: Profile" in fault for fault in _faults(product))
    canvas.evaluate("e => { e.style.cssText = '' }")
    assert _faults(product) == []


def test_a_planned_page_has_no_overlaps(product: Product) -> None:
    """In both themes, which differ in colours: other states are looked at in one."""
    assert _everywhere(product, SIZES, ("light", "dark")) == []


def test_a_low_phone_scrolls_what_has_no_room(product: Product) -> None:
    """One that lies, and a small one."""
    page = product.page
    try:
        for width, height in ((844, 390), (375, 667)):
            page.set_viewport_size({"width": width, "height": height})
            for tab in TABS:
                areas = page.get_by_role("navigation", name="Areas")
                areas.get_by_role("button", name=tab).click()
                assert _faults(product) == [], (width, tab)
            canvas = page.locator(".canvas").bounding_box()
            assert canvas is not None
            assert canvas["height"] > 180
            clock = page.get_by_role("slider", name="Time")
            clock.scroll_into_view_if_needed()
            clock.click()
    finally:
        page.set_viewport_size(DESK)


# What can be pressed on this screen and is smaller than a fingertip.
SMALL = """() => [...document.querySelectorAll(
  "button, input, select, a[href], [role=slider], [role=switch]")].filter(item => {
  const { width, height, bottom } = item.getBoundingClientRect();
  return width > 0 && bottom > 0 && Math.min(width, height) < 24;
}).map(item => item.ariaLabel || item.innerText || item.title)"""


def test_nothing_to_press_is_smaller_than_a_fingertip_on_a_phone(product: Product) -> None:
    page = product.page
    product.page.get_by_role("slider", name="CoM margin").press("PageUp")
    page.set_viewport_size(PHONE)
    try:
        for tab in TABS:
            areas = page.get_by_role("navigation", name="Areas")
            areas.get_by_role("button", name=tab).click()
            page.evaluate(DRAWN)
            assert page.evaluate(SMALL) == [], tab
        assert _faults(product) == []
    finally:
        page.set_viewport_size(DESK)
    page.get_by_role("region", name="Effect of the weights").wait_for()
    assert _everywhere(product) == []
    page.get_by_role("button", name="Reset CoM margin").click()


def test_menus_have_no_overlaps(product: Product) -> None:
    page = product.page
    for size in (SIZES[0], PHONE):
        page.set_viewport_size(size)
        for name in (TERRAIN, "Snapping", "Layers", "Download"):
            page.get_by_role("button", name=name).first.click()
            assert _faults(product) == [], (size["width"], name)
            page.keyboard.press("Escape")
    page.set_viewport_size(DESK)
    page.keyboard.press("?")
    assert _faults(product) == []
    page.keyboard.press("Escape")


def test_an_empty_canvas_has_no_overlaps(product: Product) -> None:
    page = product.page
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_role("button", name="New", exact=True).click()
    page.get_by_role("heading", name="Draw a profile or start from a preset").wait_for()
    assert _everywhere(product) == []


def test_a_comparison_has_no_overlaps(product: Product) -> None:
    product.choose_terrain("curb-015")
    switch = product.page.get_by_role("switch", name="Compare A with B")
    switch.click()
    product.run()
    assert _everywhere(product, SIZES) == []
    switch.click()


def test_a_refusal_has_no_overlaps(product: Product) -> None:
    product.vertex(0).focus()
    field = product.page.get_by_label("x of the corner in metres")
    field.fill("-0.1")
    field.press("Enter")
    product.planned()
    assert product.status == "infeasible"
    product.vertex(3).focus()
    assert _everywhere(product) == []
    product.page.keyboard.press("2")
    assert _everywhere(product) == []
    product.page.keyboard.press("1")


def test_what_leads_out_of_a_refusal_has_no_overlaps(product: Product) -> None:
    """With its rear in front the robot gets down: what says so stands in three places."""
    page = product.page
    page.get_by_role("button", name=re.compile("^Robot")).first.click()
    page.get_by_role("menuitemradio", name=re.compile(r"^a1_wheeled\b")).click()
    drop = [[-1.2, 0.25], [0, 0.25], [0, 0], [1.2, 0]]
    product.paste(json.dumps({"points": drop, "friction": 0.4})).has_corners(4).planned()
    slider = page.get_by_role("slider", name="Step height ±")
    slider.press("ArrowRight")
    product.planned()
    assert page.get_by_role("button", name="Plan backward").count() == 2
    assert _everywhere(product) == []
    page.keyboard.press("2")
    assert _everywhere(product) == []
    page.keyboard.press("1")
    page.get_by_role("button", name=re.compile("Reset Step height")).click()
    page.get_by_role("button", name=re.compile("^Robot")).first.click()
    page.get_by_role("menuitemradio", name=re.compile(r"^a1_wheeled_x\b")).click()


def test_a_plan_of_minutes_has_no_overlaps(product: Product) -> None:
    page = product.page
    product.draw_flight(25)
    page.get_by_role("slider", name="Time").press("End")
    assert _everywhere(product) == []


def test_waiting_for_a_plan_has_no_overlaps(product: Product) -> None:
    page = product.page
    product.choose_terrain("stairs-building")
    held: list[Route] = []
    page.route("**/api/v1/plans", lambda route: held.append(route))
    product.vertex(2).press("ArrowUp")
    page.locator(".plan-veil").wait_for()
    assert _everywhere(product) == []
    page.unroute("**/api/v1/plans")
    for route in held:
        route.continue_()


def test_a_fast_plan_has_no_overlaps(product: Product) -> None:
    timing = product.page.get_by_role("radiogroup", name="Timing")
    timing.get_by_role("radio", name="Fast").click()
    product.planned()
    product.page.locator(".ribbon path").first.wait_for(state="attached")
    assert _everywhere(product) == []
    timing.get_by_role("radio", name="Steady").click()


def test_settings_with_a_bad_value_have_no_overlaps(product: Product) -> None:
    page = product.page
    page.get_by_role("radio", name="Controller").click()
    field = page.get_by_label("Joint damping, value")
    field.fill("500")
    page.get_by_text("Between 0 and 100 Nm s/rad").wait_for()
    assert _everywhere(product) == []
    field.press("Escape")
    page.get_by_role("radio", name="Plan", exact=True).click()


def test_a_robot_that_stopped_and_its_disturbances_have_no_overlaps(product: Product) -> None:
    page = product.page
    page.get_by_role("radio", name="Trials").click()
    friction = page.get_by_label("Friction, value", exact=True).last
    friction.fill("-0.45")
    friction.press("Enter")
    switch = page.get_by_role("switch", name="Compare A with B")
    page.get_by_role("radio", name="Plan", exact=True).click()
    switch.click()
    assert product.run() == "stopped"
    page.get_by_role("heading", name="Stopped safely").wait_for()
    results = page.get_by_role("region", name="Results", exact=True)
    results.get_by_role("cell", name="Stopped", exact=True).nth(1).wait_for()
    assert _everywhere(product) == []
    page.set_viewport_size(SIZES[0])
    page.evaluate(DRAWN)
    assert results.evaluate("e => e.scrollWidth <= e.clientWidth")
    page.set_viewport_size(DESK)
    # A place that it never reached stands for where it stopped.
    page.get_by_role("button", name="Place", exact=True).click()
    rows = page.locator(".rows-scrub").bounding_box()
    assert rows is not None
    page.mouse.click(rows["x"] + rows["width"] - 3, rows["y"] + 3)
    clock = page.get_by_role("slider", name="Time")
    now, end = (float(clock.get_attribute(f"aria-value{at}") or "nan") for at in ("now", "max"))
    assert 0 <= now <= end
    page.get_by_role("button", name="Time", exact=True).click()
    switch.click()
    page.get_by_role("radio", name="Trials").click()
    page.get_by_role("button", name="Clear", exact=True).click()
    page.get_by_role("radio", name="Plan", exact=True).click()


def test_the_other_workspaces_have_no_overlaps(product: Product) -> None:
    page = product.page
    for key, room in (("2", "robot"), ("3", "map"), ("4", "runs")):
        page.keyboard.press(key)
        page.locator(f".app[data-workspace={room}]").wait_for()
        if room == "runs":
            for pin in page.locator(".run-pin[aria-pressed=false]").all()[:2]:
                pin.click()
        assert _everywhere(product, SIZES) == [], room
    page.keyboard.press("1")


def test_a_lost_connection_has_no_overlaps(product: Product) -> None:
    """Where a corner is in hand and there is no way, too: all of that floats over the canvas."""
    page = product.page
    product.choose_terrain("ramp-1-8")  # that there is no way is soon known
    field = page.get_by_label("Friction coefficient")
    field.fill("0.1")
    field.press("Enter")
    product.planned()
    assert product.status == "infeasible"
    page.route("**/api/v1/healthz", lambda route: route.abort())
    page.get_by_text("No connection to the planner.").wait_for()
    product.vertex(2).focus()
    assert _everywhere(product) == []
    page.unroute("**/api/v1/healthz")
    # It tries again by itself.
    page.get_by_text("No connection to the planner.").wait_for(state="detached")
