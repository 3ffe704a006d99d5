"""Plots on their own and as files; what changed weights bring."""

from __future__ import annotations

import csv
import re

import pytest

from .conftest import DESK, Product

pytestmark = [pytest.mark.browser]


@pytest.fixture
def product(fresh: Product) -> Product:
    """The page that these tests share, showing three stairs."""
    return fresh


def test_a_plot_can_have_the_row_to_itself(product: Product) -> None:
    page = product.page
    plots = page.locator(".plot")
    count = plots.count()
    assert count > 2
    page.get_by_role("region", name="Thigh").hover()
    page.get_by_role("button", name="Maximise Thigh").click()
    page.wait_for_function("() => document.querySelectorAll('.plot').length === 1")
    page.keyboard.press("Escape")
    page.wait_for_function(f"() => document.querySelectorAll('.plot').length === {count}")


def test_plots_without_room_are_one_step_aside(product: Product) -> None:
    page = product.page
    page.set_viewport_size({"width": 1280, "height": 720})
    titles = page.locator(".plot h3")
    page.get_by_role("button", name="Show Peak torque, Margins").click()
    page.get_by_role("region", name="Peak torque").wait_for()
    assert "Pitch" not in titles.first.inner_text()
    page.get_by_role("button", name=re.compile("^Show Pitch")).click()
    page.get_by_role("region", name="Pitch").wait_for()
    page.set_viewport_size({"width": 1920, "height": 1080})
    page.wait_for_function("() => document.querySelectorAll('.plot').length === 5")
    assert page.get_by_role("navigation", name="More plots").count() == 0
    page.set_viewport_size(DESK)


def test_a_plot_is_saved_under_terrain_and_robot(product: Product) -> None:
    page = product.page
    page.get_by_role("region", name="Thigh").hover()
    content = {}
    for form in ("PNG", "SVG", "CSV"):
        page.get_by_role("button", name="Save Thigh").click()
        with page.expect_download() as saved:
            page.get_by_role("menuitem", name=form).click()
        named = f"three-stairs-up-a1_wheeled_x-thigh.{form.lower()}"
        assert saved.value.suggested_filename == named
        content[form] = saved.value.path().read_bytes()
    assert content["PNG"].startswith(b"\x89PNG")
    assert len(content["PNG"]) > 5000
    assert content["SVG"].startswith(b"<svg")
    assert content["SVG"].count(b"<path") > 4
    rows = list(csv.DictReader(content["CSV"].decode().splitlines()))
    assert len(rows) > 50
    assert float(rows[-1]["time_s"]) > 5
    assert -180 < float(rows[3]["front desired [°]"]) < 180


def test_a_changed_weight_says_what_it_brings(product: Product) -> None:
    page = product.page
    slider = page.get_by_role("slider", name="CoM margin")
    slider.press("End")
    product.planned()
    effect = page.get_by_role("region", name="Effect of the weights")
    effect.wait_for()
    rows = effect.get_by_role("row").all_inner_texts()
    assert [r.split("\t")[0] for r in rows[1:]] == [
        "CoM margin",
        "Clearance",
        "Friction needed",
        "Static torque",
        "Time",
        "Energy",
        "Cost of transport",
    ]
    before, now = rows[1].split("\t")[1:]
    assert int(now.split()[0]) >= int(before.split()[0])
    path = page.locator(".default-path")
    assert path.count() == 1
    ghost = page.get_by_role("switch", name="Draw the default path dashed")
    ghost.click()
    path.wait_for(state="detached")
    ghost.click()
    page.get_by_role("button", name="Reset CoM margin").click()
    effect.wait_for(state="detached")


def test_a_weight_that_has_no_say_brings_nothing(product: Product) -> None:
    """The speed of steady plans: fast ones are asked and told without it, and it comes back."""
    page = product.page
    page.get_by_role("slider", name="Speed").press("PageUp")
    effect = page.get_by_role("region", name="Effect of the weights")
    effect.wait_for()
    with page.expect_request(
        lambda sent: sent.url.endswith("/plans") and "fast" in (sent.post_data or "")
    ) as asked:
        page.get_by_role("radio", name="Fast").click()
    assert "weights" not in asked.value.post_data_json
    product.planned()
    assert effect.count() == 0
    page.get_by_role("radio", name="Steady").click()
    product.planned()
    effect.wait_for()
    page.get_by_role("button", name="Reset Speed").click()
    effect.wait_for(state="detached")


def test_each_motor_limit_is_drawn_and_named(product: Product) -> None:
    page = product.page
    product.choose_terrain("curb-015")
    page.get_by_role("button", name="Robot", exact=False).first.click()
    page.get_by_role("menuitemradio", name="b2w").click()
    product.planned().run()
    page.get_by_role("region", name="Peak torque").hover()
    saved = {}
    for form in ("SVG", "CSV"):
        page.get_by_role("button", name="Save Peak torque").click()
        with page.expect_download() as download:
            page.get_by_role("menuitem", name=form).click()
        saved[form] = download.value.path().read_text()
    limits = {"thigh": 200.0, "calf": 320.0, "wheel": 20.0}
    for name, limit in limits.items():
        assert f"{name} limit {limit:.1f}" in saved["SVG"]
    row = next(csv.DictReader(saved["CSV"].splitlines()))
    assert {name: float(row[f"{name} limit [Nm]"]) for name in limits} == limits
