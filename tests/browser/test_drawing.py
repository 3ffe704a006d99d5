"""Terrains that are drawn, typed, dropped and saved: pen, hand, table, files, other windows."""

from __future__ import annotations

import itertools
import json
import math
import re
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


def test_what_opens_has_the_focus_before_anybody_can_type(product: Product) -> None:
    """Else what is typed into another field at once ends up in the first one."""
    page = product.page
    focused = page.get_by_role("button", name=TERRAIN).evaluate(
        """async (button) => {
            button.click();
            for (let i = 0; i < 20; i++) await Promise.resolve();  // no frame is drawn meanwhile
            return document.activeElement.matches(".panel input");
        }"""
    )
    assert focused
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


def test_files_are_dropped_and_text_is_pasted(product: Product) -> None:
    text = "x,z\n-1.5,0\n0,0\n0,0.1\n2,0.1\n"
    product.drop("kerb.csv", text).has_corners(4)
    assert product.planned().corner(2) == (0.0, pytest.approx(0.1))
    product.paste(text.replace("0.1", "0.12"))
    product.page.wait_for_function(
        "() => document.querySelector('[data-vertex=\"2\"]').ariaLabel.includes('0.120')"
    )
    product.drop("broken.csv", "a,b\nnot,numbers\n")
    refused = product.page.locator(".import-error")
    refused.wait_for()
    assert product.corners() == 4
    refused.get_by_role("button", name="Dismiss").click()
    points = [[-1.5, 0], [0, 0], [0, 0.1], [0.4, 0.1], [0.4, 0.2], [2, 0.2]]
    product.paste(json.dumps({"points": points})).has_corners(6).planned()
    product.paste("points:\n- [-1.5, 0]\n- [0.6, 0]\n- [1.2, 0.1]\n- [3, 0.1]\nfriction: 0.5\n")
    assert product.has_corners(4).planned().corner(2) == (1.2, pytest.approx(0.1))
    product.paste("kind: stair\nrise: 0.1\nrun: 0.3\ncount: 2\n").has_corners(6).planned()


def test_a_profile_and_a_plan_that_were_downloaded_open_again(product: Product) -> None:
    for name in ("plan.json", "curb-015.json"):
        product.choose_terrain("curb-015").page.get_by_role("button", name="Download").click()
        schema = "plan" if name == "plan.json" else "terrain"
        with product.page.expect_download() as saved:
            product.page.get_by_role("menuitem", name=f"JSON stairwright/{schema}/1").click()
        product.fresh("flat").has_corners(2)
        product.drop(name, saved.value.path().read_text()).has_corners(4).planned()
        assert product.corner(2) == (0.0, pytest.approx(0.15))
    assert saved.value.suggested_filename == "curb-015.json"


def test_a_plan_that_was_made_elsewhere_opens_with_all_that_it_was_asked_with(
    product: Product,
) -> None:
    robot = sw.load_robot("go2w").model_copy(update={"name": "theirs"})
    weights = {"clearance": 3.0}
    plan = sw.plan("curb-015", robot, 0.7, weights=weights, timing="fast", facing="forward")
    product.drop("theirs.json", plan.model_dump_json()).has_corners(4).planned()
    page = product.page
    page.get_by_role("button", name=re.compile(r"^Robot\s+theirs")).wait_for()
    assert page.get_by_label("Friction coefficient").input_value() == "0.70"
    page.get_by_role("radio", name="Fast", checked=True).wait_for()
    assert page.get_by_label("Clearance, value").input_value() == "3.00"
    assert product.status == "feasible"
    page.keyboard.press("Control+z")  # one step
    page.get_by_role("button", name=re.compile(r"^Robot\s+a1_wheeled_x")).wait_for()
    assert page.get_by_label("Clearance, value").input_value() == "1.00"
    product.has_corners(8).planned()
    # Where the service cannot tell the robot, the ground is opened alone.
    product.drop("turned.json", plan.model_copy(update={"facing": "backward"}).model_dump_json())
    page.get_by_text("Only the terrain of turned.json is opened").wait_for()
    product.has_corners(4)


def test_undo_leads_back_past_a_pasted_link_to_terrains_as_they_are_stored(
    product: Product,
) -> None:
    page = product.page
    edited = page.get_by_title("Edited, not saved")
    clearance = page.get_by_label("Clearance, value")
    product.choose_terrain("curb-015")
    clearance.fill("3")
    clearance.press("Enter")
    address = product.planned().linked('"clearance":3')
    product.choose_terrain("flat")
    page.keyboard.press("Control+z")
    product.has_corners(4)
    assert edited.count() == 0
    page.keyboard.press("Control+z")  # the weight
    page.keyboard.press("Control+z")
    product.has_corners(8).planned()
    page.wait_for_function("then => location.href !== then", arg=address)
    page.evaluate("address => { location.href = address; }", address)  # pasted into the open page
    product.has_corners(4).planned()
    assert clearance.input_value() == "3.00"
    page.keyboard.press("Control+z")  # one step
    product.has_corners(8).planned()
    assert clearance.input_value() == "1.00"
    assert edited.count() == 0


def test_thousands_of_corners_are_thinned_and_all_in_reach(product: Product) -> None:
    # The drawing is looked at, not the plan.
    product.page.route(
        "**/plans", lambda route: route.fulfill(status=422, json={"detail": "too steep"})
    )
    try:
        line = [f"{0.002 * i},{0.002 * math.sin(0.1 * i)}" for i in range(1998)]
        product.paste("x,z\n-1.5,0\n" + "\n".join(line) + "\n6,0\n")
        product.page.locator(".app[data-plan=refused]").wait_for()
        product.page.get_by_role("region", name="Not a terrain").get_by_text("too steep").wait_for()
        assert product.page.get_by_role("button", name="Run rollout").is_disabled()
        assert 50 < product.corners() < 400
        product.page.locator("[data-vertex]").nth(20).focus()
        at = product.focused()
        assert at is not None
        for i in range(1, 4):
            product.page.keyboard.press("PageDown")
            assert product.focused() == at + i
        product.page.keyboard.press("Delete")
        assert product.focused() == at + 2
    finally:
        product.page.unroute("**/plans")


def test_a_terrain_is_saved_and_deleted(product: Product) -> None:
    product.drag(6, 0, -20).planned()
    product.page.get_by_role("button", name=TERRAIN).click()
    product.page.get_by_label("Save as").fill("große Treppe")
    product.page.get_by_role("button", name="Save", exact=True).click()
    product.page.get_by_role("button", name=re.compile(r"^Terrain\s+große Treppe")).click()
    product.page.get_by_role("button", name="Delete große Treppe").click()
    product.page.get_by_role("button", name="Delete große Treppe").wait_for(state="detached")
