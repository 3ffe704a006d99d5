"""Rollouts that are cancelled: the focus stays, the job stops, the plan comes back."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import httpx
import pytest
from playwright.sync_api import expect

from .conftest import PATIENCE, Product

if TYPE_CHECKING:
    from playwright.sync_api import Route

pytestmark = [pytest.mark.browser, pytest.mark.slow]


def test_running_can_be_cancelled(shared: Product, server: Any) -> None:
    product = shared.fresh("curb-015")
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
    product = shared.fresh("curb-015")
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
    product = shared.fresh("curb-015")
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
