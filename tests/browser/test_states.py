"""States of the page: first visit, infeasible, undone; links, sessions and narrow windows."""

from __future__ import annotations

import json
import re

import pytest

from .axe import violations
from .conftest import DESK, PATIENCE, TERRAIN, Product

pytestmark = [pytest.mark.browser, pytest.mark.slow]


def _infeasible(product: Product) -> None:
    """Too short a start: the answer comes at once."""
    product.vertex(0).focus()
    field = product.page.get_by_label("x of the corner in metres")
    field.fill("-0.1")
    field.press("Enter")
    product.planned()
    product.vertex(0).focus()


def test_first_visit_shows_a_solved_sample_and_a_hint(product: Product) -> None:
    product.open()
    assert product.status == "feasible"
    hint = product.page.get_by_text("Drag a corner: the poses follow.")
    hint.wait_for()
    product.page.get_by_role("button", name="Got it").click()
    product.page.reload()
    product.planned()
    assert hint.count() == 0


def test_an_infeasible_profile_says_what_and_where(shared: Product) -> None:
    product = shared.fresh("curb-015")
    _infeasible(product)
    assert product.status == "infeasible"
    card = product.page.get_by_role("region", name="What stops the robot")
    assert card.locator("h4").inner_text().strip()
    assert product.page.get_by_role("button", name="Run rollout").is_disabled()
    assert product.page.evaluate("document.activeElement.dataset.vertex") == "0"
    product.page.get_by_role("button", name="Download").click()
    formats = product.page.locator(".downloads b").all_inner_texts()
    assert "MJCF" in formats
    assert "BUNDLE" not in formats  # for a robot to follow
    product.page.keyboard.press("Escape")
    card.get_by_role("button", name="Undo edit").click()
    product.planned()


def test_poses_without_a_motion_between_them_are_not_called_feasible(shared: Product) -> None:
    """Going down with both knees back the robot tips between two poses of the paper."""
    product = shared.fresh("curb-015")
    drop = [[-1.2, 0.2], [0, 0.2], [0, 0], [1.2, 0]]
    product.paste(json.dumps({"points": drop, "friction": 0.6})).has_corners(4).planned()
    product.page.get_by_role("button", name="Robot").first.click()
    product.page.get_by_role("menuitemradio").first.click()
    product.planned()
    product.page.get_by_role("radio", name="Paper: critical poses").click()
    pill = product.page.get_by_title("only the poses are certified")
    pill.wait_for(timeout=PATIENCE)
    assert "Poses only" in pill.inner_text()
    results = product.page.get_by_role("region", name="Results")
    explained = results.get_by_text("only the poses are certified")
    explained.wait_for()
    product.page.get_by_text("Poses checked, motion between them not").wait_for()
    product.run()
    explained.wait_for()
    product.page.get_by_role("radio", name="Path").click()
    product.page.get_by_role("button", name="Robot").first.click()
    product.page.get_by_role("menuitemradio", name="a1_wheeled_x").click()
    product.planned()


def test_undo_brings_back_settings_and_deleted_terrains(shared: Product) -> None:
    page = shared.fresh("ramp-30deg-025").page
    speed = page.get_by_role("slider", name="Speed")
    before = speed.get_attribute("aria-valuetext")
    corner = shared.corner(2)
    speed.press("PageUp")
    changed = speed.get_attribute("aria-valuetext")
    assert changed != before
    page.keyboard.press("Control+z")
    assert speed.get_attribute("aria-valuetext") == before
    page.keyboard.press("Control+Shift+z")
    assert speed.get_attribute("aria-valuetext") == changed
    page.keyboard.press("Control+z")
    assert shared.corner(2) == corner

    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_label("Save as").fill("kept")
    page.get_by_role("button", name="Save", exact=True).click()
    page.get_by_role("dialog").wait_for(state="detached")
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_role("button", name="Delete kept").click()
    page.locator(".toast").get_by_role("button", name="Undo").click()
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_role("button", name="Delete kept").wait_for()
    page.keyboard.press("Escape")


