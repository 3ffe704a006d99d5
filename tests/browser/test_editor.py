"""The profile editor: pointer, keyboard, numbers, tools, files, history."""

from __future__ import annotations

import itertools
import json
import math
import re
import time
from typing import TYPE_CHECKING

import pytest

from stairwright.terrain.stairs import stair

from .conftest import DESK, PHONE, TERRAIN, Product

if TYPE_CHECKING:
    from playwright.sync_api import (
        FloatRect,
        Locator,
        Page,
        ViewportSize,
        WebSocket,
        WebSocketRoute,
    )

pytestmark = [pytest.mark.browser]


@pytest.fixture
def product(fresh: Product) -> Product:
    """The page that these tests share, showing three stairs."""
    return fresh


# Keys faster than the page can draw; returns the corner with the focus after each.
PRESS_AT_ONCE = """keys => keys.map(key => {
  document.activeElement.dispatchEvent(
    new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
  return document.activeElement.dataset.vertex;
})"""


def test_a_drag_is_one_undo_step_and_snaps_to_the_grid(product: Product) -> None:
    before = product.corner(6)
    product.drag(6, 31, -17, steps=12).planned()
    moved = product.corner(6)
    assert moved != before
    assert all(abs(v / 0.005 - round(v / 0.005)) < 1e-6 for v in moved)
    product.page.keyboard.press("Control+z")
    assert product.corner(6) == before
    product.page.keyboard.press("Control+Shift+z")
    assert product.corner(6) == moved


def _held(product: Product) -> None:
    """Drag a corner and hold it until poses follow."""
    box = product.vertex(6).locator("rect").bounding_box()
    assert box is not None
    product.page.evaluate("performance.clearMarks()")
    product.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    product.page.mouse.down()
    for k in range(8):
        product.page.mouse.move(box["x"] + 4 * k, box["y"] - 3 * k)
        product.page.wait_for_timeout(20)
    product.page.wait_for_function("performance.getEntriesByName('stairwright:poses').length > 1")
    product.page.mouse.up()
    product.planned()


def test_poses_follow_a_drag_over_the_live_connection(product: Product) -> None:
    answers: list[str | bytes] = []

    def listen(line: WebSocket) -> None:
        line.on("framereceived", lambda answer: answers.append(answer))

    product.page.on("websocket", listen)
    product.page.reload()
    product.planned().fresh()
    _held(product)
    assert any('"method":"critical"' in str(answer) for answer in answers)


def test_poses_follow_a_drag_without_that_connection(offline_live: Product) -> None:
    offline_live.open().fresh()
    _held(offline_live)
    assert offline_live.errors == []


def test_previews_that_were_slow_once_are_tried_again(page: Page) -> None:
    """A hiccup makes the quick method look no quicker than the full one."""
    came = []

    def relay(line: WebSocketRoute) -> None:
        service = line.connect_to_server()

        def late(answer: str | bytes) -> None:
            came.append(answer)
            if len(came) <= 2:
                time.sleep(1.0)
            line.send(answer)

        line.on_message(service.send)
        service.on_message(late)

    page.route_web_socket("**/plans/live", relay)
    held = Product(page).open().choose_terrain("stairs-us-7-11")
    box = held.vertex(6).locator("rect").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    for step in range(300):
        page.mouse.move(box["x"] + 20 * math.sin(step / 5), box["y"] + 10 * math.sin(step / 7))
        page.wait_for_timeout(50)
        if len(came) > 4:
            break
    page.mouse.up()
    assert len(came) > 4
    assert held.planned().errors == []


def test_x_cannot_pass_a_neighbour(product: Product) -> None:
    product.drag(3, -400, 0).planned()
    assert product.corner(3)[0] >= product.corner(2)[0]


def test_keyboard_alone_moves_adds_and_deletes(product: Product) -> None:
    x, z = product.corner(6)
    product.vertex(6).focus()
    product.page.keyboard.press("ArrowRight")
    product.page.keyboard.press("Shift+ArrowUp")
    assert product.corner(6) == (pytest.approx(x + 0.01), pytest.approx(z + 0.1))
    count = product.corners()
    product.page.keyboard.press("Insert")
    assert product.focused() == 7
    assert product.corners() == count + 1
    product.page.keyboard.press("Delete")
    assert product.focused() == 6
    assert product.corners() == count
    product.page.keyboard.press("PageDown")
    assert product.focused() == 7
    product.page.keyboard.press("Delete")  # the last corner: its element goes away
    assert product.focused() == 6


