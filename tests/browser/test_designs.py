"""Designs on the Map: the front of a search is drawn and read, and a click opens the robot."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from stairwright.studies import design as designing
from tests.conftest import TAB, serve
from tests.studies.test_design import Rule, _document

from .conftest import DESK, PHONE, Product

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.slow]

FAULTS = Path(__file__).with_name("overlap.js").read_text(encoding="utf-8")
AXE = Path(__file__).parents[2] / "frontend" / "node_modules" / "axe-core" / "axe.min.js"


@pytest.fixture(scope="module")
def product(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Product]:
    """The designs of a service with one finished search."""
    data = tmp_path_factory.mktemp("designs") / "data"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(designing, "choose_engine", lambda *_: Rule())
        patch.setenv("STAIRWRIGHT_DATA", str(data))
        designing.design(_document(name="small motors"))
    with (
        serve(data) as server,
        browser.new_context(**TAB, base_url=server.url) as context,
    ):
        opened = Product(context.new_page()).open()
        opened.page.keyboard.press("3")
        opened.page.get_by_role("radio", name="Designs").click()
        opened.page.locator(".design-front .best").first.wait_for()
        yield opened
        assert opened.errors == []


@pytest.fixture(autouse=True)
def room(product: Product) -> None:
    """Each test begins in the room."""
    product.page.keyboard.press("3")
    product.page.locator(".design-front .best").first.wait_for()


def test_arrows_walk_the_front_and_enter_opens_its_robot(product: Product) -> None:
    page = product.page
    best = page.locator(".design-front .best")
    rows = page.get_by_role("table").locator("tbody tr")
    assert best.count() == rows.count() > 1
    best.first.focus()
    page.keyboard.press("ArrowRight")
    number = rows.nth(1).locator("th").inner_text()
    page.get_by_role("heading", name=f"Design {number}", exact=True).wait_for()
    page.keyboard.press("Enter")
    name = f"a1_wheeled design {number}"
    page.locator(".app[data-workspace=robot]").wait_for()
    page.get_by_role("button", name=f"Robot {name}").wait_for()
    product.planned()


def test_a_click_opens_the_robot_with_the_numbers_of_the_design(product: Product) -> None:
    page = product.page
    last = page.get_by_role("table").locator("tbody tr").last
    torque = last.locator("td").first.inner_text().removesuffix(" Nm")
    page.locator(".design-front .best").last.click()
    page.locator(".app[data-workspace=robot]").wait_for()
    shown = page.get_by_label("Leg torque, Nm", exact=True).input_value()
    assert float(shown) == float(torque)


def test_designs_have_no_overlaps_and_axe_finds_nothing(product: Product) -> None:
    page = product.page
    for size in (DESK, {"width": 1280, "height": 720}, PHONE):
        page.set_viewport_size(size)
        page.wait_for_timeout(100)
        assert page.evaluate(FAULTS) == [], size
    page.set_viewport_size(DESK)
    page.add_script_tag(path=AXE)
    found = page.evaluate("() => axe.run('.map-room')")
    assert [each["id"] for each in found["violations"]] == []


def test_another_file_is_refused_in_words(product: Product, tmp_path: Path) -> None:
    page = product.page
    other = tmp_path / "other.json"
    other.write_text("{}")
    page.get_by_label("Open a result").set_input_files(other)
    page.get_by_text("other.json is no result of a design search").wait_for()
    assert page.locator(".design-front .best").count() > 1
