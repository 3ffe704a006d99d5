"""What the page tells of a plan, and what a rollout is asked with: keys, poses, speed, settings."""

from __future__ import annotations

import itertools
import json
import re
from typing import TYPE_CHECKING, Any

import pytest

from stairwright.terrain.stairs import stair

from .axe import violations
from .conftest import Product

if TYPE_CHECKING:
    from playwright.sync_api import Page, Route


pytestmark = [pytest.mark.browser]


@pytest.fixture
def product(fresh: Product) -> Product:
    """The page that these tests share, showing three stairs."""
    return fresh


def _asked_to_run(product: Product) -> dict[str, Any]:
    """The disturbance that a rollout is asked with, which is then not carried out."""
    page = product.page
    sent: list[dict[str, Any]] = []

    def refuse(route: Route) -> None:
        sent.append(route.request.post_data_json)
        route.fulfill(status=422, json={"detail": "not today"})

    page.route("**/rollouts", refuse)
    page.get_by_role("button", name="Run rollout").click()
    page.locator(".app[data-run=failed]").wait_for()
    page.unroute("**/rollouts")
    disturbance: dict[str, Any] = sent[0]["disturbance"]
    return disturbance


def _choose_robot(page: Page, name: str) -> None:
    page.get_by_role("button", name=re.compile("^Robot")).first.click()
    page.get_by_role("menuitemradio", name=re.compile(rf"^{name}\b")).click()


def test_question_mark_lists_the_keys(product: Product) -> None:
    product.page.keyboard.press("?")
    sheet = product.page.get_by_role("dialog", name="Keys")
    sheet.get_by_text("swap profile and scene").wait_for()
    product.page.keyboard.press("Escape")
    sheet.wait_for(state="detached")


def test_skip_links_and_one_stop_for_a_toolbar(product: Product) -> None:
    page = product.page
    page.evaluate("document.activeElement.blur()")
    page.get_by_role("button", name="Skip to the profile").focus()
    page.keyboard.press("Enter")
    assert product.focused() == 0
    # Corners are one stop of the Tab key, dimensions another; keys walk through each.
    stops = "all => all.filter(g => g.tabIndex >= 0).length"
    for kind in ("[data-vertex]", "[data-dimension]"):
        assert page.locator(kind).evaluate_all(stops) == 1, kind
    page.keyboard.press("End")
    assert product.focused() == product.corners() - 1
    page.keyboard.press("PageUp")
    assert product.focused() == product.corners() - 2
    assert page.locator("[data-vertex]").evaluate_all(stops) == 1
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.dataset.vertex") is None
    bar = page.get_by_role("toolbar", name="Profile tools")
    # Which buttons can be pressed has changed with the corner: the bar is looked after in a moment.
    page.wait_for_function(
        """bar => 1 === [...bar.querySelectorAll("button:enabled")].filter(
          each => each.checkVisibility() && each.tabIndex >= 0).length""",
        arg=bar.element_handle(),
    )
    select = page.get_by_role("button", name=re.compile("^Select"))
    select.focus()
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.dataset.dimension") is not None
    select.focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate("document.activeElement.title").startswith("Stair")


def test_the_pose_is_told_and_copied(product: Product) -> None:
    page = product.page
    row = page.get_by_role("region", name="Pose at the cursor")
    page.get_by_role("slider", name="Time").press("Home")
    before = row.inner_text()
    page.get_by_role("slider", name="Time").press("PageUp")
    assert row.inner_text() != before
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    row.get_by_role("button", name="Copy the pose").click()
    page.locator(".toast").get_by_text("Pose copied").wait_for()
    text = page.evaluate("navigator.clipboard.readText()")
    for words in ("nose-up", "front thigh", "rear normal force", "Clearance"):
        assert words in text


def test_a_number_over_a_key_pose_takes_the_clock_there(product: Product) -> None:
    page = product.page
    clock = page.get_by_role("slider", name="Time")
    clock.press("Home")
    page.get_by_role("button", name="Next key pose").click()  # the first is where it starts
    second = clock.get_attribute("aria-valuenow")
    clock.press("End")
    page.locator(".kb").get_by_text("2", exact=True).click()
    assert clock.get_attribute("aria-valuenow") == second


