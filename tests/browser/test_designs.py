"""Designs on the Map: the front of a search is drawn and read, and a click opens the robot."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from stairwright.studies import design as designing
from tests.conftest import TAB, serve
from tests.studies.test_design import Rule, _document

from .axe import violations
from .conftest import DESK, PATIENCE, PHONE, Product

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Route

pytestmark = [pytest.mark.browser, pytest.mark.slow]

FAULTS = Path(__file__).with_name("overlap.js").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def product(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Product]:
    """The designs of a service with one finished search."""
    data = tmp_path_factory.mktemp("designs") / "data"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(designing, "choose_engine", lambda *_: Rule())
        patch.setenv("STAIRWRIGHT_DATA", str(data))
        designing.design(_document(name="small motors"))
    with (
        serve(data, STAIRWRIGHT_STUDY_WORKERS="1") as server,
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
    assert violations(page, ".map-room", minor=True) == []


def test_another_file_is_refused_in_words(product: Product, tmp_path: Path) -> None:
    page = product.page
    other = tmp_path / "other.json"
    other.write_text("{}")
    page.get_by_label("Open a result").set_input_files(other)
    page.get_by_text("other.json is no result of a design search").wait_for()
    assert page.locator(".design-front .best").count() > 1


def test_a_new_search_is_asked_watched_paused_and_gone_on_with(product: Product) -> None:
    page = product.page
    refusal = page.locator(".prog-map [role=alert]")
    page.get_by_label("Calf length from").fill("0.3")
    page.get_by_role("button", name="Run", exact=True).click()
    refusal.get_by_text("Calf length: the low end 0.3 must lie below").wait_for()
    page.get_by_label("Calf length from").fill("0.18")
    page.get_by_label("Number of designs").fill("99000")
    page.get_by_role("button", name="Run", exact=True).click()
    refusal.get_by_text("Designs: 99,000 cells are more than the budget").wait_for()
    page.get_by_label("Number of designs").fill("900")
    page.get_by_label("Aim 2").select_option("less duration")
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_text("Design front").get_by_text("less leg torque, less time").wait_for()
    page.get_by_role("button", name="Pause").click()
    page.get_by_text("paused, what was tried stays").wait_for(timeout=PATIENCE)
    page.get_by_role("button", name="Go on").click()
    page.locator(".searches [aria-pressed=true]").get_by_text("at work").wait_for()
    page.locator(".design-front .best").first.wait_for(timeout=PATIENCE)
    page.get_by_text(re.compile("of 900 designs; about .* left")).wait_for(timeout=PATIENCE)
    page.get_by_role("button", name="Pause").click()
    page.get_by_role("button", name="Go on").wait_for()


def test_a_link_shows_the_same_search_with_its_form(product: Product) -> None:
    page = product.page
    page.get_by_label("Number of designs").fill("321")
    page.locator(".searches button", has_text="small motors").first.click()
    page.get_by_text("Design front").get_by_text("small motors").wait_for()
    page.wait_for_function("location.hash.includes('d=')")
    page.wait_for_timeout(400)  # the address follows a form at rest
    address = page.url
    assert page.context.browser is not None
    with page.context.browser.new_context(**TAB) as context:
        other = context.new_page()
        other.goto(address)
        other.get_by_text("Design front").get_by_text("small motors").wait_for()
        assert other.get_by_label("Number of designs").input_value() == "321"
        other.get_by_label("Number of designs").fill("99")
        other.get_by_label("Number of designs").blur()
        other.wait_for_function("a => location.href !== a", arg=address)
        other.evaluate("a => { location.href = a }", address)  # pasted into the open page
        other.wait_for_function(
            "() => document.querySelector('[aria-label=\"Number of designs\"]').value === '321'"
        )


def test_a_search_is_followed_by_its_events(product: Product) -> None:
    """The list is not read meanwhile: what comes, comes by the stream."""
    page = product.page
    page.get_by_label("Number of designs").fill("40")
    page.get_by_role("button", name="Run", exact=True).click()
    tried = page.locator(".searches [aria-pressed=true] small")
    tried.get_by_text("0 of 40 designs").wait_for()
    page.route("**/api/v1/designs", lambda route: route.abort())
    tried.get_by_text(re.compile(r"^[1-9]\d* of 40 designs")).wait_for(timeout=PATIENCE)
    page.unroute("**/api/v1/designs")
    page.get_by_role("button", name="Pause", exact=True).click()
    page.get_by_role("button", name="Go on").wait_for()


def test_a_deleted_search_is_back_after_undo_and_gone_without(product: Product) -> None:
    page = product.page
    row = page.locator(".searches li").filter(has_text="small motors")
    row.locator("button").first.click()
    page.get_by_text("Design front").get_by_text("small motors").wait_for()
    row.get_by_role("button", name="Delete").click()
    row.wait_for(state="detached")
    page.get_by_role("button", name="Undo").last.click()
    row.wait_for()
    page.get_by_text("Design front").get_by_text("small motors").wait_for()
    unwanted = page.locator(".searches li").filter(has_text="of 40 designs")
    with page.expect_response(
        lambda answer: answer.request.method == "DELETE" and "/designs/" in answer.url
    ) as answer:
        unwanted.get_by_role("button", name="Delete").click()
    assert answer.value.status == 204
    unwanted.wait_for(state="detached")


def test_the_form_asks_what_it_shows(product: Product) -> None:
    """A step's height among the aims takes the place of the drawn terrain; nothing is started."""
    page = product.page
    sent: list[dict[str, Any]] = []

    def refuse(route: Route) -> None:
        if route.request.method != "POST":
            route.fallback()
            return
        sent.append(route.request.post_data_json)
        route.fulfill(status=422, json={"errors": [{"field": "aims.2", "message": "no"}]})

    page.get_by_label("Thigh length", exact=False).first.check()
    page.get_by_label("Thigh length to").fill("0.23")
    page.get_by_role("radio", name="Trials").click()
    page.get_by_label("Number of trials").fill("7")
    page.get_by_label("Aim 3").select_option("more step.height")
    page.get_by_text("on one step").wait_for()
    page.route("**/api/v1/designs", refuse)
    page.get_by_role("button", name="Run", exact=True).click()
    page.locator(".prog-map [role=alert]").get_by_text("Aim 3: no").wait_for()
    page.unroute("**/api/v1/designs")
    (document,) = sent
    assert document["ask"]["trials"] == {"count": 7}
    assert "terrain" not in document["ask"]
    assert {"name": "robot.thigh.length", "between": [0.16, 0.23]} in document["vary"]
    assert document["aims"][2] == {
        "maximise": "step.height", "between": [0.1, 1], "tolerance": 0.02
    }  # fmt: skip
