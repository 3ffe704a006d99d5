"""States of the page: first visit, infeasible, running, cancelled, disconnected; sharing."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import httpx
import pytest
from playwright.sync_api import expect

from tests.conftest import TAB

from .conftest import DESK, PATIENCE, TERRAIN, Product

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page, Route

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
    """Too short a start: the answer comes at once."""
    product.vertex(0).focus()
    field = product.page.get_by_label("x of the corner in metres")
    field.fill("-0.1")
    field.press("Enter")
    product.planned()
    product.vertex(0).focus()


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
    assert product.page.evaluate("document.activeElement.dataset.vertex") == "0"
    product.page.get_by_role("button", name="Download").click()
    formats = product.page.locator(".downloads b").all_inner_texts()
    assert "MJCF" in formats
    assert "BUNDLE" not in formats  # for a robot to follow
    product.page.keyboard.press("Escape")
    card.get_by_role("button", name="Undo edit").click()


def test_poses_without_a_motion_between_them_are_not_called_feasible(product: Product) -> None:
    """Going down with both knees back the robot tips between two poses of the paper."""
    product.open()
    product.choose_terrain("three-stairs-up-down")
    product.page.get_by_role("button", name="Robot").click()
    product.page.get_by_role("menuitemradio").first.click()
    product.planned()
    product.page.get_by_role("radio", name="Paper: critical poses").click()
    pill = product.page.get_by_title("only the poses are certified")
    pill.wait_for(timeout=PATIENCE)
    assert "Poses only" in pill.inner_text()
    results = product.page.get_by_role("region", name="Results")
    explained = results.get_by_text("only the poses are certified")
    explained.wait_for()
    product.page.get_by_text("Poses checked, motion between them not").wait_for()
    product.run()
    explained.wait_for()


def test_running_can_be_cancelled(shared: Product, server: Any) -> None:
    product = shared.fresh("ramp-30deg-025")
    held: list[Route] = []
    # The answer to the start is held back, so that the rollout runs until it is cancelled.
    product.page.route("**/rollouts", lambda route: held.append(route))
    # By keyboard: run and cancel take each other's place, and the focus goes along.
    product.page.get_by_role("button", name="Run rollout").press("Enter")
    product.page.get_by_role("progressbar", name="Rollout").wait_for()
    expect(product.page.get_by_role("button", name="Cancel")).to_be_focused()
    product.page.keyboard.press("Enter")
    product.page.locator(".app[data-run=cancelled]").wait_for()
    expect(product.page.get_by_role("button", name="Run rollout")).to_be_focused()
    # The job that was started nevertheless is stopped as soon as its name is known.
    with product.page.expect_response(lambda answer: answer.request.method == "DELETE") as stopped:
        question = held[0].request.post_data_json
        slow = {**question.get("controller", {}), "solver": "clarabel", "sensing": "ideal"}
        # in Python it takes seconds, so that it is not done before it can be stopped
        held[0].continue_(post_data=json.dumps({**question, "controller": slow}))
    product.page.unroute("**/rollouts")
    job = stopped.value.url.removeprefix(server.url)
    assert httpx.get(f"{server.url}{job}").json()["state"] == "cancelled"
    product.page.get_by_text("The rollout was stopped").wait_for()
    assert product.run() == "success"  # and again, to the end


def test_a_cancelled_rollout_leaves_the_plan_on_screen(shared: Product) -> None:
    product = shared.fresh("ramp-30deg-025")
    product.run()
    shown = product.page.locator(".tag2")
    assert shown.inner_text().startswith("rollout")
    product.page.route("**/rollouts", lambda _: None)
    product.page.get_by_role("button", name="Run rollout").click()
    product.page.get_by_role("button", name="Cancel").click()
    product.page.get_by_text("The rollout was stopped").wait_for()
    assert shown.inner_text().startswith("plan")
    product.page.unroute("**/rollouts")


def test_a_and_b_are_one_rollout_to_wait_for_and_to_cancel(shared: Product) -> None:
    product = shared.fresh("ramp-30deg-025")
    page = product.page
    page.get_by_role("switch", name="Compare A with B").click()
    page.locator(".rb.cmp").wait_for()
    started: list[Route] = []

    # A goes on its way; B's start is held back, so that B runs until it is cancelled.
    def start(route: Route) -> None:
        started.append(route)
        if len(started) != 2:
            route.continue_()

    page.route("**/rollouts", start)
    page.get_by_role("button", name="Run rollout").click()
    page.get_by_text("B is running").wait_for(timeout=PATIENCE)
    assert page.get_by_role("progressbar", name="Rollout").is_visible()
    assert page.locator(".app[data-run=running]").count() == 1
    page.get_by_role("button", name="Cancel").click()
    page.get_by_text("B has no rollout").wait_for()
    # A new rollout starts before the old B has answered, which then changes nothing.
    page.get_by_role("button", name="Run rollout").click()
    started[1].continue_()
    page.locator(".res thead").get_by_text("B", exact=True).first.wait_for(timeout=PATIENCE)
    page.locator(".app[data-run=success]").wait_for()
    page.unroute("**/rollouts")
    page.get_by_role("switch", name="Compare A with B").click()


def test_undo_brings_back_settings_and_deleted_terrains(shared: Product) -> None:
    page = shared.fresh("ramp-30deg-025").page
    speed = page.get_by_role("slider", name="Speed")
    before = speed.get_attribute("aria-valuetext")
    corner = shared.corner(2)
    speed.press("PageUp")
    changed = speed.get_attribute("aria-valuetext")
    assert changed != before
    page.keyboard.press("Control+z")
    assert speed.get_attribute("aria-valuetext") == before
    page.keyboard.press("Control+Shift+z")
    assert speed.get_attribute("aria-valuetext") == changed
    page.keyboard.press("Control+z")
    assert shared.corner(2) == corner

    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_label("Save as").fill("kept")
    page.get_by_role("button", name="Save", exact=True).click()
    page.get_by_role("dialog").wait_for(state="detached")
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_role("button", name="Delete kept").click()
    page.locator(".toast").get_by_role("button", name="Undo").click()
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_role("button", name="Delete kept").wait_for()
    page.keyboard.press("Escape")


def test_link_restores_terrain_set_up_and_result(shared: Product, second: Product) -> None:
    product = shared.fresh("ramp-30deg-025")
    product.drag(2, 0, -12).planned()
    speed = product.page.get_by_role("slider", name="Speed")
    speed.press("PageUp")
    product.planned()
    outcome = product.run()
    second.open(product.linked('"ro":'))
    second.page.locator(f".app[data-run={outcome}]").wait_for(timeout=PATIENCE)
    assert second.corner(2) == product.corner(2)
    second.page.get_by_role("button", name="Reset Speed").wait_for()
    second.page.reload()
    second.planned()
    assert second.corner(2) == product.corner(2)
    product.page.get_by_role("button", name="Reset Speed").click()


def test_two_sessions_do_not_see_each_other(shared: Product, second: Product) -> None:
    product = shared.fresh()
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


def test_the_scene_is_saved_as_a_picture(product_with_scene: Product) -> None:
    page = product_with_scene.open().page
    page.frame_locator("iframe").locator("canvas").first.wait_for(timeout=30_000)
    page.keyboard.press("l")
    legend = page.get_by_role("group", name="Shown in the scene")
    with page.expect_request(lambda sent: '"support":false' in (sent.post_data or "")):
        legend.get_by_role("button", name="Support polygon").click()
    with page.expect_download(timeout=60_000) as saved:
        page.get_by_role("button", name="Save the scene as PNG").click()
    assert saved.value.suggested_filename == "three-stairs-up-a1_wheeled_x-scene.png"
    picture = saved.value.path().read_bytes()
    assert picture.startswith(b"\x89PNG")
    assert len(picture) > 20_000


def test_the_replay_is_saved_as_a_video(product_with_scene: Product) -> None:
    page = product_with_scene.open().page
    frame = page.frame_locator(".v3 iframe")
    frame.locator("canvas").first.wait_for(timeout=PATIENCE)
    page.get_by_role("button", name="Record the replay as a video").click()
    page.wait_for_timeout(3000)
    with page.expect_download(timeout=PATIENCE) as saved:
        page.get_by_role("button", name="Stop and save the video").click()
    assert saved.value.suggested_filename == "three-stairs-up-a1_wheeled_x-scene.webm"
    video = saved.value.path().read_bytes()
    assert video.startswith(b"\x1a\x45\xdf\xa3")  # EBML, as WebM begins
    assert b"V_VP" in video[:1000]
    assert len(video) > 10_000
    page.get_by_role("button", name="Record the replay as a video").wait_for()


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


def _violations(page: Page) -> list[dict[str, Any]]:
    page.evaluate(AXE.read_text(encoding="utf-8"))
    # The scene's frame is viser's page, not ours.
    found = page.evaluate("() => axe.run({ exclude: [['iframe']] }, { iframes: false })")
    return [
        {"id": v["id"], "nodes": [(n["html"][:160], n["failureSummary"]) for n in v["nodes"]]}
        for v in found["violations"]
        if v["impact"] in SERIOUS
    ]


@pytest.mark.parametrize(("theme", "width"), [("dark", 1440), ("light", 1024), ("light", 800)])
def test_axe_finds_nothing_serious(shared: Product, theme: str, width: int) -> None:
    product = shared.fresh("ramp-30deg-025")
    page = product.page
    page.set_viewport_size({"width": width, "height": 900 if width == 1440 else 768})
    if page.evaluate("document.documentElement.dataset.theme") != theme:
        page.get_by_role("button", name=re.compile("theme")).click()
    try:
        product.run()
        product.vertex(2).focus()
        page.get_by_role("button", name="Download").click()
        assert _violations(page) == []
        page.keyboard.press("Escape")
        _infeasible(product)
        assert _violations(page) == []
    finally:
        page.set_viewport_size(DESK)


# Whether the middle of an element can be pressed.
UNCOVERED = """selector => {
  const item = document.querySelector(selector);
  const box = item.getBoundingClientRect();
  const x = box.x + box.width / 2;
  return item.contains(document.elementFromPoint(x, box.y + box.height / 2));
}"""


def test_narrow_pages_have_tabs(shared: Product) -> None:
    page = shared.fresh().page
    page.set_viewport_size({"width": 800, "height": 900})
    try:
        tabs = page.get_by_role("navigation", name="Areas")
        editor = page.get_by_role("region", name="Profile editor")
        scene = page.get_by_role("region", name="3-D scene")
        results = page.get_by_role("region", name="Playback and results")
        for name, shown in (("Scene", scene), ("Results", results), ("Profile", editor)):
            tab = tabs.get_by_role("button", name=name)
            tab.press("Enter")
            shown.wait_for()
            assert tab.get_attribute("aria-pressed") == "true"
            assert [each for each in (scene, editor) if each.is_visible()] in ([shown], [])
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        page.get_by_role("button", name=re.compile("^Robot")).click()
        assert page.evaluate(UNCOVERED, ".robots .item:last-child"), "menus are not cut off"
        page.keyboard.press("Escape")
        page.set_viewport_size({"width": 390, "height": 844})
        assert re.search(r"CoM\s+\d+ mm", page.locator(".rows").inner_text()), "units stay"
        page.get_by_role("button", name="Download").click()
        assert page.evaluate(UNCOVERED, ".downloads .item"), "nor on a phone"
        page.keyboard.press("Escape")
        # The page has a name where its logo alone is left of it.
        assert page.get_by_role("heading", name="Stairwright").count() == 1
        # The clock is at hand beside the profile, and wide enough for a finger beside the results.
        timeline = page.get_by_role("slider", name="Time")
        assert timeline.is_visible()
        tabs.get_by_role("button", name="Results").click()
        box = timeline.bounding_box()
        assert box is not None
        assert box["width"] > 300
        tabs.get_by_role("button", name="Profile").click()
    finally:
        page.set_viewport_size(DESK)
