"""What the pages may load: only what came with them, from the service itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Literal
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import expect

from .conftest import PATIENCE, Product

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page, Route, ViewportSize

    from tests.conftest import Server

pytestmark = [pytest.mark.browser, pytest.mark.slow]


class Watched:
    """A tab on a machine without a network, that notes what it is denied."""

    def __init__(self, page: Page, server: Server) -> None:
        self.elsewhere: list[str] = []
        self.denied: list[str] = []
        self.host = urlsplit(server.url).netloc
        page.context.route("**/*", self._only_here)
        page.on(
            "console",
            lambda said: self.denied.append(said.text) if "Security Policy" in said.text else None,
        )

    def _only_here(self, route: Route) -> None:
        if urlsplit(route.request.url).netloc == self.host:
            route.continue_()
        else:
            self.elsewhere.append(route.request.url)
            route.abort()


@pytest.fixture
def strict(browser: Browser, server: Server) -> Iterator[Page]:
    """A tab that keeps to the policy, as every user's does."""
    size: ViewportSize = {"width": 1024, "height": 640}  # draws the scene with less work
    with browser.new_context(base_url=server.url, viewport=size) as context:
        yield context.new_page()


def test_the_api_documents_need_no_network(strict: Page, server: Server) -> None:
    watched = Watched(strict, server)
    strict.goto("/api/v1/docs")
    operation = strict.locator(".opblock", has_text="/api/v1/healthz").first
    operation.click(timeout=PATIENCE)
    operation.get_by_role("button", name="Try it out").click()
    operation.get_by_role("button", name="Execute").click()
    expect(operation.locator(".live-responses-table")).to_contain_text('"ok"', timeout=PATIENCE)
    assert (watched.elsewhere, watched.denied) == ([], [])


def test_the_page_keeps_its_policy_and_its_theme(strict: Page, server: Server) -> None:
    watched = Watched(strict, server)
    product = Product(strict, scene=True).open()
    canvas = strict.frame_locator("iframe").first.locator("canvas").first
    canvas.wait_for(state="attached", timeout=PATIENCE)
    # It has loaded what it needs, and drawing it takes a core.
    strict.locator("iframe").first.evaluate("frame => { frame.style.display = 'none' }")
    product.drag(2, 0, -3).planned()
    product.fresh("curb-015").run()
    assert (watched.elsewhere, watched.denied, product.errors) == ([], [], [])
    themes: tuple[Literal["dark", "light"], ...] = ("dark", "light", "dark")
    for theme in themes:  # the system's, as long as nobody has chosen
        strict.emulate_media(color_scheme=theme)
        strict.locator(f"html[data-theme={theme}]").wait_for(state="attached")
    strict.get_by_role("button", name="Light theme").click()
    strict.emulate_media(color_scheme="light")
    strict.emulate_media(color_scheme="dark")
    strict.reload(wait_until="commit")
    strict.locator("html[data-theme=light]").wait_for(state="attached")
    # A script that got into the page would not run.
    strict.evaluate("""() => {
      const script = document.createElement("script");
      script.textContent = "window.stolen = true";
      document.head.append(script);
    }""")
    assert strict.evaluate("window.stolen") is None
    assert watched.denied
