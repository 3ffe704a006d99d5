"""The workspace Robot: reshape one, see the plan follow, keep it, read one from a file."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from playwright.sync_api import expect

import stairwright as sw
from stairwright.export.formats import save
from stairwright.export.table import ROBOT_FORMATS
from tests.robot.importing.written import ANKLES, with_ankles

from .axe import violations
from .conftest import DESK, PHONE, Product
from .robot_room import LAPTOP, choose, choose_file, enter, field, robot_room, state

if TYPE_CHECKING:
    from playwright.sync_api import ViewportSize

pytestmark = [pytest.mark.browser]


@pytest.fixture
def product(shared: Product) -> Iterator[Product]:
    """The page that these tests share, in Robot, with the A1 as it is stored."""
    with robot_room(shared) as product:
        yield product


def test_the_plan_is_of_the_robot_in_hand(product: Product) -> None:
    """A load, a weak motor and a moved mass centre: the planner is asked about all of it."""
    page = product.choose_terrain("curb-015").page
    with page.expect_request(re.compile(r"/api/v1/plans$")) as asked:
        enter(product, "payload.mass", "2.5")
    sent = asked.value.post_data_json["robot"]
    assert sent["payload"]["mass"] == 2.5
    assert sw.Robot.model_validate(sent).mass == pytest.approx(11.84 + 2.5)
    assert page.locator(".number", has_text="Total").locator("output").inner_text() == "14.34"
    with page.expect_request(re.compile(r"/api/v1/plans$")) as asked:
        enter(product, "com.x", "25")
    assert asked.value.post_data_json["robot"]["trunk"]["com"][0] == pytest.approx(0.025)
    assert product.status == "feasible"
    enter(product, "leg.torque", "1.0")
    assert product.status == "infeasible"
    assert "torque" in page.locator(".rivals").first.locator(".facts-line").inner_text()


STEP_UP = """fields => fields.forEach(field => {
  field.focus();
  field.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowUp", bubbles: true }));
})"""


@pytest.mark.slow
def test_every_number_of_a_preset_makes_a_robot_that_the_service_takes(
    product: Product,
) -> None:
    """Each is stepped up once, all together: shapes, moments and heights stay possible.

    Of presets that differ in kind: knees back, free knees, of 50 kg.
    """
    page = product.choose_terrain("curb-015").page
    for name in ("a1_wheeled", "m20", "anymal_wheels"):
        choose(product, name)
        fields = page.locator(".rows .num")
        fields.evaluate_all(STEP_UP)
        assert int(state(product).split()[1]) >= fields.count() > 30
        page.evaluate("document.activeElement.blur()")
        product.planned()
        assert product.status in ("feasible", "infeasible"), name
        page.get_by_role("button", name="Reset robot").click()
        product.planned()


def test_a_link_carries_the_edited_robot(product: Product) -> None:
    page = product.page
    enter(product, "front.thigh.length", "0.22")
    address = product.linked('"length":0.22,')
    other = page.context.new_page()
    opened = Product(other)
    opened.open(address)
    assert other.locator('[data-quantity="front.thigh.length"] input').input_value() == "0.220"
    other.close()
    assert opened.errors == []


def test_an_own_robot_is_saved_listed_and_deleted(product: Product) -> None:
    page = product.page
    enter(product, "wheel.radius", "0.06")
    page.get_by_role("button", name="Save as").click()
    page.get_by_role("textbox", name="Save as").fill("my a1")
    page.get_by_role("button", name="Save", exact=True).click()
    page.get_by_role("button", name="Delete my a1").wait_for()
    assert state(product) == "yours"
    got = page.request.get("/api/v1/robots/my a1").json()
    assert got["wheel"]["radius"] == pytest.approx(0.06)
    enter(product, "wheel.radius", "0.07")
    page.get_by_role("button", name="Delete my a1").click()
    page.get_by_text("my a1 is deleted.").wait_for()
    page.get_by_text("Undo", exact=True).click()
    page.get_by_role("button", name="Delete my a1").wait_for()
    expect(field(product, "wheel.radius")).to_have_value("0.070")
    page.get_by_role("button", name="Reset robot").click()
    expect(field(product, "wheel.radius")).to_have_value("0.060")
    product.linked('"r":"my a1"')
    address = product.linked('"radius":0.06,')
    page.get_by_role("button", name="Delete my a1").click()
    page.get_by_text("my a1 is deleted.").wait_for()
    assert page.request.get("/api/v1/robots/my a1").status == 404
    page.get_by_role("button", name="Dismiss").click()
    # A link outlives the robot, and is read where it never was.
    other = Product(page.context.new_page())
    assert other.open(address).status == "feasible"
    assert field(other, "wheel.radius").input_value() == "0.060"
    assert state(other) == "not saved"
    other.page.get_by_role("button", name="Close my a1").wait_for()
    other.page.close()


def test_robots_that_another_window_saves_and_deletes(product: Product) -> None:
    page = product.page
    robot = sw.load_robot("go2w").model_copy(update={"name": "ours"}).model_dump(mode="json")
    page.request.put("/api/v1/robots/ours", data=robot)
    page.get_by_title("Robot", exact=True).click()
    page.get_by_role("menuitemradio", name="ours").click()
    product.planned()
    page.request.delete("/api/v1/robots/ours")
    page.keyboard.press("1")
    page.keyboard.press("2")
    page.get_by_role("button", name="Close ours").wait_for()
    assert state(product) == "not saved"  # what is in hand stays there
    assert product.planned().status == "feasible"
    page.get_by_role("button", name="Close ours").click()


@pytest.mark.parametrize(
    ("robot", "said"),
    [
        ({}, "The robot nobody of this link is not here; a1_wheeled_x is shown instead."),
        ({"rd": {"name": "nobody"}}, "This link could not be read; the sample is shown instead."),
    ],
)
def test_a_link_of_a_robot_that_cannot_be_had_says_so(
    product: Product, robot: dict[str, Any], said: str
) -> None:
    page = product.page.context.new_page()
    shared = {"t": {"name": "x", "points": [[-1, 0], [0, 0], [0, 0.1], [1, 0.1]], "friction": 0.6}}
    text = json.dumps(shared | {"r": "nobody", "m": "path"} | robot).encode()
    opened = Product(page).open("/#s=" + base64.urlsafe_b64encode(text).decode().rstrip("="))
    page.get_by_text(said).wait_for()
    assert opened.status == "feasible"
    assert opened.errors == []
    page.close()


def test_an_edited_robot_is_downloaded(product: Product, tmp_path: Path) -> None:
    page = product.page
    enter(product, "front.calf.length", "0.215")
    for name in ("YAML", "URDF", "MJCF"):
        page.get_by_role("button", name="Download robot").click()
        with page.expect_download() as download:
            page.get_by_role("menuitem", name=name).click()
        path = tmp_path / download.value.suggested_filename
        download.value.save_as(path)
        found = sw.load_robot(str(path)) if name == "YAML" else sw.import_robot(path).robot
        assert found.calf.length == pytest.approx(0.215, abs=1e-6), name


def test_a_downloaded_robot_comes_back(product: Product) -> None:
    """Dropped in another room, or pasted: what it is stands in it."""
    page = product.page
    mine = sw.load_robot("d1").model_copy(update={"name": "my own"})
    text = ROBOT_FORMATS["yaml"].write(mine).decode()
    for bring in (lambda: product.drop("mine.yaml", text), lambda: product.paste(text)):
        page.keyboard.press("1")
        bring()
        report = page.get_by_role("region", name="File")
        report.get_by_text("read: my own").wait_for()
        report.get_by_role("button", name="Open my own").click()
        assert product.planned().status == "feasible"
        assert state(product) == "not saved"
        assert float(field(product, "wheel.radius").input_value()) == mine.wheel.radius
        page.get_by_role("button", name="Close my own").click()


def test_a_file_is_read_reported_and_opened(product: Product, tmp_path: Path) -> None:
    page = product.page
    path = tmp_path / "theirs.urdf"
    save(sw.load_robot("go2w"), str(path))
    page.get_by_label("Robot file").set_input_files(path)
    report = page.get_by_role("region", name="File")
    report.get_by_text("theirs.urdf read").wait_for()
    assert report.locator("li").count() > 0  # what had to be assumed
    assert state(product) == "preset"  # nothing changes before it is opened
    report.get_by_role("button", name=re.compile("^Open")).click()
    product.planned()
    assert state(product) == "not saved"
    assert product.status == "feasible"
    assumed = " ".join(page.locator(".number", has_text="assumed").all_inner_texts())
    for part in ("Thigh rotor", "Wheel rotor", "Standing height"):
        assert part in assumed
    for other in ("torque", "Hip distance"):  # which only reasons of those speak of
        assert other not in assumed
    page.get_by_role("button", name=re.compile("^Close go2w")).click()


def test_a_file_that_does_not_fit_is_refused_with_its_reason(product: Product) -> None:
    page = product.page
    choose_file(product, "lamp.urdf", '<robot name="lamp"><link name="base"/></robot>')
    alert = page.get_by_role("region", name="File").get_by_role("alert")
    alert.wait_for()
    assert "lamp.urdf does not fit" in alert.inner_text()
    assert "file:" not in alert.inner_text()
    page.get_by_role("region", name="File").get_by_role("button", name="Dismiss").click()


def test_joints_of_a_file_are_held(product: Product) -> None:
    page = product.page
    choose_file(product, "ankles.urdf", with_ankles("0 1 0"))
    report = page.get_by_role("region", name="File")
    report.get_by_role("alert").get_by_text("one joint too many").wait_for()
    hold = report.get_by_label("Hold joints rigid")
    hold.fill("nobody=1")
    hold.press("Enter")
    report.get_by_role("alert").get_by_text("there is no joint 'nobody'").wait_for()
    report.get_by_label("Hold joints rigid").fill(", ".join(f"{name}=0.3" for name in ANKLES))
    report.get_by_role("button", name="Read again").click()
    report.get_by_text("ankles.urdf read").wait_for()
    report.get_by_role("button", name=re.compile("^Open")).click()
    product.planned()
    page.locator(".texts", has_text="Rigid [rad]: FL_ankle_joint 0.30").wait_for()
    page.get_by_role("button", name=re.compile("^Close maker")).click()


def test_two_robots_stand_side_by_side_and_change_places(product: Product) -> None:
    page = product.page
    a, b = page.locator(".rivals").all()
    page.get_by_role("button", name=re.compile("^Robot B")).click()
    page.get_by_role("menuitemradio", name="go2w").click()
    b.locator(".verdict.ok, .verdict.bad").wait_for()
    assert a.locator("h2").inner_text() == "a1_wheeled_x"
    shown = b.get_by_role("img")
    assert (shown.get_attribute("aria-label") or "").startswith("go2w over three-stairs-up")
    page.get_by_role("button", name="Swap A and B").click()
    product.planned()
    assert a.locator("h2").inner_text() == "go2w"
    b.locator(".verdict.ok, .verdict.bad").wait_for()
    page.get_by_role("button", name="Swap A and B").click()


@pytest.mark.parametrize(("theme", "size"), [("light", PHONE), ("dark", DESK)])
def test_axe_finds_nothing(product: Product, theme: str, size: ViewportSize) -> None:
    page = product.page
    page.set_viewport_size(size)
    if page.evaluate("document.documentElement.dataset.theme") != theme:
        page.get_by_role("button", name=re.compile("theme$")).click()
    found = violations(page, ".robot-room", minor=True)
    page.set_viewport_size(DESK)
    assert found == []


def test_nothing_overflows(product: Product) -> None:
    page = product.page
    enter(product, "hips", "0.3")  # which then tells what it was
    wide = []
    for size in (DESK, LAPTOP):
        page.set_viewport_size(size)
        wide += page.evaluate(
            """() => [...document.querySelectorAll('.robot-room :is(.hd, .rows, .shelf, .entry)')]
                .filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.className)"""
        )
    page.set_viewport_size(DESK)
    assert wide == []
