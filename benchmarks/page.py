"""How soon the page is there for somebody who opens it for the first time, in real Chromium.

    python benchmarks/page.py [--url http://localhost:8000] [--repeat 9 | --quick] [--json FILE]

Opens the page in a browser that has nothing of it yet, on a server that is warm. Per opening:
until something is painted, until the first planned path is on screen, and what came over the wire
until then. Afterwards each workspace is opened for the first time: until it is on screen. The
3-D frame is there, as it is for every visitor. Without `--url` it starts a server of its own.
"""

from __future__ import annotations

import argparse
import contextlib
from typing import TYPE_CHECKING

from drag import chromium, own_server
from report import Row, percentile, publish, row

if TYPE_CHECKING:
    from playwright.sync_api import Browser

PLANNED = ".app[data-plan=feasible], .app[data-plan=infeasible]"
ROOMS = ("robot", "map", "runs")
IDLE = 1500  # ms; a visitor looks at the page before they leave it for another workspace
# The mark is made after the frame that shows an answer; the first may be the paper's poses.
TIMES = """() => new Promise(done => {
  const marks = performance.getEntriesByName("stairwright:poses");
  const painted = performance.getEntriesByName("first-contentful-paint")[0];
  const planned = marks.at(-1)?.startTime;
  const loaded = performance.getEntriesByType("resource")
    .filter(e => e.name.startsWith(location.origin) && e.startTime < planned)
    .filter(e => /[.](js|css)$/.test(e.name));
  done({
    painted: painted.startTime,
    planned,
    wire: loaded.reduce((sum, e) => sum + e.transferSize, 0) / 1000,
    code: loaded.reduce((sum, e) => sum + e.decodedBodySize, 0) / 1000,
  });
})"""
# From the key to the end of the second frame that has the workspace in it.
OPEN = """key => new Promise(done => {
  const begun = performance.now();
  const look = () => document.querySelector(".room:not([hidden]) > main:not(.work)")
    ? requestAnimationFrame(() => setTimeout(() => done(performance.now() - begun)))
    : requestAnimationFrame(look);
  dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  look();
})"""


def visit(browser: Browser, url: str) -> dict[str, float]:
    """One first visit [ms, kB]."""
    with browser.new_context(
        viewport={"width": 1440, "height": 900},
        bypass_csp=True,  # Playwright waits for functions by `eval`
    ) as context:
        page = context.new_page()
        page.goto(url, wait_until="commit")
        page.locator(PLANNED).wait_for()
        page.wait_for_timeout(IDLE)
        found: dict[str, float] = page.evaluate(TIMES)
        for key, room in enumerate(ROOMS, 2):
            found[room] = page.evaluate(OPEN, str(key))
            page.keyboard.press("1")
    return found


def run(url: str | None = None, repeat: int = 9, browser: str | None = None) -> list[Row]:
    """All rows, on the server at `url` or on one of its own."""
    from playwright.sync_api import sync_playwright

    server = contextlib.nullcontext(url) if url else own_server()
    with server as address, sync_playwright() as playwright:
        launched = playwright.chromium.launch(
            executable_path=chromium(browser), args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        visit(launched, address)  # browser and server warm
        visits = [visit(launched, address) for _ in range(repeat)]
        launched.close()

    def each(name: str) -> list[float]:
        return [found[name] for found in visits]

    wire, code = percentile(each("wire"), 0.5), percentile(each("code"), 0.5)
    return [
        row("first paint", "stairwright", each("painted")),
        row("first planned path on screen", "stairwright", each("planned")),
        Row(
            "scripts and styles until then",
            "stairwright",
            wire,
            unit="kB",
            note=f"unpacked {code:.0f} kB",
        ),
        *(row(f"{room} opened for the first time", "stairwright", each(room)) for room in ROOMS),
    ]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--url", help="a running server; its own otherwise")
    count = parser.add_mutually_exclusive_group()
    count.add_argument("--repeat", type=int, default=9, help="visits")
    count.add_argument("--quick", action="store_const", dest="repeat", const=1, help="one visit")
    parser.add_argument("--browser", help="where Chromium is; searched for otherwise")
    parser.add_argument("--json", help="write machine and rows to this file too")
    arguments = parser.parse_args()
    publish(run(arguments.url, arguments.repeat, arguments.browser), arguments.json)


if __name__ == "__main__":
    main()
