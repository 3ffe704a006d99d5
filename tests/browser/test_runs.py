"""Runs: the list of what was planned, rolled out and tried, the overlay, and trials in Plan."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from playwright.sync_api import expect

import stairwright as sw
from stairwright.robot import kinematics
from tests.conftest import TAB, Server, serve

from .axe import violations
from .conftest import DESK, PATIENCE, PHONE, Product
from .robot_room import choose, enter, field, state

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Route

pytestmark = [pytest.mark.browser, pytest.mark.slow]

CURB = {"name": "runs-curb", "points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
OUTSIDE = """() => [...document.querySelectorAll('.runs button, .runs input, .runs b')]
  .filter(e => e.checkVisibility())
  .filter(e => { const r = e.getBoundingClientRect();
                 return r.width && (r.left < -1 || r.right > innerWidth + 1); })
  .map(e => e.outerHTML.slice(0, 80))"""


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server of their own: what other tests pinned would be overlaid, too."""
    with serve(tmp_path_factory.mktemp("runs") / "data") as running:
        yield running


@pytest.fixture(scope="module")
def runs(browser: Browser, server: Server) -> Iterator[Product]:
    """One page with two rollouts to look at, which differ in their friction."""
    with sw.Client(server.url) as service:
        for friction in (0.6, 0.8):
            service.rollout(CURB, friction=friction)
    with browser.new_context(**TAB, base_url=server.url) as context:
        product = Product(context.new_page()).open("/#v=runs")
        product.page.get_by_label("Search names").fill("runs-curb")
        rows = product.page.locator(".run")
        rows.nth(1).wait_for()
        product.page.wait_for_function("document.querySelectorAll('.run').length === 2")
        yield product


def _row(product: Product, friction: str) -> Locator:
    return product.page.locator(".run").filter(has_text=f"μ {friction}")


def test_a_row_tells_what_differs_and_what_came_of_it(runs: Product) -> None:
    row = _row(runs, "0.80")
    words = row.inner_text()
    assert "runs-curb" in words
    assert "Success" in words
    assert " mm" in words
    assert re.search(r"\d J\s+0\.\d\d", words)
    assert row.locator(".thumb .trunk").count() == 1


def test_a_name_and_a_note_survive_a_reload_and_are_found(runs: Product) -> None:
    page = runs.page
    _row(runs, "0.80").get_by_role("button", name="Name, note").click()
    page.get_by_label("Name", exact=True).fill("grippy")
    page.get_by_label("Note", exact=True).fill("runs-curb with new tyres")
    with page.expect_response(lambda answer: answer.request.method == "PATCH"):
        page.get_by_role("button", name="Save", exact=True).click()
    page.reload()
    page.get_by_label("Search names").fill("tyres")
    page.wait_for_function("document.querySelectorAll('.run').length === 1")
    assert "grippy" in page.locator(".run").inner_text()
    page.get_by_label("Search names").fill("runs-curb")
    page.wait_for_function("document.querySelectorAll('.run').length === 2")


def test_deleted_is_back_after_undo(runs: Product) -> None:
    page = runs.page
    _row(runs, "0.60").get_by_role("button", name="Name, note").click()
    page.get_by_role("button", name="Delete", exact=True).click()
    _row(runs, "0.60").wait_for(state="detached")
    page.get_by_role("button", name="Undo").last.click()
    _row(runs, "0.60").wait_for()


def test_two_pinned_runs_lie_over_each_other(runs: Product, tmp_path: Path) -> None:
    page = runs.page
    for friction in ("0.60", "0.80"):
        _row(runs, friction).locator(".run-pin").click()
    page.locator(".ovl-com").nth(1).wait_for(state="attached")
    for title in ("Pitch error", "Peak leg torque"):
        lines = page.get_by_label(title, exact=True).locator("polyline")
        dashes = [line.evaluate("e => getComputedStyle(e).strokeDasharray")
                  for line in lines.all()]  # fmt: skip
        assert len(set(dashes)) == 2, (title, dashes)
    page.get_by_role("button", name="Progress").click()
    assert page.get_by_label("Pitch error", exact=True).locator(".ovl-unit").inner_text() == "%"
    with page.expect_download() as download:
        page.get_by_role("button", name="Download the table").click()
    download.value.save_as(tmp_path / "table.csv")
    table = (tmp_path / "table.csv").read_text().splitlines()
    assert len(table) == 3
    assert "Time [s]" in table[0]


def test_pinned_runs_are_replayed_together_on_one_timeline(runs: Product) -> None:
    page = runs.page
    clock = page.get_by_role("slider", name="Time of the replay")
    ghosts = page.locator(".ovl-ghost")
    assert ghosts.count() == 2
    before = [ghost.locator("polygon").get_attribute("points") for ghost in ghosts.all()]
    clock.press("End")
    after = [ghost.locator("polygon").get_attribute("points") for ghost in ghosts.all()]
    assert all(a != b for a, b in zip(before, after, strict=True))
    clock.press("Home")
    page.get_by_role("button", name="Play together").click()
    page.wait_for_function("document.querySelector('.ovl-clock input').value > 0.3")
    page.get_by_role("button", name="Pause the replay").click()