def test_a_robot_turns_about(product: Product) -> None:
    """The question says it, the robot is drawn with its other end in front, undo turns it back."""
    page = product.page
    with page.expect_request(re.compile(r"/api/v1/plans$")) as asked:
        page.get_by_role("radio", name="Backward").click()
    assert asked.value.post_data_json["facing"] == "backward"
    product.planned()
    assert product.status == "feasible"
    link = product.linked('"b":1')
    page.keyboard.press("Control+z")
    page.get_by_role("radio", name="Forward", checked=True).wait_for()
    page.wait_for_function("link => location.href !== link", arg=link)
    page.evaluate("link => { location.href = link; }", link)
    page.get_by_role("radio", name="Backward", checked=True).wait_for()
    product.planned()
    page.get_by_role("radio", name="Forward").click()
    product.planned()


def test_a_refusal_offers_the_plan_with_the_other_end_in_front(product: Product) -> None:
    """Where what stops the robot is told: on the canvas, beside the tolerance, in Robot."""
    page = product.page
    _choose_robot(page, "a1_wheeled")
    drop = [[-1.2, 0.25], [0, 0.25], [0, 0], [1.2, 0]]
    product.paste(json.dumps({"points": drop, "friction": 0.4})).has_corners(4).planned()
    card = page.get_by_role("region", name="What stops the robot")
    tolerance = page.get_by_role("region", name="Tolerance")
    offer = card.get_by_role("button", name="Plan backward")
    assert "rear first" in card.inner_text()
    assert violations(page, ".why") == []
    offer.focus()
    page.keyboard.press("Enter")
    page.get_by_role("radio", name="Backward", checked=True).wait_for()
    product.planned()
    assert product.status == "feasible"
    page.keyboard.press("Control+z")
    page.get_by_role("radio", name="Forward", checked=True).wait_for()
    offer.wait_for()
    tolerance.get_by_role("slider", name="Step height ±").press("ArrowRight")
    product.planned()
    tolerance.get_by_role("button", name="Plan backward").wait_for()
    assert violations(page, ".tolerance") == []
    page.keyboard.press("2")
    preview = page.get_by_role("region", name="Two robots on this terrain")
    preview.get_by_role("button", name="Plan backward").click()
    product.planned()
    assert product.status == "feasible"
    page.keyboard.press("1")
    page.get_by_role("button", name=re.compile("Reset Step height")).click()
    page.get_by_role("radio", name="Forward").click()
    _choose_robot(page, "a1_wheeled_x")
    product.planned()


def test_a_thin_plan_offers_the_safer_end_in_front(product: Product) -> None:
    page = product.page
    _choose_robot(page, "a1_wheeled")
    product.paste(json.dumps({"points": [[-1.5, 0.25], [0, 0.25], [0, 0], [1.5, 0]]}))
    product.has_corners(4).planned()
    pill, inspector = page.locator(".pill"), page.get_by_role("region", name="Inspector")
    assert re.search(r"CoM margin \d+ mm, backward \d+ mm", pill.inner_text())
    assert violations(page, ".insp") == []
    inspector.get_by_role("button", name="Plan backward").click()
    page.get_by_role("radio", name="Backward", checked=True).wait_for()
    product.planned()
    assert "thin" not in pill.inner_text()
    assert inspector.get_by_role("button", name="Plan backward").count() == 0
    page.get_by_role("radio", name="Forward").click()
    _choose_robot(page, "go2w")
    flight = stair(0.18, 0.28, 3, direction="down")
    product.paste(json.dumps({"points": flight.points}))
    product.has_corners(len(flight.points)).planned()
    assert re.search(r"Clearance \d mm, backward \d\d mm", pill.inner_text())


