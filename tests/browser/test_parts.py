"""Parts of the page: those that come later, and the scene, which shares a thread with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from .conftest import PATIENCE, Product

if TYPE_CHECKING:
    from playwright.sync_api import Page, Route

pytestmark = pytest.mark.browser

ROOMS = {"robot": "2", "map": "3", "runs": "4"}
# The files of these parts have come, as they do while the page idles.
CAME = """parts => parts.every(part => performance.getEntriesByType("resource")
  .some(e => e.name.includes(`/assets/${part}-`) && e.responseEnd > 0))"""


def test_a_part_that_did_not_come_says_so_and_comes_when_asked_again(product: Product) -> None:
    page = product.page
    away = [True]

    def answer(route: Route) -> None:
        if away[0]:
            route.abort()
        else:
            route.continue_()

    page.route("**/assets/map-*.js", answer)
    product.open()
    # The last one: nothing comes by itself from then on.
    page.wait_for_function(CAME, arg=["designs"], timeout=PATIENCE)
    # Opening it is an attempt, too.
    with page.expect_event("requestfailed", lambda request: "/assets/map-" in request.url):
        page.keyboard.press("3")
    told = page.get_by_role("alert").filter(has_text="The map could not be loaded")
    expect(told).to_be_visible(timeout=PATIENCE)
    assert product.status == "feasible"
    away[0] = False
    told.get_by_role("button", name="Try again").click()
    expect(page.get_by_text("How far can it go?")).to_be_visible(timeout=PATIENCE)


def test_workspaces_that_were_never_open_need_no_service(product: Product) -> None:
    page = product.page
    product.open()
    later = ["robot", "map", "runs", "points-table", "cut-dialog", "designs"]
    page.wait_for_function(CAME, arg=later, timeout=PATIENCE)
    page.context.set_offline(True)
    for name, key in ROOMS.items():
        page.keyboard.press(key)
        expect(page.locator(f".app[data-workspace={name}] .room > main:visible")).to_be_visible()


LAST_MOVE = "addEventListener('pointermove', event => { window.moved = event.timeStamp; }, true)"
# In the scene's frame: one frame that takes 60 ms, and how long after the last move the next comes.
NEXT_FRAME = """() => {
  requestAnimationFrame(() => {
    const begun = performance.now();
    while (performance.now() < begun + 60);
    requestAnimationFrame(() => { parent.rested = parent.performance.now() - parent.moved; });
  });
}"""


def test_a_slow_scene_waits_until_the_hand_rests(page: Page) -> None:
    page.set_viewport_size({"width": 1024, "height": 640})  # draws the scene with less work
    product = Product(page, scene=True).open()
    frame = page.frame_locator("iframe").first
    frame.locator("canvas").first.wait_for(state="attached", timeout=PATIENCE)
    inside = next(each for each in page.frames if "/scene/" in each.url)
    box = product.vertex(2).locator("rect").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.evaluate(LAST_MOVE)
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(40):
        page.mouse.move(x + step % 8, y)
        page.wait_for_timeout(20)
        if step == 10:
            inside.evaluate(NEXT_FRAME)
    page.wait_for_function("window.rested !== undefined", timeout=PATIENCE)
    page.mouse.up()
    assert page.evaluate("window.rested") >= 120
