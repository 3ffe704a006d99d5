"""The profile editor: pointer, keyboard, numbers, tools, history."""

from __future__ import annotations

import itertools
import math
import re
import time
from typing import TYPE_CHECKING

import pytest

from .conftest import TERRAIN, Product

if TYPE_CHECKING:
    from playwright.sync_api import (
        Page,
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
                time.sleep(0.5)
            line.send(answer)

        line.on_message(service.send)
        service.on_message(late)

    page.route_web_socket("**/plans/live", relay)
    held = Product(page).open().choose_terrain("stairs-us-7-11")
    box = held.vertex(6).locator("rect").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    for step in range(150):
        page.mouse.move(box["x"] + 20 * math.sin(step / 3), box["y"] + 10 * math.sin(step / 4))
        page.wait_for_timeout(100)
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


def test_tools_draw_on_an_empty_canvas(product: Product) -> None:
    for key, corners in (("s", 2), ("r", 2), ("p", 1)):
        _empty(product)
        product.page.keyboard.press(key)
        _stroke(product, (400, 380), (520, 340))
        assert product.corners() >= 2 + corners, key


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
