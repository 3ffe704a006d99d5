"""The Map workspace: cells arrive, are read and opened by pointer and keys, shared and exported."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import httpx
import pytest
from playwright.sync_api import expect

from tests.conftest import TAB, Server, serve

from .axe import violations
from .conftest import PATIENCE, Product
from .robot_room import enter, state

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page, Route

pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server of these tests' own, with one process for studies: it needs no cluster."""
    with serve(tmp_path_factory.mktemp("maps") / "data", STAIRWRIGHT_STUDY_WORKERS="1") as running:
        yield running


@pytest.fixture(scope="module")
def opened(browser: Browser, service: Server) -> Iterator[Product]:
    """The Map with a small study that is done: 2 treads, 3 rises, the highest not possible.

    Of one step, of which it is soon known what is in the way.
    """
    with browser.new_context(**TAB, base_url=service.url) as context:
        product = Product(context.new_page()).open()
        _small_map(product)
        yield product
        assert product.errors == []


@pytest.fixture
def room(opened: Product) -> Product:
    """The Map as a picture, of one robot at the page's friction."""
    page = opened.page
    if page.locator(".app").get_attribute("data-workspace") != "map":
        page.keyboard.press("3")
    table = page.get_by_role("button", name="Table")
    if table.get_attribute("aria-pressed") == "true":
        table.click()
    page.locator("#map-friction").select_option("page")
    page.locator("#map-second").select_option("")
    return opened


def _small_map(product: Product) -> None:
    page = product.page
    page.get_by_role("link", name=re.compile("^Map")).click()
    for label, value in (
        ("Tread from", "0.26"),
        ("Tread to", "0.32"),
        ("Tread, number of values", "2"),
        ("Rise from", "0.15"),
        ("Rise to", "1.05"),
        ("Rise, number of values", "3"),
        ("Number of steps", "1"),
    ):
        page.get_by_label(label, exact=True).fill(value)
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_text("6 of 6 cells; done").wait_for(timeout=PATIENCE)


def _get(service: Server, link: str) -> httpx.Response:
    return httpx.get(service.url + link, timeout=60)


def _newest(service: Server) -> dict[str, Any]:
    newest: dict[str, Any] = _get(service, "/api/v1/studies").json()[0]
    return newest


def _canvas(page: Page) -> Locator:
    return page.get_by_role("application", name=re.compile("^Capability map"))


def test_the_table_says_what_the_service_computed(room: Product, service: Server) -> None:
    page = room.page
    page.get_by_role("button", name="Table").click()
    rows = page.locator(".map-table tbody tr")
    assert [rows.nth(k).locator("th").inner_text() for k in range(3)] == ["1.05", "0.60", "0.15"]
    assert re.fullmatch(r"[\d.]+", rows.nth(2).locator("td").first.inner_text())
    cells = _get(service, _newest(service)["links"]["cells"]).json()
    numbers = page.locator(".map-table td:not(.no)").filter(has_text=re.compile(r"^[\d.]+$"))
    assert numbers.count() == sum(cells["feasible"])
    assert page.locator(".map-table td.no").count() == 6 - sum(cells["feasible"]) > 0


def test_a_card_tells_what_its_cell_is_coloured_by(room: Product) -> None:
    page = room.page
    colour = page.get_by_label("Colour by")
    colour.select_option("duration")
    _canvas(page).focus()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowDown")
    card = page.locator(".map-card")
    assert re.search(r"Time\s+\d+\.\d s", card.inner_text())
    colour.select_option("margin_com")
    assert "Time" not in card.inner_text()


def test_arrows_read_cells_and_space_keeps_one(room: Product) -> None:
    page = room.page
    canvas = _canvas(page)
    canvas.focus()
    for key in ("Escape", "ArrowLeft", "ArrowDown", "ArrowDown", "ArrowLeft"):
        page.keyboard.press(key)
    said = canvas.locator("[aria-live]")
    expect(said).to_have_text(re.compile("^rise 0.15 m, tread 0.26 m: feasible, com margin"))
    page.locator(".map-card").get_by_text("Feasible").wait_for()
    page.keyboard.press("Space")
    kept = page.locator(".kept")
    kept.get_by_text("Torque margin", exact=True).wait_for()
    kept.get_by_text("Energy, planned").wait_for(timeout=PATIENCE)
    assert re.search(
        r"Energy, planned\s+\d+ J\s+Cost of transport, planned\s+0\.\d\d", kept.inner_text()
    )
    page.keyboard.press("ArrowUp")
    page.keyboard.press("ArrowUp")
    expect(said).to_have_text(re.compile("^rise 1.05 m, tread 0.26 m: not possible"))
    page.keyboard.press("Escape")
    assert page.locator(".map-card").count() == 0
    page.get_by_role("button", name="Deselect the cell").click()