def test_keys_in_one_task_find_the_corner_that_has_the_focus(product: Product) -> None:
    count = product.corners()
    product.vertex(count - 2).focus()
    found = product.page.evaluate(PRESS_AT_ONCE, ["Insert", "Delete", "Delete", "ArrowUp"])
    assert found == [str(count - 1), str(count - 2), str(count - 3), str(count - 3)]
    assert product.corners() == count - 1


def test_numbers_can_be_typed(product: Product) -> None:
    product.vertex(6).focus()
    field = product.page.get_by_label("z of the corner in metres")
    field.fill("0,4")
    field.press("Enter")
    assert product.corner(6)[1] == pytest.approx(0.4)
    # A dimension moves everything after it.
    end = product.corner(7)
    run = product.page.get_by_role("button", name="Run 0.300 m").first
    run.focus()
    run.press("Enter")
    product.page.get_by_label("Run in metres").fill("0.35")
    product.page.keyboard.press("Enter")
    assert product.corner(7)[0] == pytest.approx(end[0] + 0.05)


# The corners whose middle something that floats over the canvas takes from the pointer.
COVERED = """() => [...document.querySelectorAll("[data-vertex]")].filter(vertex => {
  const box = vertex.querySelector("rect").getBoundingClientRect();
  const at = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
  return at?.closest(".ro, .hint");
}).length"""


@pytest.mark.parametrize("viewport", [DESK, PHONE], ids=["desk", "phone"])
@pytest.mark.parametrize(("terrain", "corner"), [("three-stairs-up-down", 3), ("loading-dock", 6)])
def test_the_read_out_covers_no_corner(
    product: Product, viewport: ViewportSize, terrain: str, corner: int
) -> None:
    product.page.set_viewport_size(viewport)
    try:
        product.choose_terrain(terrain).vertex(corner).focus()
        product.page.locator(".ro").wait_for()
        assert product.page.evaluate(COVERED) == 0
    finally:
        product.page.set_viewport_size(DESK)


def test_several_corners_move_together(product: Product) -> None:
    before = [product.corner(i) for i in range(product.corners())]
    product.vertex(0).focus()
    product.page.keyboard.press("Control+a")
    product.page.keyboard.press("ArrowUp")
    after = [product.corner(i) for i in range(product.corners())]
    assert [z for _, z in after] == pytest.approx([z + 0.01 for _, z in before])


def _empty(product: Product) -> None:
    product.page.keyboard.press("v")
    product.page.get_by_role("button", name=TERRAIN).click()
    product.page.get_by_role("button", name="New", exact=True).click()
    assert product.status == "none"
    product.page.get_by_text("Draw a profile or start from a preset").wait_for()


def _stroke(product: Product, a: tuple[float, float], b: tuple[float, float]) -> None:
    """From a to b in pixels on the canvas."""
    box = product.page.locator(".ed").bounding_box()
    assert box is not None
    product.page.mouse.move(box["x"] + a[0], box["y"] + a[1])
    product.page.mouse.down()
    product.page.mouse.move(box["x"] + b[0], box["y"] + b[1], steps=10)
    product.page.mouse.up()
    product.planned()


@pytest.mark.parametrize(("key", "corners"), [("s", 2), ("r", 2), ("p", 1)])
def test_tools_draw_on_an_empty_canvas(product: Product, key: str, corners: int) -> None:
    _empty(product)
    product.page.keyboard.press(key)
    _stroke(product, (400, 380), (520, 340))
    assert product.corners() >= 2 + corners


def _alone(product: Product) -> None:
    """The editor has the whole stage."""
    product.page.keyboard.press("m")
    product.page.wait_for_function("() => document.querySelector('.ed').clientWidth > 1000")


def test_the_ground_grows_with_a_drawn_line_from_either_side(product: Product) -> None:
    drawn = []
    product.page.locator(".edit").hover()
    _alone(product)  # lines this long need the whole stage
    for a, b in [((60, 380), (960, 330)), ((960, 330), (60, 380))]:
        _empty(product)
        product.page.keyboard.press("p")
        _stroke(product, a, b)
        assert product.status == "feasible"
        drawn.append([product.corner(i) for i in range(product.corners())])
    assert drawn[0] == drawn[1]
    (x0, z0), foot, top, (x3, z3) = drawn[0]
    assert foot == (pytest.approx(x0 + 1), z0)
    assert top == (pytest.approx(x3 - 1), z3)
    _alone(product.fresh("flat"))
    product.page.keyboard.press("p")
    _stroke(product, (600, 300), (1100, 260))
    assert product.corner(product.corners() - 1)[0] > 2.0