def test_that_there_is_no_path_shows_before_what_stops_the_robot(product: Product) -> None:
    """What would open one takes most of an answer's time, here for as long as we like."""
    page = product.page
    held: list[Route] = []
    page.route("**/api/v1/plans", lambda route: held.append(route))
    walls = [[[-1.5, 0], [0, 0], [0, z], [1.5, z]] for z in (1.2, 1.3)]
    product.paste(json.dumps({"points": walls[0]}))
    while not held:
        page.wait_for_timeout(50)
    held.pop().continue_()
    product.planned()  # so late that the quick way is asked first from now on
    product.paste(json.dumps({"points": walls[1]}))
    card = page.get_by_role("region", name="What stops the robot")
    card.get_by_text("No path. Finding out what would open one").wait_for()
    assert "Infeasible" in page.locator(".pill").inner_text()
    assert violations(page, ".why") == []
    page.keyboard.press("2")
    beside = page.get_by_role("region", name="Two robots on this terrain")
    beside.get_by_text("No path. Finding out what would open one").wait_for()
    page.keyboard.press("1")
    while not held:
        page.wait_for_timeout(50)
    page.unroute("**/api/v1/plans")
    held.pop().continue_()
    product.planned()
    assert "Needs" in card.inner_text()
    assert product.status == "infeasible"
    product.fresh().planned()


def test_a_fast_plan_says_and_shows_which_end_leads(product: Product) -> None:
    """Nobody has asked for it: down stairs a1_wheeled is sooner with its rear in front."""
    page = product.page
    _choose_robot(page, "a1_wheeled")
    product.paste(json.dumps({"points": [[-1.5, 0.2], [0, 0.2], [0, 0], [1.5, 0]]}))
    product.has_corners(4).planned()
    leads = page.locator(".pill").get_by_text(re.compile("^backward, "))
    robot = page.locator(".ed g.cur").first
    facing = page.get_by_role("radiogroup", name="Facing")
    facing.get_by_role("radio", name="Forward", checked=True).wait_for()
    assert leads.count() == 0
    with page.expect_request(re.compile(r"/api/v1/plans$")) as asked:
        page.get_by_role("radio", name="Fast").click()
    assert "facing" not in asked.value.post_data_json
    leads.wait_for()
    facing.get_by_role("radio", name="Either", checked=True).wait_for()
    product.planned()
    chosen = robot.inner_html()
    facing.get_by_role("radio", name="Backward").click()
    product.planned()
    assert robot.inner_html() == chosen
    link = product.linked('"b":1')
    facing.get_by_role("radio", name="Forward").click()
    leads.wait_for(state="hidden")
    product.planned()
    assert robot.inner_html() != chosen
    product.linked('"b":"forward"')
    page.evaluate("link => { location.href = link; }", link)
    facing.get_by_role("radio", name="Backward", checked=True).wait_for()
    page.get_by_role("radio", name="Steady").click()
    facing.get_by_role("radio", name="Forward").click()
    _choose_robot(page, "a1_wheeled_x")
    product.planned()


def test_a_fast_plan_tells_what_limits_its_speed(product: Product) -> None:
    """Poses have names of limits; band, legend and label show the same as the service's plan."""
    page = product.page
    with page.expect_response(
        lambda answer: (
            answer.request.method == "POST"
            and answer.url.endswith("/plans")
            and '"timing":"fast"' in (answer.request.post_data or "")
        )
    ) as asked:
        page.get_by_role("radio", name="Fast").click()
    plan = asked.value.json()
    product.planned()
    titles = {
        "balance": "balance",
        "torque": "leg torque",
        "acceleration": "acceleration",
        "joint_speed": "joint speed",
        "pitch_speed": "pitch rate",
        "wheel_speed": "wheel speed",
        "impact": "impact",
    }
    limits = plan["timing"]["limits"]
    legend = page.get_by_role("list", name="What limits the speed")
    assert sorted(legend.get_by_role("listitem").all_inner_texts()) == sorted(
        titles[name] for name in set(limits)
    )
    runs = [name for name, _ in itertools.groupby(limits)]
    band = page.locator(".speed-band .limit")
    assert len(set(limits)) > 1
    assert band.count() <= len(runs)
    drawn = band.evaluate_all("all => all.map(i => i.classList[1])")
    assert set(drawn) == set(limits)
    label = page.locator(".speed .ml")
    page.get_by_role("slider", name="Time").press("Home")
    assert titles[limits[0]] in label.inner_text()
    poses = plan["poses"]
    speeds = [
        (b["progress"] - a["progress"]) / (b["time"] - a["time"])
        for a, b in zip(poses, poses[2:], strict=False)
    ]
    assert f"most {max(speeds):.2f} m/s" in label.inner_text()
    page.get_by_role("radio", name="Steady").click()
    product.planned()
    page.locator(".speed-band").wait_for(state="detached")


