"""The scene in the page: it is drawn, and saved as a picture and as a video."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from tests.conftest import TAB

from .conftest import PATIENCE, Product

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from tests.conftest import Server

pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.fixture(scope="module")
def product(browser: Browser, server: Server) -> Iterator[Product]:
    """The page with its scene, which a small window draws with less work."""
    small = TAB | {"viewport": {"width": 1024, "height": 640}}
    with browser.new_context(**small, base_url=server.url) as context:
        opened = Product(context.new_page(), scene=True).open()
        canvas = opened.page.frame_locator(".v3 iframe").locator("canvas")
        canvas.first.wait_for(state="attached", timeout=PATIENCE)
        yield opened
        assert opened.errors == []


def test_the_scene_is_drawn_without_visers_panel_and_saved_as_a_picture(product: Product) -> None:
    page = product.page
    panel = page.frame_locator("iframe").locator("[data-floating-window]")
    assert panel.count() == 0 or not panel.first.is_visible()
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


def test_the_replay_is_saved_as_a_video(product: Product) -> None:
    page = product.page
    page.get_by_role("button", name="Record the replay as a video").click()
    page.wait_for_timeout(1000)
    with page.expect_download(timeout=PATIENCE) as saved:
        page.get_by_role("button", name="Stop and save the video").click()
    assert saved.value.suggested_filename == "three-stairs-up-a1_wheeled_x-scene.webm"
    video = saved.value.path().read_bytes()
    assert video.startswith(b"\x1a\x45\xdf\xa3")  # EBML, as WebM begins
    assert b"V_VP" in video[:1000]
    assert len(video) > 10_000
    page.get_by_role("button", name="Record the replay as a video").wait_for()
