"""A server that is killed while the page is open: nothing is lost."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import httpx
import pytest

from tests.conftest import TAB

from .conftest import PATIENCE, Product

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
        with browser.new_context(**TAB) as context:
            product = Product(context.new_page()).open(f"http://127.0.0.1:{port}/")
            scene = product.page.locator("iframe").get_attribute("src")
            _kill(process)
            lost = product.page.get_by_text("No connection to the planner.", exact=True)
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
