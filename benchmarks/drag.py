"""How long the poses take to follow a dragged corner, in real Chromium on the real server.

    python benchmarks/drag.py [--url URL] [--seconds 6 | --quick] [--scene] [--free] [--json FILE]

Drags the upper corner of the 0.36 m stair and of five stairs at 60 moves a second. Per terrain:
from the pointer's move to the end of the frame that shows its poses (median, 95th percentile), the
frames of the drag (median, 95th percentile, the longest), what a move costs the thread in script,
and the time until the page was interactive. Without `--url` it starts a server of its own. The 3-D
frame is left out unless `--scene` asks for it: without a graphics card it takes a core of its own.
"""

from __future__ import annotations

import argparse
import contextlib
import math
import os
import re
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import httpx
from report import Row, percentile, publish

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

CASES = (("single-stair-036", 2), ("stairs-us-7-11", 6))
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
QUICK = 0.4  # s of a drag that only shows that it can be measured: on one terrain then
RATE = 60.0  # moves a second
REACH = 24.0  # pixels to either side
WATCH = """() => {
  window.frames_ = [];
  let last = performance.now();
  const tick = now => { window.frames_.push(now - last); last = now; requestAnimationFrame(tick); };
  requestAnimationFrame(tick);
}"""
COLLECT = """() => ({
  frames: window.frames_,
  moves: performance.getEntriesByName("stairwright:move").map(m => m.startTime),
  shown: performance.getEntriesByName("stairwright:poses").map(m => [m.startTime, m.detail]),
})"""


def delays(found: dict[str, Any]) -> list[float]:
    """From the last move before each question to the frame that showed its answer [ms]."""
    moves = found["moves"]
    out = []
    for shown, asked in found["shown"]:
        before = [move for move in moves if move <= asked]
        if before:
            out.append(shown - before[-1])
    return out


def drag(page: Page, vertex: int, seconds: float, free: bool) -> dict[str, Any]:
    """Move a corner to and fro along x and z, and return what the page noted meanwhile.

    With Alt held if `free`, so that it keeps to no grid and every move is a new question.
    """
    box = page.locator(f'[data-vertex="{vertex}"] rect').bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    if free:
        page.keyboard.down("Alt")
    page.evaluate(WATCH)
    start = time.perf_counter()
    for i in range(int(seconds * RATE)):
        angle = i / RATE * 2.0
        page.mouse.move(x + REACH * math.sin(angle), y + REACH / 2 * math.sin(0.7 * angle))
        time.sleep(max(0.0, start + (i + 1) / RATE - time.perf_counter()))
    found: dict[str, Any] = page.evaluate(COLLECT)
    page.mouse.up()
    if free:
        page.keyboard.up("Alt")
    return found


def measure(
    browser: Browser, url: str, case: tuple[str, int], seconds: float, scene: bool, free: bool
) -> list[Row]:
    """The figures of one terrain and corner."""
    terrain, vertex = case
    with browser.new_context(
        viewport={"width": 1440, "height": 900},
        bypass_csp=True,  # Playwright waits for functions by `eval`
    ) as context:
        page = context.new_page()
        if not scene:
            page.route("**/scene/**", lambda route: route.fulfill(content_type="text/html"))
        devtools = context.new_cdp_session(page)
        # The thread's own time: what else the machine does is none of the page's.
        devtools.send("Performance.enable", {"timeDomain": "threadTicks"})

        def script() -> float:
            found = devtools.send("Performance.getMetrics")["metrics"]
            return next(1e3 * each["value"] for each in found if each["name"] == "ScriptDuration")

        page.goto(url)
        page.locator("[data-vertex]").first.wait_for()
        ready = page.evaluate("performance.now()")
        page.get_by_role("button", name=re.compile("^Terrain")).click()
        page.locator(".terrains .item", has_text=terrain).first.click()
        page.locator(".app[data-plan=feasible], .app[data-plan=infeasible]").wait_for()
        drag(page, vertex, min(1.0, seconds), free)  # both sides warm
        page.evaluate("performance.clearMarks()")
        before = script()
        found = drag(page, vertex, seconds, free)
        spent = script() - before
    shown, frames = delays(found), found["frames"]
    answers = f"{len(shown)} answers in {seconds:g} s"
    return [
        _row(f"move to poses, {terrain}", shown, answers),
        _row(f"frames of the drag, {terrain}", frames, f"longest {max(frames):.0f} ms"),
        Row(f"script a move, {terrain}", "stairwright", spent / max(1, len(found["moves"]))),
        Row(f"page interactive, {terrain}", "stairwright", ready),
    ]


def _row(work: str, measured: list[float], note: str) -> Row:
    median = statistics.median(measured) if measured else None
    p95 = percentile(measured, 0.95) if measured else None
    return Row(work, "stairwright", median, p95, note=note)


def chromium(named: str | None) -> str | None:
    """Where the browser is: as named, as the environment says, or as it is usually called."""
    return (
        named
        or os.environ.get("STAIRWRIGHT_BROWSER")
        or next(filter(None, map(shutil.which, BROWSERS)), None)
    )


@contextlib.contextmanager
def own_server() -> Iterator[str]:
    """A server with a data folder of its own."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    url = f"http://127.0.0.1:{port}"
    with tempfile.TemporaryDirectory() as data:
        command = [sys.executable, "-m", "stairwright", "serve", "--port", str(port)]
        process = subprocess.Popen(
            command, env=os.environ | {"STAIRWRIGHT_DATA": data}, stdout=subprocess.DEVNULL
        )
        try:
            while process.poll() is None:
                with contextlib.suppress(httpx.TransportError):
                    if httpx.get(f"{url}/api/v1/healthz").is_success:
                        break
                time.sleep(0.2)
            yield url
        finally:
            process.terminate()
            process.wait(15)


def run(
    url: str | None = None,
    seconds: float = 6.0,
    browser: str | None = None,
    scene: bool = False,
    free: bool = False,
) -> list[Row]:
    """All terrains, on the server at `url` or on one of its own."""
    from playwright.sync_api import sync_playwright

    server = contextlib.nullcontext(url) if url else own_server()
    with server as address, sync_playwright() as playwright:
        launched = playwright.chromium.launch(
            executable_path=chromium(browser), args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        cases = CASES if seconds > QUICK else CASES[:1]
        rows = [
            row for case in cases for row in measure(launched, address, case, seconds, scene, free)
        ]
        launched.close()
    return rows


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--url", help="a running server; its own otherwise")
    length = parser.add_mutually_exclusive_group()
    length.add_argument("--seconds", type=float, default=6.0, help="of each drag")
    length.add_argument(
        "--quick", action="store_const", dest="seconds", const=QUICK, help="0.4 s of one terrain"
    )
    parser.add_argument("--scene", action="store_true", help="with the 3-D scene")
    parser.add_argument("--free", action="store_true", help="with Alt held: off the grid")
    parser.add_argument("--browser", help="where Chromium is; searched for otherwise")
    parser.add_argument("--json", help="write machine and rows to this file too")
    arguments = parser.parse_args()
    rows = run(arguments.url, arguments.seconds, arguments.browser, arguments.scene, arguments.free)
    publish(rows, arguments.json)


if __name__ == "__main__":
    main()
