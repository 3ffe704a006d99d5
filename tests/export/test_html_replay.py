"""The standalone replay in real Chromium, offline: it shows the run and asks for nothing."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from stairwright.export.formats import save
from stairwright.simulation.result import Rollout
from tests.scene.example import example_rollout

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def run() -> Rollout:
    rollout = example_rollout()
    # Text that would end the script or start a tag if it were pasted in unescaped.
    return rollout.model_copy(update={"reason": "</script><img src=x onerror=alert(1)><!--"})


@pytest.fixture(scope="module")
def opened(browser: Browser, run: Rollout, tmp_path_factory) -> Iterator[Page]:
    file = tmp_path_factory.mktemp("replay") / "run.html"
    save(run, file)
    with browser.new_context(
        offline=True,
        viewport={"width": 1200, "height": 800},
        color_scheme="dark",
        reduced_motion="reduce",
    ) as context:
        page = context.new_page()
        page.problems, page.asked = [], []
        page.on("pageerror", lambda error: page.problems.append(str(error)))
        page.on("console", lambda m: page.problems.append(m.text) if m.type == "error" else None)
        page.on("request", lambda request: page.asked.append(request.url))
        page.goto(file.as_uri())
        expect(page.locator("#clock")).to_contain_text(" 0.00 /")
        yield page


@pytest.fixture
def replay(opened: Page) -> Page:
    """The page that these tests share, at the start of the run."""
    opened.evaluate("replay.setTime(0)")
    expect(opened.locator("#clock")).to_contain_text(" 0.00 /")
    return opened


def pixels(page: Page) -> np.ndarray:
    shot = page.locator("#view").screenshot()
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB"), int)


def test_opens_offline_without_any_request_or_error(replay, run):
    assert replay.problems == []
    assert [url for url in replay.asked if not url.startswith("file:")] == []
    assert len(replay.asked) == 1
    assert replay.locator("#outcome").text_content() == "success"
    assert run.terrain_hash in replay.locator("#source").text_content()
    assert replay.locator("img").count() == 0


def test_draws_the_robot_in_its_colours(replay):
    replay.evaluate("replay.setTime(8)")
    expect(replay.locator("#clock")).to_contain_text("8.00 /")
    shot = pixels(replay)
    red, blue = shot[..., 0], shot[..., 2]
    assert ((blue > red + 60) & (blue > 120)).sum() > 300  # front legs
    assert ((red > blue + 60) & (red > 120)).sum() > 300  # rear legs
    assert (np.ptp(shot, axis=2) < 40).sum() > 50_000  # terrain and background


def test_state_is_the_series_at_that_time(replay, run):
    i = 700
    state = replay.evaluate(f"replay.stateAt({float(run.series.time[i])!r})")
    np.testing.assert_allclose(state["position"], run.series.base_position[i], atol=1e-4)
    np.testing.assert_allclose(state["q"], run.series.q[i], atol=1e-3)
    np.testing.assert_allclose(state["turn"], run.series.base_quaternion[i], atol=1e-4)


def test_space_plays_and_the_slider_seeks(replay):
    before = pixels(replay)
    replay.locator("#view").focus()
    replay.keyboard.press("Space")
    expect(replay.locator("#clock")).not_to_contain_text("0.00 /")
    replay.keyboard.press("Space")
    assert replay.locator("#play").text_content() == "Play"
    replay.locator("#time").fill("12")
    expect(replay.locator("#clock")).to_contain_text("12.00 /")
    assert np.abs(pixels(replay) - before).max() > 40


def test_theme_and_cameras_change_the_picture(replay):
    dark = pixels(replay)
    replay.get_by_role("button", name="Switch between light and dark").click()
    expect(replay.locator("html")).to_have_attribute("data-theme", "light")
    replay.wait_for_timeout(100)
    light = pixels(replay)
    assert light.mean() > dark.mean() + 60
    replay.get_by_role("button", name="Side").click()
    replay.wait_for_timeout(100)
    assert np.abs(pixels(replay) - light).max() > 60
    assert replay.problems == []
