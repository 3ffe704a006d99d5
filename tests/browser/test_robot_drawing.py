"""The drawing of the workspace Robot: its dimensions are pulled, and lie clear of each other."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations
from typing import Any

import pytest

from tests.robot.importing.files import Design
from tests.robot.importing.written import hinge, link, urdf

from .conftest import DESK, PHONE, Product
from .robot_room import LAPTOP, choose, choose_file, field, pull, robot_room, state

pytestmark = [pytest.mark.browser]


@pytest.fixture
def product(shared: Product) -> Iterator[Product]:
    """The page that these tests share, in Robot, with the A1 as it is stored."""
    with robot_room(shared) as product:
        yield product


def test_a_dimension_is_dragged_as_one_step_and_the_plan_follows(product: Product) -> None:
    page = product.page
    page.evaluate("performance.clearMarks()")
    pull(product, "hips", 20, 0)
    assert state(product) == "edited, 1 number"
    longer = float(field(product, "hips").input_value())
    assert 0.25 < longer < 0.35
    assert round(longer * 1000) == pytest.approx(longer * 1000)
    page.wait_for_function("performance.getEntriesByName('stairwright:poses').length > 0")
    product.planned()
    page.keyboard.press("Control+z")
    assert state(product) == "preset"
    page.keyboard.press("Control+Shift+z")
    assert float(field(product, "hips").input_value()) == longer
    page.get_by_role("button", name="Reset Hip distance").click()
    assert state(product) == "preset"


def test_escape_gives_a_drag_up(product: Product) -> None:
    page = product.page
    box = page.locator('[data-handle="hips"] .grip').bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 3, box["y"] + 3)
    page.mouse.down()
    page.mouse.move(box["x"] + 30, box["y"] + 3, steps=5)
    assert state(product) == "edited, 1 number"
    page.keyboard.press("Escape")
    page.mouse.up()
    assert state(product) == "preset"


def test_keys_change_a_dimension_and_enter_leads_to_its_field(product: Product) -> None:
    page = product.page
    handle = page.locator('[data-handle="front.calf.length"]')
    handle.focus()
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Shift+ArrowUp")
    assert field(product, "front.calf.length").input_value() == "0.211"
    assert handle.get_attribute("aria-valuetext") == "0.211 m"
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.ariaLabel") == "Calf, m"


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


# Small, with knees that bend both ways, and large with short links.
ROBOTS = ("a1_wheeled_x", "m20", "anymal_wheels")


@pytest.mark.parametrize("name", ROBOTS)
def test_dimension_lines_do_not_cross_and_on_a_phone_fingers_can_pull_them(
    product: Product, name: str
) -> None:
    page = product.page
    choose(product, name)
    page.set_viewport_size(PHONE)
    page.wait_for_function("() => document.querySelector('.side-view svg').clientWidth < 400")
    crossed, drawn = page.evaluate(CROSSED), page.evaluate(DRAWN)
    page.set_viewport_size(LAPTOP)
    crossed += page.evaluate(CROSSED)
    for quantity, dx, dy in (("front.thigh.length", -25, 25), ("height", 0, 25)):
        pull(product, quantity, dx, dy)
        crossed += page.evaluate(CROSSED)
    page.set_viewport_size(DESK)
    page.get_by_role("button", name="Reset robot").click()
    assert crossed == []
    _fills_the_width(drawn)


def test_an_arm_and_the_lines_above_it_are_in_the_picture(product: Product) -> None:
    page = product.page
    mast = '<collision><geometry><box size="0.1 0.1 1.4"/></geometry></collision></link>'
    arm = link("arm", 0.5).replace("</link>", mast)
    arm += hinge("arm_joint", "base", "arm", "0 0 0.7", "0 1 0")
    page.set_viewport_size(LAPTOP)
    choose_file(product, "armed.urdf", urdf(Design(), extra=arm))
    page.get_by_role("button", name="Open maker").click()
    product.planned()
    _lie_apart(page.evaluate(DRAWN)["labels"])
    assert page.evaluate("""() => {
      const box = element => element.getBoundingClientRect();
      const view = box(document.querySelector(".side-view"));
      const drawn = [...document.querySelectorAll(".side-view :is(.rb.cur .tr, .plate)")];
      return drawn.length > 5 &&
        drawn.map(box).every(e => e.top >= view.top && e.bottom <= view.bottom);
    }""")
    page.set_viewport_size(DESK)
    page.get_by_role("button", name="Close maker").click()


def _lie_apart(labels: list[dict[str, float]]) -> None:
    for a, b in combinations(labels, 2):
        across = min(a["right"], b["right"]) - max(a["left"], b["left"])
        assert across <= 1 or min(a["bottom"], b["bottom"]) - max(a["top"], b["top"]) <= 3


def _fills_the_width(drawn: dict[str, Any]) -> None:
    """The drawing does; labels and wheels lie apart, and grips are as large as fingertips."""
    view, labels = drawn["view"], drawn["labels"]
    left = min(each["left"] for each in drawn["dimensions"])
    right = max(each["right"] for each in drawn["dimensions"])
    assert right - left > 0.7 * (view["right"] - view["left"])
    assert all(view["left"] <= e["left"] and e["right"] <= view["right"] for e in labels)
    _lie_apart(labels)
    for a in labels:
        for wheel in drawn["wheels"]:
            radius = (wheel["right"] - wheel["left"]) / 2
            x, y = wheel["left"] + radius, wheel["top"] + radius
            beside = max(a["left"] - x, 0, x - a["right"]), max(a["top"] - y, 0, y - a["bottom"])
            assert math.hypot(*beside) > radius - 3, (a, wheel)
    assert len(drawn["grips"]) > 10
    for grip in drawn["grips"]:
        assert min(grip["right"] - grip["left"], grip["bottom"] - grip["top"]) >= 24 - 1e-3