def test_the_com_path_of_a_run_is_the_run_s(runs: Product, server: Server) -> None:
    """The robot's poses, and not the plan's, give the line: recomputed in Python."""
    points = runs.page.locator('.ovl-com[data-pin="A"]').get_attribute("points") or ""
    drawn = [tuple(map(float, each.split(","))) for each in points.split()]
    with sw.Client(server.url) as service:
        run = service.rollout(CURB, friction=0.6)
    robot = sw.load_robot("a1_wheeled")
    for row, i in ((drawn[0], 0), (drawn[-1], -1)):
        x, _, z = run.series.base_position[i]
        q = np.mean(np.reshape(run.series.q[i], (2, 2, 3))[:, :, :2], axis=1).reshape(4)
        at = np.asarray([float(run.series.pitch[i])])
        frames = kinematics.forward(robot, np.array([x]), np.array([z]), at, q[None])
        com = kinematics.com(robot, np.array([x]), np.array([z]), at, frames)[0]
        assert (row[0], -row[1]) == pytest.approx(tuple(com), abs=2e-3)


def test_nothing_is_out_of_reach(runs: Product) -> None:
    for size in ({"width": 1280, "height": 720}, DESK, PHONE):
        runs.page.set_viewport_size(size)
        assert runs.page.evaluate(OUTSIDE) == [], size
    runs.page.set_viewport_size(DESK)


def test_axe_finds_nothing_serious(runs: Product) -> None:
    page = runs.page
    for _ in range(2):
        assert violations(page) == []
        page.get_by_role("button", name="Light theme").or_(
            page.get_by_role("button", name="Dark theme")
        ).click()


def test_a_run_opens_in_plan_with_its_settings(runs: Product) -> None:
    page = runs.page
    _row(runs, "0.80").locator(".run-open").click()
    page.locator(".app[data-workspace=plan][data-run=success]").wait_for(timeout=PATIENCE)
    runs.planned()
    assert runs.corners() == len(CURB["points"])


def test_the_list_follows_what_is_run_here_and_elsewhere(runs: Product, server: Server) -> None:
    page = runs.page
    page.keyboard.press("4")
    _row(runs, "0.80").wait_for()
    field = page.get_by_label("Friction coefficient")
    field.fill("0.7")
    field.press("Enter")
    runs.planned().run()
    _row(runs, "0.70").wait_for()
    with sw.Client(server.url) as service:
        service.rollout(CURB, friction=0.9)
    page.evaluate("window.dispatchEvent(new Event('focus'))")  # back from another window
    _row(runs, "0.90").wait_for()
    page.keyboard.press("1")


def test_trials_are_run_and_the_worst_replayed(runs: Product) -> None:
    page = runs.page
    page.get_by_role("radio", name="Trials").click()
    page.get_by_role("radio", name="Laboratory").click()
    page.get_by_label("Number of trials").fill("2")

    def nearly_done(route: Route) -> None:
        """The job as it is shortly before its end."""
        job = route.fetch().json()
        if job["state"] == "running":
            job |= {"progress": 0.9, "eta": 0.02}
        route.fulfill(json=job)

    page.route("**/api/v1/jobs/*", nearly_done)
    page.get_by_role("button", name="Run 2 trials").click()
    page.locator(".trials-run").get_by_text("90 %, about 5 s left").wait_for()
    page.unroute("**/api/v1/jobs/*")
    rate = page.locator(".trials-rate")
    rate.wait_for(timeout=PATIENCE)
    assert "/ 2" in rate.inner_text()
    assert "95 % interval" in rate.inner_text()
    with page.expect_request(
        lambda asked: asked.method == "POST" and asked.url.endswith("/rollouts")
    ) as asked:
        page.get_by_role("button", name="Replay the trial").first.click()
    assert asked.value.post_data_json["disturbance"]["delay"] > 0.0
    page.locator(".app[data-run=running]").wait_for(state="detached", timeout=PATIENCE)
    assert runs.errors == []


def test_a_fast_run_opens_with_the_end_that_led(runs: Product, server: Server) -> None:
    """The plan asked for with that end is the one that the planner chose: the run is its own."""
    drop = {"name": "runs-drop", "points": [[-1.2, 0.25], [0, 0.25], [0, 0], [1.2, 0]]}
    with sw.Client(server.url) as service:
        plan = service.plan(drop, "a1_wheeled", timing="fast")
        service.rollout(plan_id=plan.id)
    page = runs.page
    page.goto("/#v=runs")
    page.get_by_label("Search names").fill("runs-drop")
    page.locator(".run").filter(has_text="runs-drop").locator(".run-open").first.click()
    page.locator(".app[data-workspace=plan][data-run=success]").wait_for(timeout=PATIENCE)
    runs.planned()
    settings = page.get_by_role("radiogroup", name="Settings")
    settings.get_by_role("radio", name="Plan").click()
    page.get_by_role("radio", name="Backward", checked=True).wait_for()
    assert page.locator(".pill").get_by_text("backward").count() == 1
    assert "seed 0" in page.locator(".card h2").inner_text()


def test_a_run_opens_with_the_robot_that_it_was_of(runs: Product) -> None:
    """Whatever has become of the robot of that name since."""
    page = runs.page
    page.keyboard.press("2")
    choose(runs, "go2w")
    enter(runs, "front.calf.length", "0.24")
    page.keyboard.press("1")
    assert runs.run() == "success"
    page.keyboard.press("2")
    page.get_by_role("button", name="Reset robot").click()
    runs.planned()
    page.keyboard.press("4")
    page.locator(".run").filter(has_text="go2w").locator(".run-open").click()
    page.locator(".app[data-workspace=plan][data-run=success]").wait_for()
    page.keyboard.press("2")
    expect(field(runs, "front.calf.length")).to_have_value("0.240")
    assert state(runs) == "edited, 1 number"
    page.get_by_role("button", name="Reset robot").click()
    assert state(runs) == "preset"
