"""The scene in the page: it is drawn, and saved as a picture and as a video."""

from __future__ import annotations

import pytest

from .conftest import PATIENCE, Product

pytestmark = [pytest.mark.browser, pytest.mark.slow]


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
