"""The scene in real Chromium: embedded without viser's panel, complete when opened alone."""

from __future__ import annotations

import io
import threading
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np
import pytest
import uvicorn
from fastapi import FastAPI, WebSocket
from fastapi.responses import HTMLResponse
from PIL import Image
from playwright.sync_api import expect

from stairwright.scene import camera as cameras
from stairwright.scene.proxy import proxy_websocket
from stairwright.scene.session import SceneSession
from tests.scene.example import example_plan, example_rollout

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser
PATIENCE = 60_000  # ms


class Site:
    """A server that mounts sessions as the product does, and can be stopped and started again."""

    def __init__(self) -> None:
        self.sessions: dict[str, SceneSession] = {}
        self.port = 0
        self.start()

    def start(self) -> None:
        app = FastAPI()

        @app.get("/scene/{name}/")
        def page(name: str) -> HTMLResponse:
            return HTMLResponse(self.sessions[name].client_html(f"/scene/{name}/"))

        @app.get("/frame/{name}")
        def frame(name: str) -> HTMLResponse:
            source = f"/scene/{name}/?embedded=1"
            return HTMLResponse(
                f'<iframe src="{source}" style="width:400px;height:280px"></iframe>'
            )

        @app.websocket("/scene/{name}")
        async def socket(websocket: WebSocket, name: str) -> None:
            await proxy_websocket(websocket, self.sessions[name].address)

        config = uvicorn.Config(
            app,
            host="127.0.0.1",
            port=self.port,
            log_level="warning",
            ws_per_message_deflate=False,
            timeout_graceful_shutdown=1,
        )
        self._server = uvicorn.Server(config)
        self._thread = threading.Thread(target=self._server.run, daemon=True)
        self._thread.start()
        while not self._server.started:
            self._thread.join(0.02)
        self.port = self._server.servers[0].sockets[0].getsockname()[1]

    def stop(self) -> None:
        self._server.should_exit = True
        self._thread.join(30)

    def open(self, name: str) -> SceneSession:
        self.sessions[name] = SceneSession(name)
        return self.sessions[name]

    def close(self) -> None:
        for session in self.sessions.values():
            session.close()
        self.stop()


@pytest.fixture(scope="module")
def site() -> Iterator[Site]:
    site = Site()
    yield site
    site.close()


@pytest.fixture
def visit(browser: Browser, site: Site) -> Iterator[Callable[[str], Page]]:
    with browser.new_context(
        base_url=f"http://127.0.0.1:{site.port}", viewport={"width": 450, "height": 320}
    ) as context:

        def go(address: str) -> Page:
            page = context.new_page()
            page.problems = []
            page.on("pageerror", lambda error: page.problems.append(str(error)))
            page.on(
                "console",
                lambda m: page.problems.append(m.text) if "Security Policy" in m.text else None,
            )
            page.goto(address)
            return page

        yield go


def pixels(page: Page) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(page.screenshot(timeout=PATIENCE))).convert("RGB"), int)


def legs(shot: np.ndarray) -> tuple[int, int]:
    """How many pixels are front-leg blue and rear-leg orange."""
    red, blue = shot[..., 0], shot[..., 2]
    return int(((blue > red + 45) & (blue > 90)).sum()), int(((red > blue + 45) & (red > 90)).sum())


