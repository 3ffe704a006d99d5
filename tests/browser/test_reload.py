"""A reload while something runs: the service goes on with it, and so does the page."""

from __future__ import annotations

from typing import TYPE_CHECKING

import httpx
import pytest
from playwright.sync_api import expect

from .conftest import PATIENCE, Product

if TYPE_CHECKING:
    from tests.conftest import Server

pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.fixture(scope="module")
def climb(shared: Product) -> Product:
    """A flight that takes the simulator a second or two."""
    shared.fresh().draw_flight(3)
    shared.linked('"stair-')
    return shared


def test_a_rollout_is_waited_for_after_a_reload(climb: Product) -> None:
    page = climb.page
    with page.expect_response(lambda answer: answer.url.endswith("/api/v1/rollouts")):
        page.get_by_role("button", name="Run rollout").click()
    page.locator(".app[data-run=running]").wait_for()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(f"{request.method} {request.url}"))
    page.reload()
    page.locator(".app[data-run=success]").wait_for(timeout=PATIENCE)
    assert "Success" in page.locator(".res h2").inner_text()
    assert not [each for each in asked if each.startswith("POST") and "/rollouts" in each]
    # Once it has come, there is nothing left to wait for.
    assert page.evaluate("sessionStorage.length") == 0


def test_trials_are_waited_for_after_a_reload_and_can_be_cancelled(
    climb: Product, server: Server
) -> None:
    page = climb.page
    page.get_by_role("radio", name="Trials").click()
    page.get_by_role("radio", name="Field").click()
    page.get_by_label("Number of trials").fill("40")
    with page.expect_response(lambda answer: answer.url.endswith("/api/v1/trials")) as asked:
        page.get_by_role("button", name="Run 40 trials").click()
    job = f"{server.url}/api/v1/jobs/{asked.value.json()['id']}"
    page.get_by_role("progressbar", name="Trials").wait_for()
    page.reload()
    page.get_by_role("progressbar", name="Trials").wait_for()
    assert page.get_by_role("radio", name="Field").is_checked()
    with page.expect_response(lambda answer: answer.request.method == "DELETE"):
        page.get_by_role("button", name="Cancel", exact=True).click()
    expect(page.get_by_role("button", name="Run 40 trials")).to_be_enabled()
    assert page.evaluate("sessionStorage.length") == 0
    assert httpx.get(job).json()["state"] == "cancelled"