# Distances between neighbouring marks of key poses on the timeline [px].
MARKS = """() => {
  const at = [...document.querySelectorAll(".scrub i")].map(i => i.getBoundingClientRect().x);
  return at.slice(1).map((x, k) => x - at[k]);
}"""


def test_marks_on_the_timeline_do_not_lie_over_each_other(product: Product) -> None:
    page = product.page
    product.draw_flight(20)
    gaps = page.evaluate(MARKS)
    assert len(gaps) > 20
    assert min(gaps) > 11.5
    # All of them can be stepped to nevertheless.
    clock = page.get_by_role("slider", name="Time")
    clock.press("Home")
    seen = set()
    for _ in range(20):
        page.get_by_role("button", name="Next key pose").click()
        seen.add(clock.get_attribute("aria-valuenow"))
    assert len(seen) == 20


def test_margins_run_along_time_or_place(product: Product) -> None:
    page = product.page
    ticks = page.locator(".ticks")
    assert " s" in ticks.inner_text()
    page.get_by_role("button", name="Place", exact=True).click()
    assert " m" in ticks.inner_text()
    assert page.locator(".rows .bars[d]:not([d=''])").count() > 0
    page.get_by_role("button", name="Time", exact=True).click()


def test_a_setting_beyond_its_bounds_says_them(product: Product) -> None:
    page = product.page
    page.get_by_role("radio", name="Trials").click()
    field = page.get_by_label("CoM forward, value")
    field.fill("300")
    page.get_by_text("Between −200 and 200 mm").wait_for()
    field.fill("20")
    page.get_by_text("Between −200 and 200 mm").wait_for(state="detached")
    heading = page.get_by_role("button", name="Load 1 changed")
    heading.click()
    field.wait_for(state="detached")
    heading.click()
    page.get_by_role("button", name="Reset CoM forward").click()
    page.get_by_role("radio", name="Plan", exact=True).click()


def test_a_rollout_is_asked_with_lists_of_errors_and_the_place_of_a_load(product: Product) -> None:
    page = product.page
    page.get_by_role("radio", name="Trials").click()
    steps = page.get_by_label("Step heights, one by one, mm")
    steps.fill("5, 300")
    page.get_by_text("−100 to 100 mm each, with commas").wait_for()
    steps.fill("5, −3 2.5")
    assert page.get_by_label("Payload, place x in mm").count() == 0  # of nothing
    page.get_by_label("Payload, value").fill("0.5")
    page.get_by_label("Payload, place x in mm").fill("40")
    assert _asked_to_run(product) == {
        "step_height_error": [0.005, -0.003, 0.0025],
        "payload": {"mass": 0.5, "place": [0.04, 0, 0]},
    }
    page.get_by_role("button", name="Reset Payload, place").click()
    page.get_by_role("button", name="Reset Step heights").click()
    assert page.get_by_label("Step heights ±, value").input_value() == "0"
    page.get_by_role("button", name="Clear", exact=True).click()
    page.get_by_role("radio", name="Plan", exact=True).click()


def test_a_rollout_is_asked_with_the_friction_of_each_wheel(product: Product) -> None:
    page = product.choose_terrain("curb-015").page
    page.get_by_role("radio", name="Trials").click()
    page.get_by_label("Friction, wheels, FL").fill("0.5")
    page.get_by_label("Friction, wheels, RR").fill("0.4")
    page.get_by_label("Gyroscope bias, value").fill("0.1")
    assert _asked_to_run(product) == {
        "friction_wheels": [0.5, 0.5, 0.5, 0.4],
        "imu": {"gyro_bias": 0.1},
    }
    page.get_by_role("button", name="Clear", exact=True).click()
    page.get_by_role("radio", name="Plan", exact=True).click()