def test_a_link_restores_terrain_set_up_and_result_in_a_session_of_its_own(
    shared: Product, second: Product
) -> None:
    product = shared.fresh("curb-015")
    product.drag(2, 0, -12).planned()
    speed = product.page.get_by_role("slider", name="Speed")
    speed.press("PageUp")
    product.planned()
    outcome = product.run()
    second.open(product.linked('"ro":'))
    second.page.locator(f".app[data-run={outcome}]").wait_for(timeout=PATIENCE)
    assert second.corner(2) == product.corner(2)
    second.page.get_by_role("button", name="Reset Speed").wait_for()
    second.page.reload()
    second.planned()
    assert second.corner(2) == product.corner(2)
    # They do not see each other.
    here, there = (each.page.locator("iframe") for each in (product, second))
    here.wait_for()
    there.wait_for()
    assert here.get_attribute("src") != there.get_attribute("src")
    before = second.corner(2)
    product.drag(2, 0, -30).planned()
    assert product.corner(2) != before == second.corner(2)
    product.page.get_by_role("button", name="Reset Speed").click()


@pytest.mark.parametrize(("theme", "width"), [("dark", 1440), ("light", 800)])
def test_axe_finds_nothing_serious(shared: Product, theme: str, width: int) -> None:
    product = shared.fresh("curb-015")
    page = product.page
    page.set_viewport_size({"width": width, "height": 900 if width == 1440 else 768})
    if page.evaluate("document.documentElement.dataset.theme") != theme:
        page.get_by_role("button", name=re.compile("theme")).click()
    try:
        product.run()
        product.vertex(2).focus()
        page.get_by_role("button", name="Download").click()
        assert violations(page) == []
        page.keyboard.press("Escape")
        _infeasible(product)
        assert violations(page) == []
    finally:
        page.set_viewport_size(DESK)


# Whether the middle of an element can be pressed.
UNCOVERED = """selector => {
  const item = document.querySelector(selector);
  const box = item.getBoundingClientRect();
  const x = box.x + box.width / 2;
  return item.contains(document.elementFromPoint(x, box.y + box.height / 2));
}"""


def test_narrow_pages_have_tabs(shared: Product) -> None:
    page = shared.fresh().page
    page.set_viewport_size({"width": 800, "height": 900})
    try:
        tabs = page.get_by_role("navigation", name="Areas")
        editor = page.get_by_role("region", name="Profile editor")
        scene = page.get_by_role("region", name="3-D scene")
        results = page.get_by_role("region", name="Playback and results")
        for name, shown in (("Scene", scene), ("Results", results), ("Profile", editor)):
            tab = tabs.get_by_role("button", name=name)
            tab.press("Enter")
            shown.wait_for()
            assert tab.get_attribute("aria-pressed") == "true"
            assert [each for each in (scene, editor) if each.is_visible()] in ([shown], [])
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        page.get_by_role("button", name=re.compile("^Robot")).click()
        assert page.evaluate(UNCOVERED, ".robots .item:last-child"), "menus are not cut off"
        page.keyboard.press("Escape")
        page.set_viewport_size({"width": 390, "height": 844})
        assert re.search(r"CoM\s+\d+ mm", page.locator(".rows").inner_text()), "units stay"
        page.get_by_role("button", name="Download").click()
        assert page.evaluate(UNCOVERED, ".downloads .item"), "nor on a phone"
        page.keyboard.press("Escape")
        # The page has a name where its logo alone is left of it.
        assert page.get_by_role("heading", name="Stairwright").count() == 1
        # The clock is at hand beside the profile, and wide enough for a finger beside the results.
        timeline = page.get_by_role("slider", name="Time")
        assert timeline.is_visible()
        tabs.get_by_role("button", name="Results").click()
        box = timeline.bounding_box()
        assert box is not None
        assert box["width"] > 300
        tabs.get_by_role("button", name="Profile").click()
    finally:
        page.set_viewport_size(DESK)
