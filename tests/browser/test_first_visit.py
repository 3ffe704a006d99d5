"""A first visit: draw, plan, run, understand a refusal; `test_story.py` compares and downloads."""

from __future__ import annotations

import re

import pytest

from .conftest import TERRAIN, Product

pytestmark = [pytest.mark.browser, pytest.mark.slow]


def test_a_first_visit(product: Product) -> None:
    page = product.open().page
    page.get_by_text("Drag a corner: the poses follow.").wait_for()

    # Draw: two steps, click by click on an empty canvas.
    page.get_by_role("button", name=TERRAIN).click()
    page.get_by_role("button", name="New", exact=True).click()
    page.get_by_text("click corner by corner or drag a line").wait_for()
    assert page.locator("[data-dimension]").count() == 0  # of ground that nobody drew
    page.keyboard.press("p")
    box = page.locator(".ed").bounding_box()
    assert box is not None
    for x, y in ((160, 340), (230, 340), (230, 318), (310, 318), (310, 296), (420, 296)):
        page.mouse.click(box["x"] + x, box["y"] + y)
    page.keyboard.press("v")
    product.planned()
    assert product.status == "feasible", page.locator(".pill").inner_text()
    assert page.locator(".hint").count() == 0  # it is known by now

    # Run.
    assert product.run() == "success"
    assert "Success" in page.locator(".res h2").inner_text()

    # Understand a refusal: the riser was made too high, the card says what is missing.
    rise = page.get_by_role("button", name=re.compile(r"^Rise \d")).first
    rise.focus()
    rise.press("Enter")
    page.get_by_label("Rise in metres").fill("2.5")
    page.keyboard.press("Enter")
    product.planned()
    assert product.status == "infeasible"
    card = page.get_by_role("region", name="What stops the robot")
    sentence = card.locator("h4").inner_text()
    assert re.search(r"\d\u00a0m.* x\u00a0=\u00a0-?\d", sentence), sentence  # kept on one line
    card.get_by_role("button", name="Undo edit").click()
    product.planned()
    assert product.status == "feasible"