def wait_until(page: Page, check: Callable[[np.ndarray], bool]) -> np.ndarray:
    for _ in range(PATIENCE // 500):
        shot = pixels(page)
        if check(shot):
            return shot
        page.wait_for_timeout(500)
    pytest.fail("the picture never became what was expected")


def seen(shot: np.ndarray) -> bool:
    return min(legs(shot)) > 300


@pytest.fixture(scope="module")
def plan() -> dict:
    return example_plan(count=40).model_dump(mode="json")


# What of its theme each frame of the document showed.
RECORD_FRAMES = """
window.shown = [];
(function look() {
  const root = document.documentElement;
  if (root) window.shown.push(
    [root.dataset.mantineColorScheme, getComputedStyle(document.body ?? root).opacity]);
  requestAnimationFrame(look);
})();
"""


def test_a_dark_page_never_flashes_light_while_its_scene_loads(site, visit, plan):
    site.open("flash").show(plan=plan, theme="dark")
    page = visit("about:blank")
    page.add_init_script(RECORD_FRAMES)
    page.goto("/scene/flash/?embedded=1&theme=dark")
    wait_until(page, lambda shot: shot[5:40, 5:40].mean() < 60 and seen(shot))
    shown = page.evaluate("shown")
    assert ["light", "0"] in shown
    assert ["light", "1"] not in shown
    assert shown[-1] == ["dark", "1"]


def test_nor_where_it_is_only_displayed_later(site, visit, plan):
    """A phone has the scene behind a tab."""
    site.open("later").show(plan=plan, theme="dark")
    page = visit("about:blank")
    page.add_init_script(RECORD_FRAMES)
    page.clock.install()
    page.goto("/frame/later")
    address = "/scene/later/?embedded=1&theme=dark"
    page.set_content(f'<iframe hidden width="400" height="280" src="{address}"></iframe>')
    frame = page.frames[1]
    frame.wait_for_load_state()
    page.clock.fast_forward(20_000)
    assert frame.evaluate("document.querySelector('canvas[data-engine]')") is None
    page.locator("iframe").evaluate("frame => { frame.hidden = false; }")
    wait_until(page, seen)
    shown = frame.evaluate("shown")
    assert ["light", "1"] not in shown
    assert shown[-1] == ["dark", "1"]


def test_embedded_scene_shows_the_robot_and_no_panel(site, visit, plan):
    site.open("a").show(plan=plan)
    page = visit("/scene/a/?embedded=1&websocket=ws://127.0.0.1:1&playbackPath=x")
    wait_until(page, lambda shot: shot[5:40, 5:40].mean() < 60 and seen(shot))
    expect(page.get_by_text("Tracking")).to_be_hidden()
    assert page.locator(".mantine-Notifications-root:visible").count() == 0
    # Another server's address in the link is neither used nor kept.
    assert "websocket" not in page.url
    assert "playbackPath" not in page.url
    assert page.problems == []
    site.sessions["a"].set_view(theme="light")
    wait_until(page, lambda shot: shot[5:40, 5:40].mean() > 200 and seen(shot))
    # Playback moves the robot along the course.
    before = legs(pixels(page))
    site.sessions["a"].camera("side")
    site.sessions["a"].playback(progress=plan["poses"][-1]["progress"])
    wait_until(page, lambda shot: legs(shot) != before)
    # Another session sees nothing of it.
    site.open("e").show(theme="light")
    other = visit("/scene/e/?embedded=1")
    wait_until(other, lambda shot: shot[5:40, 5:40].mean() > 200 and legs(shot) == (0, 0))
    assert site.sessions["a"].clients == site.sessions["e"].clients == 1


def test_a_frame_without_focus_comes_back_after_the_server_does(site, visit, plan):
    session = site.open("b")
    session.show(plan=plan)
    page = visit("/frame/b")
    wait_until(page, seen)
    assert session.clients == 1
    site.stop()
    for _ in range(100):
        if session.clients == 0:
            break
        page.wait_for_timeout(100)
    assert session.clients == 0
    session.show(plan=plan, theme="light")
    site.start()
    wait_until(page, lambda shot: session.clients == 1 and shot[30:60, 30:60].mean() > 200)


def test_opened_alone_it_has_a_working_panel(site, visit):
    run = example_rollout(example_plan(count=30))
    session = site.open("c")
    session.show(rollout=run.model_dump(mode="json"))
    session.playback(time=1.0)
    page = visit("/scene/c/")
    expect(page.get_by_text("Rollout: success")).to_be_visible(timeout=PATIENCE)
    expect(page.get_by_text("Pitch, nose-up °")).to_be_visible()
    assert page.locator(".uplot:visible").count() == 3
    page.get_by_role("button", name="Play").click()
    for _ in range(PATIENCE // 50):
        if session.player.playing:
            break
        page.wait_for_timeout(50)
    assert session.player.playing
    expect(page.get_by_role("button", name="Pause")).to_be_visible(timeout=PATIENCE)
    session.playback(playing=False)
    page.get_by_text("Layers").click()
    page.get_by_role("checkbox", name="Ghosts").click()
    for _ in range(PATIENCE // 50):
        if not session._stage.layers["ghosts"]:
            break
        page.wait_for_timeout(50)
    assert not session._stage.layers["ghosts"]
    assert page.problems == []


def test_the_camera_follows_the_robot_and_keeps_its_angle_above_the_ground(site, visit, plan):
    session = site.open("f")
    session.show(plan=plan)
    page = visit("/scene/f/?embedded=1")
    wait_until(page, seen)
    (client,) = session._server.get_clients().values()
    view = cameras.view("follow", np.zeros(3))
    offset = view.position - view.look_at
    session.playback(speed=8.0, playing=True)
    end = plan["poses"][-1]["x_c"] + 0.1
    # Of a slow browser reports come late, with where the camera was; then it has to come back.
    rested = 0
    for _ in range(120):
        page.wait_for_timeout(500)
        rested = rested + 1 if abs(client.camera.look_at[0] - end) < 0.01 else 0
        if rested == 2:
            break
    assert rested == 2
    np.testing.assert_allclose(client.camera.position - client.camera.look_at, offset, atol=0.02)
    assert seen(pixels(page))
    # Nor can it stay below the ground.
    height = page.viewport_size["height"]
    middle = page.viewport_size["width"] / 2
    for _ in range(2):  # turned upwards from below, as far as it goes
        page.mouse.move(middle, height * 0.9)
        page.mouse.down()
        page.mouse.move(middle, height * 0.1, steps=4)
        page.mouse.up()
    page.wait_for_timeout(700)
    assert client.camera.position[2] > 0.0
    assert client.camera.position[2] < 0.5  # it was turned down there