def test_stairs_by_the_code(product: Product) -> None:
    product.choose_terrain("flat")
    product.page.get_by_role("button", name=re.compile("^Snapping")).click()
    product.page.get_by_role("menuitemradio", name="Industrial").click()
    box = product.page.locator(".ed").bounding_box()
    assert box is not None
    product.page.mouse.click(box["x"] + 500, box["y"] + 300)
    product.planned()
    product.page.get_by_role("button", name=re.compile("^Snapping")).click()
    product.page.get_by_role("menuitemradio", name="Free rise and run").click()
    faces = [product.corner(i) for i in range(product.corners())]
    assert any(b[1] - a[1] == pytest.approx(0.2) for a, b in itertools.pairwise(faces))


def test_files_are_dropped_and_text_is_pasted(product: Product) -> None:
    text = "x,z\n-1.5,0\n0,0\n0,0.1\n2,0.1\n"
    product.drop("kerb.csv", text).has_corners(4)
    assert product.planned().corner(2) == (0.0, pytest.approx(0.1))
    product.paste(text.replace("0.1", "0.12"))
    product.page.wait_for_function(
        "() => document.querySelector('[data-vertex=\"2\"]').ariaLabel.includes('0.120')"
    )
    product.drop("broken.csv", "a,b\nnot,numbers\n")
    product.page.locator(".import-error").wait_for()
    assert product.corners() == 4
    product.page.get_by_role("button", name="Dismiss").click()
    points = [[-1.5, 0], [0, 0], [0, 0.1], [0.4, 0.1], [0.4, 0.2], [2, 0.2]]
    product.paste(json.dumps({"points": points})).has_corners(6).planned()
    product.paste("points:\n- [-1.5, 0]\n- [0.6, 0]\n- [1.2, 0.1]\n- [3, 0.1]\nfriction: 0.5\n")
    assert product.has_corners(4).planned().corner(2) == (1.2, pytest.approx(0.1))


def test_a_profile_and_a_plan_that_were_downloaded_open_again(product: Product) -> None:
    for name in ("plan.json", "curb-015.json"):
        product.choose_terrain("curb-015").page.get_by_role("button", name="Download").click()
        schema = "plan" if name == "plan.json" else "terrain"
        with product.page.expect_download() as saved:
            product.page.get_by_role("menuitem", name=f"JSON stairwright/{schema}/1").click()
        product.fresh("flat").has_corners(2)
        product.drop(name, saved.value.path().read_text()).has_corners(4).planned()
        assert product.corner(2) == (0.0, pytest.approx(0.15))
    assert saved.value.suggested_filename == "curb-015.json"


def test_thousands_of_corners_are_thinned_and_all_in_reach(product: Product) -> None:
    # The drawing is looked at, not the plan.
    product.page.route("**/plans", lambda route: route.fulfill(status=422, json={"detail": "no"}))
    try:
        line = [f"{0.002 * i},{0.002 * math.sin(0.1 * i)}" for i in range(1998)]
        product.paste("x,z\n-1.5,0\n" + "\n".join(line) + "\n6,0\n")
        product.page.locator(".app[data-plan=refused]").wait_for()
        assert 50 < product.corners() < 400
        product.page.locator("[data-vertex]").nth(20).focus()
        at = product.focused()
        assert at is not None
        for i in range(1, 4):
            product.page.keyboard.press("PageDown")
            assert product.focused() == at + i
        product.page.keyboard.press("Delete")
        assert product.focused() == at + 2
    finally:
        product.page.unroute("**/plans")


def test_a_terrain_is_saved_and_deleted(product: Product) -> None:
    product.drag(6, 0, -20).planned()
    product.page.get_by_role("button", name=TERRAIN).click()
    product.page.get_by_label("Save as").fill("my stairs")
    product.page.get_by_role("button", name="Save", exact=True).click()
    product.page.get_by_role("button", name=re.compile(r"^Terrain\s+my stairs")).click()
    product.page.get_by_role("button", name="Delete my stairs").click()
    product.page.get_by_role("button", name="Delete my stairs").wait_for(state="detached")


def test_wheel_zooms_and_fit_returns(product: Product) -> None:
    zoom = product.page.locator(".zoom")
    assert zoom.inner_text() == "100 %"
    product.page.locator(".ed").hover(position={"x": 500, "y": 250})
    product.page.mouse.wheel(0, -400)
    product.page.wait_for_function("() => document.querySelector('.zoom').innerText !== '100 %'")
    product.page.get_by_role("button", name="Fit to view").click()
    assert zoom.inner_text() == "100 %"


