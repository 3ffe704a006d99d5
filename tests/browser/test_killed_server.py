"""A server that is killed while the page is open: nothing is lost."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.conftest import TAB, free_port, serve
from tests.robot.importing.files import Design
from tests.robot.importing.written import urdf

from .conftest import PATIENCE, Product
from .robot_room import choose_file

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.slow]


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


def test_a_killed_server_loses_nothing(browser: Browser, tmp_path: Path) -> None:
    port, data = free_port(), tmp_path / "data"
    with browser.new_context(**TAB) as context:
        with serve(data, port=port) as server:
            product = Product(context.new_page()).open(server.url)
            product.page.keyboard.press("2")
            choose_file(product, "unsaved.urdf", urdf(Design()))
            product.page.get_by_role("button", name="Open maker").click()
            product.planned()
            product.page.keyboard.press("1")
            scene = product.page.locator("iframe").get_attribute("src")
            os.killpg(server.process.pid, signal.SIGKILL)
            server.process.wait()
        lost = product.page.get_by_text("No connection to the planner.", exact=True)
        lost.wait_for(timeout=PATIENCE)
        before = product.corner(6)
        product.drag(6, 0, -20)
        assert product.corner(6) != before
        product.page.get_by_role("alert").get_by_text("Connection").wait_for(state="attached")
        # While the server is away for sure: the page retries by itself once it is back.
        product.page.get_by_role("button", name="Retry now").wait_for()
        assert product.page.evaluate(ASKS_AT_ONCE)
        with serve(data, port=port):
            lost.wait_for(state="detached", timeout=PATIENCE)
            product.planned()
            product.page.locator(f"iframe:not([src='{scene}'])").wait_for()
            assert product.corner(6) != before
            product.linked('"r":"maker","rd":')
            assert product.choose_terrain("flat").status == "feasible"
