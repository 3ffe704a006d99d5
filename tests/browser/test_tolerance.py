"""A tolerance on the page: asked by slider, seen in what the certificate keeps, undone, shared."""

from __future__ import annotations

import re

import pytest

from .conftest import Product

pytestmark = [pytest.mark.browser]


def test_a_tolerance_is_asked_seen_and_shared(shared: Product) -> None:
    product = shared.fresh("curb-015")
    page = product.page
    group = page.get_by_role("region", name="Tolerance")
    kept = group.get_by_label("Least margins within tolerance")
    slider = group.get_by_role("slider", name="Step height ±")
    slider.press("ArrowRight")
    slider.press("ArrowRight")
    product.planned()
    kept.wait_for()
    assert "clearance of the trunk" in kept.inner_text()
    assert slider.get_attribute("aria-valuenow") == "0.001"
    page.wait_for_function("() => location.hash.length > 20")
    page.wait_for_timeout(400)  # until the address has followed
    address = page.evaluate("() => location.hash")
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    product.planned()
    assert kept.count() == 0
    page.wait_for_function("then => location.hash !== then", arg=address)
    page.evaluate("hash => { location.hash = hash; }", address)
    kept.wait_for()
    assert slider.get_attribute("aria-valuenow") == "0.001"
    group.get_by_role("button", name=re.compile("Reset Step height")).click()
    product.planned()
    assert kept.count() == 0
