"""The page as a user meets it: a tab on the real server, and the words to talk about it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from tests.conftest import TAB

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Locator, Page, ViewportSize

    from tests.conftest import Server

DESK: ViewportSize = {"width": 1440, "height": 900}
PHONE: ViewportSize = {"width": 390, "height": 844}
PLANNED = ".app[data-plan=feasible], .app[data-plan=infeasible]"
TERRAIN = re.compile(r"^Terrain\s")
DROP = """([name, text]) => {
  const transfer = new DataTransfer();
  transfer.items.add(new File([text], name));
  for (const type of ["dragover", "drop"]) {
    document.querySelector(".canvas").dispatchEvent(
      new DragEvent(type, { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }
}"""
PASTE = """text => {
  const data = new DataTransfer();
  data.setData("text/plain", text);
  document.dispatchEvent(
    new ClipboardEvent("paste", { clipboardData: data, bubbles: true }));
}"""
# Whether the state in the address holds a text: the address follows a moment after the page.
LINKED = """text => {
  const state = new URLSearchParams(location.hash.slice(1)).get("s") ?? "";
  return atob(state.replace(/-/g, "+").replace(/_/g, "/")).includes(text);
}"""
PATIENCE = 120_000  # ms; for a rollout or a proof that there is no way, on a busy machine


class Product:
    """The open page."""

    def __init__(self, page: Page, scene: bool = False) -> None:
        self.page = page
        self.errors: list[str] = []
        # Spinners would keep the software renderer busy.
        page.emulate_media(reduced_motion="reduce")
        if not scene:
            # Without a graphics card the 3-D frame takes a core of its own; only tests of the
            # scene let it in. The session behind it is opened and steered all the same.
            page.route(
                "**/scene/**", lambda route: route.fulfill(content_type="text/html", body="")
            )
        page.on("pageerror", lambda error: self.errors.append(str(error)))

    def open(self, address: str = "/") -> Product:
        """Open the page and wait for its first plan."""
        self.page.goto(address)
        return self.planned()

    def planned(self) -> Product:
        """Wait until the shown plan answers what is drawn."""
        # Let a change that was just made reach the page's state first.
        self.page.evaluate("() => new Promise(done => requestAnimationFrame(() => done(0)))")
        self.page.locator(PLANNED).wait_for(timeout=PATIENCE)
        return self

    def fresh(self, terrain: str = "three-stairs-up") -> Product:
        """Back to a preset, without a reload: pages that tests share begin here."""
        self.page.mouse.move(5, 5)
        self.page.keyboard.press("Escape")
        return self.choose_terrain(terrain)

    def paste(self, text: str) -> Product:
        """Paste text where no field has the focus."""
        self.page.evaluate(PASTE, text)
        return self

    def drop(self, name: str, text: str) -> Product:
        """Drop a file on the canvas."""
        self.page.evaluate(DROP, [name, text])
        return self

    def linked(self, text: str) -> str:
        """The address once the state in it holds a text (JSON without spaces)."""
        self.page.wait_for_function(LINKED, arg=text)
        return self.page.url

    def has_corners(self, count: int) -> Product:
        """Wait until so many corners are drawn."""
        self.page.wait_for_function(
            "n => document.querySelectorAll('[data-vertex]').length === n", arg=count
        )
        return self

    def choose_terrain(self, name: str) -> Product:
        """Open a preset or a saved terrain by its name."""
        self.page.get_by_role("button", name=TERRAIN).click()
        panel = self.page.get_by_role("dialog")
        panel.locator(".item", has_text=name).first.click()
        return self.planned()

    def draw_flight(self, steps: int) -> Product:
        """A flight of so many steps, otherwise as the generator offers it."""
        page = self.page
        page.get_by_role("button", name=TERRAIN).click()
        page.get_by_role("button", name="Generate", exact=True).click()
        page.get_by_label("Steps").fill(str(steps))
        page.get_by_role("dialog").get_by_role("button", name="Generate", exact=True).click()
        return self.has_corners(2 * steps + 2).planned()

    @property
    def status(self) -> str:
        """`feasible`, `infeasible`, `planning`, `refused` or `none`."""
        return self.page.locator(".app").get_attribute("data-plan") or ""

    def vertex(self, index: int) -> Locator:
        """The control of one corner."""
        return self.page.locator(f'[data-vertex="{index}"]')

    def corner(self, index: int) -> tuple[float, float]:
        """Where a corner is, as its label tells it [m]."""
        words = (self.vertex(index).get_attribute("aria-label") or "").replace("−", "-")
        x, z = words.split(", x ")[1].removesuffix(" m").split(", z ")
        return float(x), float(z)

    def corners(self) -> int:
        """How many corners are drawn."""
        return self.page.locator("[data-vertex]").count()

    def focused(self) -> int | None:
        """The corner that has the focus."""
        index = self.page.evaluate("document.activeElement?.dataset.vertex")
        return None if index is None else int(index)

    def drag(self, index: int, dx: float, dy: float, steps: int = 8) -> Product:
        """Drag a corner by pixels with the mouse."""
        box = self.vertex(index).locator("rect").bounding_box()
        assert box is not None
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        self.page.mouse.move(x + dx, y + dy, steps=steps)
        self.page.mouse.up()
        return self

    def run(self) -> str:
        """Press Run, wait for the end, and return the outcome."""
        self.page.get_by_role("button", name="Run rollout").click()
        done = ".app:not([data-run=none]):not([data-run=running])"
        self.page.locator(done).wait_for(timeout=PATIENCE)
        outcome = self.page.locator(".app").get_attribute("data-run") or ""
        assert outcome != "failed", self.page.locator(".res").inner_text()
        return outcome


@pytest.fixture
def product(page: Page) -> Iterator[Product]:
    """The page in a tab of its own; an error that nobody caught fails the test."""
    opened = Product(page)
    yield opened
    assert opened.errors == []


@pytest.fixture(scope="module")
def shared(browser: Browser, server: Server) -> Iterator[Product]:
    """One page for a module's tests that do not need a first visit: opening one is dear."""
    with browser.new_context(**TAB, base_url=server.url) as context:
        opened = Product(context.new_page()).open()
        yield opened


@pytest.fixture
def fresh(shared: Product) -> Iterator[Product]:
    """That page, showing three stairs; an error that nobody caught fails the test."""
    shared.errors.clear()
    yield shared.fresh()
    assert shared.errors == []


@pytest.fixture
def offline_live(page: Page) -> Product:
    """The page behind a proxy that knows no WebSockets."""
    page.route_web_socket("**/plans/live", lambda socket: socket.close())
    return Product(page)


@pytest.fixture
def second(browser: Browser, server: Server) -> Iterator[Product]:
    """Another user on another machine."""
    context: BrowserContext
    with browser.new_context(**TAB, base_url=server.url) as context:
        yield Product(context.new_page())