def test_codes_tell_the_share_that_is_climbed(room: Product) -> None:
    row = room.page.locator("table.codes tr", has_text="IRC")
    assert row.locator("td").first.inner_text() == "100 %"


def test_a_cell_opens_as_a_plan(room: Product) -> None:
    page = room.page
    box = _canvas(page).bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] - 130)
    page.locator(".app[data-workspace=plan]").wait_for()
    room.planned()
    assert room.status == "feasible"
    assert room.corners() == 4  # one step
    title = page.get_by_role("button", name=re.compile(r"^Terrain\s")).inner_text()
    assert re.search(r"tread 0\.(26|32) m rise 0\.15 m", title)
    page.keyboard.press("2")
    assert state(room) == "preset"  # the stored one, and no copy of it
    page.keyboard.press("3")
    _canvas(page).wait_for()


def test_a_cell_opens_with_all_that_it_was_asked_with(room: Product, service: Server) -> None:
    """Timing, facing and tolerance are the map's, whatever the page was set to meanwhile."""
    page = room.page
    study = _newest(service)["id"]
    settings = {"timing": "fast", "facing": "backward", "tolerance": {"height": 0.002}}

    def asked(route: Route) -> None:
        cell = route.fetch().json()
        cell["plan"] |= settings
        route.fulfill(json=cell)

    page.route(f"**/api/v1/studies/{study}/cells/*", asked)
    box = _canvas(page).bounding_box()
    assert box is not None
    with page.expect_request(lambda sent: sent.url.endswith("/plans")) as plan:
        page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] - 130)
    assert {name: plan.value.post_data_json.get(name) for name in settings} == settings
    page.unroute(f"**/api/v1/studies/{study}/cells/*")
    page.locator(".app[data-workspace=plan]").wait_for()
    page.keyboard.press("Control+z")
    room.planned()
    page.keyboard.press("3")
    _canvas(page).wait_for()


def test_pictures_and_data_can_be_taken_along(room: Product) -> None:
    page = room.page

    def taken(name: str) -> bytes:
        page.get_by_role("button", name="Export").click()
        with page.expect_download() as download:
            page.get_by_role("menuitem", name=re.compile(f"^{name}")).click()
        return Path(download.value.path()).read_bytes()

    svg = taken("SVG").decode()
    assert "url(#hatch)" in svg
    assert "Tread, m" in svg
    assert taken("PNG").startswith(b"\x89PNG")
    assert len(taken("CSV").decode().splitlines()) == 7
    assert taken("NetCDF")[:4] in (b"\x89HDF", b"CDF\x01", b"CDF\x02")


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_nothing_is_inaccessible(room: Product, theme: str) -> None:
    page = room.page
    page.evaluate("theme => { document.documentElement.dataset.theme = theme }", theme)
    assert violations(page, ".map-room") == []


def test_the_link_shows_the_same_map(room: Product, browser: Browser, service: Server) -> None:
    page = room.page
    page.wait_for_function("location.hash.includes('m=')")
    with browser.new_context(**TAB, base_url=service.url) as context:
        other = Product(context.new_page())
        other.page.goto(page.url)
        other.page.get_by_text("6 of 6 cells; done").wait_for(timeout=PATIENCE)
        assert other.page.get_by_label("Rise to", exact=True).input_value() == "1.05"
        assert other.errors == []


def test_the_least_friction_is_found_by_bisection(room: Product, service: Server) -> None:
    page = room.page
    page.get_by_label("Rise to", exact=True).fill("0.45")
    page.get_by_label("Rise, number of values", exact=True).fill("2")
    page.locator("#map-friction").select_option("least")
    with page.expect_response(lambda answer: answer.request.method == "POST") as started:
        page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_text("6 of 6 cells; done").wait_for(state="detached")
    assert started.value.status == 202
    page.get_by_text(re.compile("cells; done")).wait_for(timeout=PATIENCE)
    page.get_by_role("button", name="Table").click()
    shown = page.locator(".map-table td button").all_inner_texts()
    link = f"{_newest(service)['links']['export']}?format=csv"
    rows = list(csv.DictReader(_get(service, link).text.splitlines()))
    truth = [f"{float(row['boundary']):.2f}" for row in rows if row["boundary"]]
    assert truth
    assert sorted(word for word in shown if word[0].isdigit()) == sorted(truth)


