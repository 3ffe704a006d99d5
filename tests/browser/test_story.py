"""The main job from end to end: open, drag, plan, run, see the outcome, download, compare."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import httpx
import pytest

from stairwright.export.table import PLAN_FORMATS, ROLLOUT_FORMATS

from .axe import violations
from .conftest import DESK, PATIENCE

if TYPE_CHECKING:
    from .conftest import Product

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# Notes each time on the slider while a rollout runs.
WATCH = """() => {
  window.seen_ = [];
  const app = document.querySelector(".app");
  const note = () => {
    const time = Number(document.querySelector(".scrub").ariaValueNow);
    const followed = document.querySelector(".tag2")?.innerText.startsWith("rollout");
    if (app.dataset.run === "running" && followed && time !== seen_.at(-1)) seen_.push(time);
  };
  new MutationObserver(note).observe(app, { subtree: true, childList: true, attributes: true });
}"""
OUTCOMES = {"success", "fell", "stuck", "collided", "diverged", "timeout", "stopped"}


def _rows(text: str) -> list[dict[str, str]]:
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return list(csv.DictReader(io.StringIO("\n".join(lines))))


def _download(product: Product, section: str, name: str, folder: Path) -> Path:
    product.page.get_by_role("button", name="Download").click()
    item = product.page.locator(f'.downloads a[href*="/{section}/"]', has_text=name)
    with product.page.expect_download() as waiting:
        item.click()
    # Under a name that people find again.
    assert waiting.value.suggested_filename.startswith("curb-015-a1_wheeled_x-")
    target = folder / f"{section}.{name.lower()}"
    waiting.value.save_as(target)
    return target


@dataclass(frozen=True)
class Story:
    """A page on which a corner was dragged, and the plan was run."""

    product: Product
    corner: tuple[float, float]
    outcome: str


@pytest.fixture(scope="module")
def story(shared: Product) -> Story:
    """Drawn, planned and run once for all tests that look at what came of it."""
    shared.fresh("curb-015")
    before = shared.corner(2)
    shared.drag(2, 0, -12).planned()
    after = shared.corner(2)
    assert after[1] > before[1]
    assert shared.status == "feasible"
    outcome = shared.run()
    assert outcome in OUTCOMES
    assert shared.errors == []
    return Story(shared, after, outcome)


def test_draw_plan_run_and_download(story: Story, server: Any, tmp_path: Path) -> None:
    product, after, outcome = story.product, story.corner, story.outcome
    assert product.page.locator(".res h2").inner_text()
    product.page.get_by_role("slider", name="Time").press("End")

    plan_csv = _download(product, "plans", "CSV", tmp_path)
    link = product.page.locator(".downloads a")
    product.page.get_by_role("button", name="Download").click()
    addresses = link.evaluate_all("links => links.map(link => link.getAttribute('href'))")
    product.page.keyboard.press("Escape")
    plan_id = next(a.split("/")[4] for a in addresses if "/plans/" in a)
    rollout_id = next(a.split("/")[4] for a in addresses if "/rollouts/" in a)

    plan = httpx.get(f"{server.url}/api/v1/plans/{plan_id}").json()
    assert plan["terrain"]["points"][2] == pytest.approx(after, abs=6e-4)
    rows = _rows(plan_csv.read_text())
    assert len(rows) == len(plan["poses"])
    for row, pose in zip(rows, plan["poses"], strict=True):
        assert float(row["x_c_m"]) == pytest.approx(pose["x_c"], abs=1e-6)
        assert float(row["pitch_rad"]) == pytest.approx(pose["pitch"], abs=1e-6)

    rollout = httpx.get(f"{server.url}/api/v1/rollouts/{rollout_id}").json()
    assert rollout["outcome"] == outcome
    series = _rows(_download(product, "rollouts", "CSV", tmp_path).read_text())
    assert len(series) == len(rollout["series"]["time"])
    assert float(series[-1]["time_s"]) == pytest.approx(rollout["series"]["time"][-1], abs=1e-6)
    assert float(series[-1]["pitch_rad"]) == pytest.approx(rollout["series"]["pitch"][-1], abs=1e-6)


def test_every_export_downloads(story: Story, tmp_path: Path) -> None:
    for section, formats in (("plans", PLAN_FORMATS), ("rollouts", ROLLOUT_FORMATS)):
        for name in formats:
            file = _download(story.product, section, name.upper(), tmp_path)
            assert file.stat().st_size > 500, name


def test_results_of_an_edited_profile_are_called_previous(story: Story) -> None:
    product = story.product
    heading = product.page.locator(".res h2")
    assert "seed 0" in heading.inner_text()
    product.vertex(2).focus()
    product.page.keyboard.press("ArrowUp")
    product.planned()
    assert "previous plan" in heading.inner_text()
    product.page.keyboard.press("Control+z")
    product.planned()
    assert "seed 0" in heading.inner_text()


def test_results_of_another_seed_or_controller_are_called_previous(story: Story) -> None:
    product = story.product
    heading = product.page.locator(".res h2")
    inspector = product.page.get_by_role("region", name="Inspector")
    inspector.get_by_role("radio", name="Controller").click()
    seed = inspector.get_by_label("Seed")
    for value, words in (("7", "previous settings"), ("0", "seed 0")):
        seed.fill(value)
        seed.press("Enter")
        heading.get_by_text(words).wait_for()
    lead = inspector.get_by_role("slider", name="Maximum lead")
    lead.press("PageUp")
    heading.get_by_text("previous settings").wait_for()
    inspector.get_by_role("button", name="Reset Maximum lead").click()
    heading.get_by_text("seed 0").wait_for()
    inspector.get_by_role("radio", name="Plan").click()


def test_timeline_moves_robot_and_cursors_together(story: Story) -> None:
    product = story.product
    timeline = product.page.get_by_role("slider", name="Time")
    robot = product.page.locator(".rb.cur").first
    cursor = product.page.locator(".tcur").first
    timeline.press("Home")
    at_start = (robot.inner_html(), cursor.get_attribute("style"))
    timeline.press("PageUp")
    timeline.press("PageUp")
    assert robot.inner_html() != at_start[0]
    assert cursor.get_attribute("style") != at_start[1]
    product.page.keyboard.press("Home")
    product.page.locator("body").press("Space")
    product.page.get_by_role("button", name="Pause").wait_for()
    product.page.wait_for_function(
        "() => Number(document.querySelector('.scrub').ariaValueNow) > 0.2"
    )


def test_a_running_rollout_draws_itself(shared: Product) -> None:
    shared.fresh().draw_flight(2)
    shared.page.evaluate(WATCH)
    assert shared.run() in OUTCOMES
    seen = shared.page.evaluate("window.seen_")
    assert len(seen) >= 2, "stretches of the series while it ran"
    assert seen == sorted(seen)
    # The finished rollout took the place of what it had sent of itself.
    end = float(shared.page.get_by_role("slider", name="Time").get_attribute("aria-valuenow") or 0)
    assert end >= seen[-1] > 0


def test_compare_puts_b_beside_a(shared: Product) -> None:
    product = shared.fresh("curb-015")
    switch = product.page.get_by_role("switch", name="Compare A with B")
    switch.click()
    product.page.locator(".rb.cmp").wait_for()
    product.run()
    product.page.locator(".res thead").get_by_text("B", exact=True).first.wait_for(timeout=PATIENCE)
    assert product.page.locator(".res td.b").count() == product.page.locator(".res td.a").count()
    assert violations(product.page) == []
    # B's pitch is a line of its own, and every plot is there as a table too.
    product.page.get_by_role("button", name="Pitch, nose-up as a table").click()
    product.page.get_by_role("columnheader", name="B actual").wait_for()
    product.page.keyboard.press("Escape")
    # A narrow page tells B's outcome too, and what settings are measured in.
    product.page.set_viewport_size({"width": 800, "height": 900})
    product.page.locator(".insp .un", has_text="m/s").wait_for()
    product.page.get_by_role("button", name="Results", exact=True).click()
    product.page.locator(".res").get_by_text(re.compile("^B: ")).wait_for()
    product.page.set_viewport_size(DESK)
    switch.click()
    product.page.locator(".rb.cmp").wait_for(state="detached")
