"""The workspace Robot, and the words to talk about it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Locator, ViewportSize

    from .conftest import Product

LAPTOP: ViewportSize = {"width": 1280, "height": 720}


@contextmanager
def robot_room(shared: Product) -> Iterator[Product]:
    """The page in Robot, with the A1 as it is stored."""
    shared.errors.clear()
    page = shared.page
    shared.fresh()
    page.keyboard.press("2")
    choose(shared, "a1_wheeled_x")
    reset = page.get_by_role("button", name="Reset robot")
    if reset.is_enabled():
        reset.click()
    yield shared.planned()
    page.keyboard.press("1")
    assert shared.errors == []


def choose(product: Product, name: str) -> None:
    entries = product.page.locator(".entry > button:first-child")
    entries.filter(has=product.page.get_by_title(name, exact=True)).click()
    product.planned()


def choose_file(product: Product, name: str, content: str) -> None:
    product.page.get_by_label("Robot file").set_input_files(
        {"name": name, "mimeType": "application/xml", "buffer": content.encode()}
    )


def field(product: Product, quantity: str) -> Locator:
    return product.page.locator(f'[data-quantity="{quantity}"] input')


def enter(product: Product, quantity: str, text: str) -> None:
    number = field(product, quantity)
    number.fill(text)
    number.press("Enter")
    number.evaluate("e => e.blur()")
    product.planned()


def state(product: Product) -> str:
    return product.page.locator(".bench h2 small").inner_text()


def pull(product: Product, quantity: str, dx: float, dy: float) -> None:
    """Drag the grip of a dimension by pixels and let go."""
    box = product.page.locator(f'[data-handle="{quantity}"] .grip').bounding_box()
    assert box is not None
    mouse = product.page.mouse
    mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    mouse.down()
    mouse.move(box["x"] + box["width"] / 2 + dx, box["y"] + box["height"] / 2 + dy, steps=8)
    mouse.up()
