"""The workspace Robot: reshape one, see the plan follow, keep it, read one from a file."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import stairwright as sw
from stairwright.export.formats import save

from .axe import violations
from .conftest import DESK, PHONE, Product

if TYPE_CHECKING:
    from playwright.sync_api import Locator, ViewportSize

pytestmark = [pytest.mark.browser]

LAPTOP: ViewportSize = {"width": 1280, "height": 720}


@pytest.fixture
def product(shared: Product) -> Iterator[Product]:
    """The page that these tests share, in Robot, with the A1 as it is stored."""
    shared.errors.clear()
    page = shared.page
    shared.fresh()
    page.keyboard.press("2")
    _choose(shared, "a1_wheeled_x")
    reset = page.get_by_role("button", name="Reset robot")
    if reset.is_enabled():
        reset.click()
    yield shared.planned()
    page.keyboard.press("1")
    assert shared.errors == []


def _choose(product: Product, name: str) -> None:
    entries = product.page.locator(".entry > button:first-child")
    entries.filter(has=product.page.get_by_title(name, exact=True)).click()
    product.planned()


def _field(product: Product, quantity: str) -> Locator:
    return product.page.locator(f'[data-quantity="{quantity}"] input')


def _type(product: Product, quantity: str, text: str) -> None:
    field = _field(product, quantity)
    field.fill(text)
    field.press("Enter")
    field.evaluate("e => e.blur()")
    product.planned()


def _state(product: Product) -> str:
    return product.page.locator(".bench h2 small").inner_text()


def _pull(product: Product, quantity: str, dx: float, dy: float) -> None:
    """Drag the grip of a dimension by pixels and let go."""
    box = product.page.locator(f'[data-handle="{quantity}"] .grip').bounding_box()
    assert box is not None
    mouse = product.page.mouse
    mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    mouse.down()
    mouse.move(box["x"] + box["width"] / 2 + dx, box["y"] + box["height"] / 2 + dy, steps=8)
    mouse.up()


def test_a_dimension_is_dragged_as_one_step_and_the_plan_follows(product: Product) -> None:
    page = product.page
    page.evaluate("performance.clearMarks()")
    _pull(product, "hips", 20, 0)
    assert _state(product) == "edited, 1 number"
    longer = float(_field(product, "hips").input_value())
    assert 0.25 < longer < 0.35
    assert round(longer * 1000) == pytest.approx(longer * 1000)
    page.wait_for_function("performance.getEntriesByName('stairwright:poses').length > 0")
    product.planned()
    page.keyboard.press("Control+z")
    assert _state(product) == "preset"
    page.keyboard.press("Control+Shift+z")
    assert float(_field(product, "hips").input_value()) == longer
    page.get_by_role("button", name="Reset Hip distance").click()
    assert _state(product) == "preset"


def test_escape_gives_a_drag_up(product: Product) -> None:
    page = product.page
    box = page.locator('[data-handle="hips"] .grip').bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 3, box["y"] + 3)
    page.mouse.down()
    page.mouse.move(box["x"] + 30, box["y"] + 3, steps=5)
    assert _state(product) == "edited, 1 number"
    page.keyboard.press("Escape")
    page.mouse.up()
    assert _state(product) == "preset"


def test_keys_change_a_dimension_and_enter_leads_to_its_field(product: Product) -> None:
    page = product.page
    handle = page.locator('[data-handle="front.calf.length"]')
    handle.focus()
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Shift+ArrowUp")
    assert _field(product, "front.calf.length").input_value() == "0.211"
    assert handle.get_attribute("aria-valuetext") == "0.211 m"
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.ariaLabel") == "Calf, m"


def test_the_plan_is_of_the_robot_in_hand(product: Product) -> None:
    """A load, a weak motor and a moved mass centre: the planner is asked about all of it."""
    page = product.page
    with page.expect_request(re.compile(r"/api/v1/plans$")) as asked:
        _type(product, "payload.mass", "2.5")
    sent = asked.value.post_data_json["robot"]
    assert sent["payload"]["mass"] == 2.5
    assert sw.Robot.model_validate(sent).mass == pytest.approx(11.84 + 2.5)
    assert page.locator(".number", has_text="Total").locator("output").inner_text() == "14.34"
    with page.expect_request(re.compile(r"/api/v1/plans$")) as asked:
        _type(product, "com.x", "25")
    assert asked.value.post_data_json["robot"]["trunk"]["com"][0] == pytest.approx(0.025)
    assert product.status == "feasible"
    _type(product, "leg.torque", "1.0")
    assert product.status == "infeasible"
    assert "torque" in page.locator(".rivals").first.locator(".facts-line").inner_text()


STEP_UP = """fields => fields.forEach(field => {
  field.focus();
  field.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowUp", bubbles: true }));
})"""


@pytest.mark.slow
def test_every_number_of_every_preset_makes_a_robot_that_the_service_takes(
    product: Product,
) -> None:
    """Each is stepped up once, all together: shapes, moments and heights stay possible."""
    page = product.page
    for name in sw.robots():
        _choose(product, name)
        fields = page.locator(".rows .num")
        fields.evaluate_all(STEP_UP)
        assert int(_state(product).split()[1]) >= fields.count() > 30
        page.evaluate("document.activeElement.blur()")
        product.planned()
        assert product.status in ("feasible", "infeasible"), name
        page.get_by_role("button", name="Reset robot").click()
        product.planned()


def test_a_link_carries_the_edited_robot(product: Product) -> None:
    page = product.page
    _type(product, "front.thigh.length", "0.22")
    address = product.linked('"length":0.22,')
    other = page.context.new_page()
    opened = Product(other)
    opened.open(address)
    assert other.locator('[data-quantity="front.thigh.length"] input').input_value() == "0.220"
    other.close()
    assert opened.errors == []


def test_an_own_robot_is_saved_listed_and_deleted(product: Product) -> None:
    page = product.page
    _type(product, "wheel.radius", "0.06")
    page.get_by_role("button", name="Save as").click()
    page.get_by_role("textbox", name="Save as").fill("my a1")
    page.get_by_role("button", name="Save", exact=True).click()
    page.get_by_role("button", name="Delete my a1").wait_for()
    assert _state(product) == "yours"
    got = page.request.get("/api/v1/robots/my a1").json()
    assert got["wheel"]["radius"] == pytest.approx(0.06)
    page.get_by_role("button", name="Delete my a1").click()
    page.get_by_text("my a1 is deleted.").wait_for()
    assert page.request.get("/api/v1/robots/my a1").status == 404
    page.get_by_role("button", name="Dismiss").click()


@pytest.mark.parametrize("name", ["YAML", "URDF", "MJCF"])
def test_an_edited_robot_is_downloaded(product: Product, name: str, tmp_path: Path) -> None:
    page = product.page
    _type(product, "front.calf.length", "0.215")
    page.get_by_role("button", name="Download robot").click()
    with page.expect_download() as download:
        page.get_by_role("menuitem", name=name).click()
    path = tmp_path / download.value.suggested_filename
    download.value.save_as(path)
    found = sw.load_robot(str(path)) if name == "YAML" else sw.import_robot(path).robot
    assert found.calf.length == pytest.approx(0.215, abs=1e-6)


def test_a_file_is_read_reported_and_opened(product: Product, tmp_path: Path) -> None:
    page = product.page
    path = tmp_path / "theirs.urdf"
    save(sw.load_robot("go2w"), str(path))
    page.get_by_label("Robot file").set_input_files(path)
    report = page.get_by_role("region", name="File")
    report.get_by_text("theirs.urdf read").wait_for()
    assert report.locator("li").count() > 0  # what had to be assumed
    assert _state(product) == "preset"  # nothing changes before it is opened
    report.get_by_role("button", name=re.compile("^Open")).click()
    product.planned()
    assert _state(product) == "not saved"
    assert product.status == "feasible"
    assumed = " ".join(page.locator(".number", has_text="assumed").all_inner_texts())
    for part in ("Thigh rotor", "Wheel rotor", "Standing height"):
        assert part in assumed
    for other in ("torque", "Hip distance"):  # which only reasons of those speak of
        assert other not in assumed
    page.get_by_role("button", name=re.compile("^Close go2w")).click()


def test_a_file_that_does_not_fit_is_refused_with_its_reason(product: Product) -> None:
    page = product.page
    page.get_by_label("Robot file").set_input_files(
        {
            "name": "lamp.urdf",
            "mimeType": "application/xml",
            "buffer": b'<robot name="lamp"><link name="base"/></robot>',
        }
    )
    alert = page.get_by_role("region", name="File").get_by_role("alert")
    alert.wait_for()
    assert "lamp.urdf does not fit" in alert.inner_text()
    assert "file:" not in alert.inner_text()
    page.get_by_role("region", name="File").get_by_role("button", name="Dismiss").click()


def test_two_robots_stand_side_by_side_and_change_places(product: Product) -> None:
    page = product.page
    a, b = page.locator(".rivals").all()
    page.get_by_role("button", name=re.compile("^Robot B")).click()
    page.get_by_role("menuitemradio", name="go2w").click()
    b.locator(".verdict.ok, .verdict.bad").wait_for()
    assert a.locator("h2").inner_text() == "a1_wheeled_x"
    shown = b.get_by_role("img")
    assert (shown.get_attribute("aria-label") or "").startswith("go2w over three-stairs-up")
    page.get_by_role("button", name="Swap A and B").click()
    product.planned()
    assert a.locator("h2").inner_text() == "go2w"
    b.locator(".verdict.ok, .verdict.bad").wait_for()
    page.get_by_role("button", name="Swap A and B").click()


@pytest.mark.parametrize("size", [DESK, LAPTOP, PHONE])
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing(product: Product, theme: str, size: ViewportSize) -> None:
    page = product.page
    page.set_viewport_size(size)
    if page.evaluate("document.documentElement.dataset.theme") != theme:
        page.get_by_role("button", name=re.compile("theme$")).click()
    found = violations(page, ".robot-room", minor=True)
    page.set_viewport_size(DESK)
    assert found == []


@pytest.mark.parametrize("size", [DESK, LAPTOP])
def test_nothing_overflows(product: Product, size: ViewportSize) -> None:
    page = product.page
    page.set_viewport_size(size)
    wide = page.evaluate(
        """() => [...document.querySelectorAll('.robot-room :is(.hd, .rows, .shelf, .entry)')]
            .filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.className)"""
    )
    page.set_viewport_size(DESK)
    assert wide == []


# Of the side view: its width, that of the drawn robot, labels and what fingers can hit.
DRAWN = """() => {
  const box = e => { const b = e.getBoundingClientRect();
    return { left: b.left, top: b.top, right: b.right, bottom: b.bottom }; };
  const all = selector => [...document.querySelectorAll(`.side-view ${selector}`)].map(box);
  return { view: all("svg")[0], wheels: all(".rb .wh"), dimensions: all(".dimension"),
    labels: all(".plate"),
    grips: all(".dimension circle.hit, .dimension rect.hit, .pose-grip .hit") };
}"""


# Where the line of one dimension crosses that of another, or lies under its label.
CROSSED = """() => {
  const lines = [...document.querySelectorAll(".dimension")].map(e => ({
    id: e.dataset.handle, plate: e.querySelector(".plate").getBBox(),
    parts: [".ext", ".measure"].flatMap(c => e.querySelector(c).getAttribute("d").split("M")
      .filter(Boolean).map(d => d.split("L").map(p => p.split(",").map(Number)))) }));
  const side = (a, b, p) => (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
  const crosses = ([a, b], [c, d]) => side(a, b, c) * side(a, b, d) < -1e-6
    && side(c, d, a) * side(c, d, b) < -1e-6;
  const diagonals = ({ x, y, width: w, height: h }) =>
    [[[x, y], [x + w, y + h]], [[x, y + h], [x + w, y]]];
  return lines.flatMap(a => lines.filter(b => b !== a && a.parts.some(p =>
    [...b.parts, ...diagonals(b.plate)].some(q => crosses(p, q)))).map(b => `${a.id} ${b.id}`));
}"""


@pytest.mark.parametrize("name", sw.robots())
def test_dimension_lines_do_not_cross(product: Product, name: str) -> None:
    page = product.page
    _choose(product, name)
    page.set_viewport_size(LAPTOP)
    found = [page.evaluate(CROSSED)]
    for quantity, dx, dy in (("front.thigh.length", -25, 25), ("height", 0, 25)):
        _pull(product, quantity, dx, dy)
        found.append(page.evaluate(CROSSED))
    page.set_viewport_size(PHONE)
    page.wait_for_function("() => document.querySelector('.side-view svg').clientWidth < 400")
    found.append(page.evaluate(CROSSED))
    page.set_viewport_size(DESK)
    page.get_by_role("button", name="Reset robot").click()
    assert found == [[]] * 4


@pytest.mark.parametrize("name", sw.robots())
def test_on_a_phone_the_drawing_fills_the_width_and_fingers_can_pull_it(
    product: Product, name: str
) -> None:
    page = product.page
    _choose(product, name)
    page.set_viewport_size(PHONE)
    page.wait_for_function("() => document.querySelector('.side-view svg').clientWidth < 400")
    drawn = page.evaluate(DRAWN)
    page.set_viewport_size(DESK)
    view, labels = drawn["view"], drawn["labels"]
    left = min(each["left"] for each in drawn["dimensions"])
    right = max(each["right"] for each in drawn["dimensions"])
    assert right - left > 0.7 * (view["right"] - view["left"])
    assert all(view["left"] <= e["left"] and e["right"] <= view["right"] for e in labels)
    for k, a in enumerate(labels):
        for b in labels[k + 1 :]:
            across = min(a["right"], b["right"]) - max(a["left"], b["left"])
            assert across <= 1 or min(a["bottom"], b["bottom"]) - max(a["top"], b["top"]) <= 3
        for wheel in drawn["wheels"]:
            radius = (wheel["right"] - wheel["left"]) / 2
            x, y = wheel["left"] + radius, wheel["top"] + radius
            beside = max(a["left"] - x, 0, x - a["right"]), max(a["top"] - y, 0, y - a["bottom"])
            assert math.hypot(*beside) > radius - 3, (name, a, wheel)
    assert len(drawn["grips"]) > 10
    for grip in drawn["grips"]:
        assert min(grip["right"] - grip["left"], grip["bottom"] - grip["top"]) >= 24 - 1e-3