def test_all_of_a_long_flight_is_in_view(product: Product) -> None:
    flight = stair(0.17, 0.29, 120)
    product.drop("flight.json", flight.model_dump_json())
    last = product.vertex(len(flight.points) - 1)
    last.wait_for()
    canvas = product.page.locator(".canvas").bounding_box()
    assert canvas is not None
    for corner in (product.vertex(0), last):
        box = corner.bounding_box()
        assert box is not None
        assert canvas["x"] < box["x"] < canvas["x"] + canvas["width"]
        assert canvas["y"] < box["y"] < canvas["y"] + canvas["height"]


def test_fit_leaves_room_for_dimensions_and_end_corners(product: Product) -> None:
    """Flat ground is as wide as the canvas: its numbers lay on the line, its ends half outside."""
    product.choose_terrain("flat")

    def box(found: Locator) -> FloatRect:
        where = found.bounding_box()
        assert where is not None
        return where

    canvas, label = box(product.page.locator(".ed")), box(product.page.locator(".dimbg"))
    first, last = (box(product.vertex(i).locator("rect")) for i in (0, 1))
    assert label["y"] > first["y"] + first["height"]
    assert first["x"] > canvas["x"] + 40  # past the ruler
    assert last["x"] + last["width"] < canvas["x"] + canvas["width"]


# Numbers of poses that are cut off, or that the legend lies over.
UNREADABLE = """() => {
  const canvas = document.querySelector(".canvas").getBoundingClientRect();
  const words = [...document.querySelectorAll(".lg span")].map(s => s.getBoundingClientRect());
  return [...document.querySelectorAll(".kb g")].filter(number => {
    const b = number.lastElementChild.getBoundingClientRect();
    return b.top < canvas.top + 20 || words.some(w =>
      w.left < b.right && b.left < w.right && w.top < b.bottom && b.top < w.bottom);
  }).map(number => number.textContent);
}"""


def test_a_tall_flight_leaves_the_numbers_of_its_poses_readable(product: Product) -> None:
    page = product.page
    page.set_viewport_size({"width": 1280, "height": 720})
    try:
        product.draw_flight(20)
        assert page.locator(".kb g").count() > 10
        assert page.evaluate(UNREADABLE) == []
    finally:
        page.set_viewport_size(DESK)


def test_a_typed_rise_that_leaves_the_view_is_shown_but_where_the_user_chose(
    product: Product,
) -> None:
    page = product.page
    page.set_viewport_size({"width": 1280, "height": 720})
    canvas = page.locator(".canvas").bounding_box()
    assert canvas is not None

    def higher(than: str, rise: str) -> float:
        """Height of the last corner in the window after the rise was typed [px]."""
        page.get_by_role("button", name=f"Rise {than} m").first.dblclick()
        page.get_by_label("Rise in metres").fill(rise)
        page.keyboard.press("Enter")
        product.planned()
        corner = product.vertex(product.corners() - 1).locator("rect").bounding_box()
        assert corner is not None
        return corner["y"]

    try:
        assert higher("0.125", "1.400") > canvas["y"] + 20
        page.keyboard.press("Control+z")
        product.planned()
        page.locator(".ed").hover(position={"x": 250, "y": 150})
        page.mouse.wheel(0, 100)
        assert higher("0.125", "2.500") < canvas["y"] + 20
    finally:
        page.set_viewport_size(DESK)


def test_two_fingers_zoom_and_change_nothing(product: Product) -> None:
    before = [product.corner(i) for i in range(product.corners())]
    box = product.vertex(3).bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    touch = product.page.context.new_cdp_session(product.page)

    def fingers(kind: str, apart: float) -> None:
        points = [{"x": x, "y": y, "id": 0}, {"x": x + apart, "y": y - apart, "id": 1}]
        touch.send(
            "Input.dispatchTouchEvent",
            {"type": kind, "touchPoints": [] if kind == "touchEnd" else points},
        )

    fingers("touchStart", 80)
    for apart in (100, 130, 160):
        fingers("touchMove", apart)
    fingers("touchEnd", 160)
    product.page.wait_for_function(
        "() => Number(document.querySelector('.zoom').innerText.replace(' %', '')) > 150"
    )
    assert [product.corner(i) for i in range(product.corners())] == before
    product.page.get_by_role("button", name="Fit to view").click()


def test_weights_replan_and_reset(product: Product) -> None:
    slider = product.page.get_by_role("slider", name="Speed")
    slider.press("PageUp")
    reset = product.page.get_by_role("button", name="Reset Speed")
    reset.wait_for()
    product.planned()
    reset.click()
    reset.wait_for(state="detached")
    product.planned()
    product.page.get_by_role("radio", name="Paper: critical poses").click()
    product.planned()
    product.page.get_by_role("slider", name="Posture").wait_for()
    product.page.get_by_role("radio", name="Path").click()
    product.planned()