def test_two_robots_share_a_scale_and_a_pointer(room: Product) -> None:
    page = room.page
    page.locator("#map-second").select_option("go2w")
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_text("8 of 8 cells; done").wait_for(timeout=PATIENCE)
    canvas = _canvas(page)
    canvas.focus()
    page.keyboard.press("ArrowRight")
    assert page.locator(".map-mark.cur").count() == 2
    page.get_by_role("radio", name="Difference").click()
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Table").click()
    page.locator("caption", has_text="go2w minus").wait_for()


def test_an_edited_robot_beside_another_and_beside_itself(room: Product, service: Server) -> None:
    page = room.page
    page.keyboard.press("2")
    enter(room, "front.calf.length", "0.25")
    page.keyboard.press("3")
    own = page.locator("#map-second option", has_text="as stored").get_attribute("value")
    for second, pair in (("go2w", f"{own} and go2w"), (own, f"{own} edited and {own}")):
        page.locator("#map-second").select_option(second)
        with page.expect_response(lambda answer: answer.url.endswith("/studies")) as posted:
            page.get_by_role("button", name="Run", exact=True).click()
        page.get_by_text(f"{pair}, μ").wait_for()
        page.get_by_text("8 of 8 cells; done").wait_for(timeout=PATIENCE)
        asked = _get(service, posted.value.json()["links"]["self"] + "/document").json()
        lengths = {name: robot["calf"]["length"] for name, robot in asked["robots"].items()}
        assert lengths[pair.split(" and ")[0]] == 0.25
        assert all(length != 0.25 for name, length in lengths.items() if name == second)
    page.keyboard.press("2")
    page.get_by_role("button", name="Reset robot").click()
    page.keyboard.press("3")
    assert page.locator("#map-second").input_value() == ""


def test_paused_and_gone_on_with(room: Product) -> None:
    page = room.page
    page.get_by_label("Tread, number of values", exact=True).fill("40")
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_role("button", name="Pause").click()
    page.get_by_text("paused, what was computed stays").wait_for(timeout=PATIENCE)
    page.get_by_role("button", name="Go on").click()
    page.get_by_role("button", name="Pause").wait_for(timeout=PATIENCE)
    page.get_by_role("button", name="Pause").click()
    page.get_by_role("button", name="Go on").wait_for(timeout=PATIENCE)
    assert page.locator(".prog-map .error").count() == 0


def test_a_deleted_map_is_back_after_undo_and_gone_without(room: Product) -> None:
    page = room.page
    delete = page.get_by_role("button", name="Delete this map")
    delete.click()
    page.get_by_role("heading", name="How far can it go?").wait_for()
    page.get_by_role("button", name="Undo").last.click()
    page.get_by_role("button", name="Go on").wait_for()
    earlier, maps = page.get_by_role("button", name="Earlier"), page.get_by_role("menuitem")
    earlier.click()
    count = maps.count()
    page.keyboard.press("Escape")
    lists: list[Route] = []
    page.route("**/studies?*", lambda route: lists.append(route))
    with page.expect_response(
        lambda answer: answer.request.method == "DELETE" and "/studies/" in answer.url
    ) as answer:
        delete.click()
    assert answer.value.status == 204
    # Also while the list without it is still on its way.
    earlier.click()
    maps.first.wait_for()
    assert maps.count() == count - 1
    page.unroute("**/studies?*")
    for each in lists:
        each.continue_()
    maps.first.click()
    page.get_by_role("button", name="Table").wait_for()


def test_without_the_packages_it_says_so(room: Product) -> None:
    page = room.page
    answer = {"title": "Not there", "detail": "studies need: pip install 'stairwright[studies]'"}
    page.route("**/studies", lambda route: route.fulfill(status=501, json=answer))
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_text("This service cannot compute maps.").wait_for()
    page.get_by_text("pip install 'stairwright[studies]'").wait_for()
    page.unroute("**/studies")
