"""States of the page: first visit, infeasible, running, cancelled, disconnected; sharing."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import httpx
import pytest

from .conftest import PATIENCE, Product

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = [pytest.mark.browser, pytest.mark.slow]

SERIOUS = {"serious", "critical"}
AXE = Path(__file__).parents[2] / "frontend" / "node_modules" / "axe-core" / "axe.min.js"


# Presses Retry now, and tells whether the page asked the service before it did anything else.
ASKS_AT_ONCE = """() => {
  const real = window.fetch;
  let asked = false;
  window.fetch = (address, ...rest) => {
    asked ||= String(address).endsWith("/healthz");
    return real(address, ...rest);
  };
  [...document.querySelectorAll("button")].find(b => b.innerText === "Retry now").click();
  window.fetch = real;
  return asked;
}"""


def _infeasible(product: Product) -> None:
    product.vertex(6).focus()
    field = product.page.get_by_label("z of the corner in metres")
    # In one step: each height on the way would be a question of its own.
    field.fill("1.375")
    field.press("Enter")
    product.planned()
    product.vertex(6).focus()


def test_first_visit_shows_a_solved_sample_and_a_hint(product: Product) -> None:
    product.open()
    assert product.status == "feasible"
    hint = product.page.get_by_text("Drag a corner: the poses follow.")
    hint.wait_for()
    product.page.get_by_role("button", name="Got it").click()
    product.page.reload()
    product.planned()
    assert hint.count() == 0


def test_an_infeasible_profile_says_what_and_where(product: Product) -> None:
    product.open()
    _infeasible(product)
    assert product.status == "infeasible"
    card = product.page.get_by_role("region", name="What stops the robot")
    assert card.locator("h4").inner_text().strip()
    assert product.page.get_by_role("button", name="Run rollout").is_disabled()
    assert product.page.evaluate("document.activeElement.dataset.vertex") == "6"
    card.get_by_role("button", name="Undo edit").click()


def test_running_can_be_cancelled(product: Product) -> None:
    product.open().choose_terrain("stairs-us-7-11")
    # Events that come late keep the run alive for as long as the test needs.
    product.page.route("**/events", lambda route: route.fulfill(status=503))
    product.page.route(
        "**/jobs/*",
        lambda route: (
            route.fulfill(json={"id": "j", "state": "running", "progress": 0.4, "eta": 3.0})
            if route.request.method == "GET"
            else route.continue_()
        ),
    )
    product.page.get_by_role("button", name="Run rollout").click()
    bar = product.page.get_by_role("progressbar", name="Rollout")
    bar.wait_for()
    product.page.get_by_role("button", name="Cancel").click()
    product.page.unroute("**/jobs/*")
    product.page.locator(".app[data-run=cancelled], .app[data-run=success]").wait_for()


def test_link_restores_terrain_set_up_and_result(product: Product, second: Product) -> None:
    product.open()
    product.drag(6, 0, -20).planned()
    product.page.get_by_role("slider", name="Speed").press("PageUp")
    product.planned()
    outcome = product.run()
    product.page.wait_for_timeout(500)
    address = product.page.url
    second.open(address)
    second.page.locator(f".app[data-run={outcome}]").wait_for(timeout=20_000)
    assert second.corner(6) == product.corner(6)
    second.page.get_by_role("button", name="Reset Speed").wait_for()
    second.page.reload()
    second.planned()
    assert second.corner(6) == product.corner(6)


def test_two_sessions_do_not_see_each_other(product: Product, second: Product) -> None:
    product.open()
    second.open()
    product.page.locator("iframe").wait_for()
    second.page.locator("iframe").wait_for()
    here = product.page.locator("iframe").get_attribute("src")
    there = second.page.locator("iframe").get_attribute("src")
    assert here != there
    before = second.corner(6)
    product.drag(6, 0, -30).planned()
    assert second.corner(6) == before


def test_the_scene_draws_and_hides_viser_panel(product_with_scene: Product) -> None:
    product = product_with_scene.open()
    frame = product.page.frame_locator("iframe")
    frame.locator("canvas").first.wait_for(timeout=30_000)
    panel = frame.locator("[data-floating-window]")
    assert panel.count() == 0 or not panel.first.is_visible()


def _serve(port: int, data: Path) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "stairwright", "serve", "--port", str(port)]
    process = subprocess.Popen(
        command,
        env=os.environ | {"STAIRWRIGHT_DATA": str(data)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    for _ in range(1200):
        try:
            if httpx.get(f"http://127.0.0.1:{port}/api/v1/healthz", timeout=5).is_success:
                return process
        except httpx.TransportError:
            time.sleep(0.1)
    pytest.fail("the server did not start")


def _kill(process: subprocess.Popen[bytes]) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def test_a_killed_server_loses_nothing(browser: Browser, tmp_path: Path) -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = int(probe.getsockname()[1])
    process = _serve(port, tmp_path / "data")
    try:
        with browser.new_context(viewport={"width": 1440, "height": 900}) as context:
            product = Product(context.new_page()).open(f"http://127.0.0.1:{port}/")
            scene = product.page.locator("iframe").get_attribute("src")
            _kill(process)
            lost = product.page.get_by_text("Planner lost.", exact=True)
            lost.wait_for(timeout=PATIENCE)
            before = product.corner(6)
            product.drag(6, 0, -20)
            assert product.corner(6) != before
            product.page.get_by_role("alert").get_by_text("Connection").wait_for(state="attached")
            # While the server is away for sure: the page retries by itself once it is back.
            product.page.get_by_role("button", name="Retry now").wait_for()
            assert product.page.evaluate(ASKS_AT_ONCE)
            process = _serve(port, tmp_path / "data")
            lost.wait_for(state="detached", timeout=PATIENCE)
            product.planned()
            product.page.locator(f"iframe:not([src='{scene}'])").wait_for()
            assert product.run() == "success"
    finally:
        _kill(process)


def _violations(page: Page) -> list[dict[str, Any]]:
    page.evaluate(AXE.read_text(encoding="utf-8"))
    # The scene's frame is viser's page, not ours.
    found = page.evaluate("() => axe.run({ exclude: [['iframe']] }, { iframes: false })")
    return [
        {"id": v["id"], "nodes": [(n["html"][:160], n["failureSummary"]) for n in v["nodes"]]}
        for v in found["violations"]
        if v["impact"] in SERIOUS
    ]


@pytest.mark.parametrize(("theme", "width"), [("dark", 1440), ("light", 1024)])
def test_axe_finds_nothing_serious(browser: Browser, server: Any, theme: str, width: int) -> None:
    size = {"width": width, "height": 900 if width == 1440 else 768}
    with browser.new_context(base_url=server.url, viewport=size, color_scheme=theme) as context:  # type: ignore[arg-type]
        product = Product(context.new_page()).open()
        assert _violations(product.page) == []
        product.run()
        product.vertex(6).focus()
        assert _violations(product.page) == []
        product.page.get_by_role("button", name="Download").click()
        assert _violations(product.page) == []
        product.page.keyboard.press("Escape")
        _infeasible(product)
        assert _violations(product.page) == []
