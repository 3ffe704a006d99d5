"""Colours of the scene, dark and light: the design's tokens as RGB triples (0..255)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stairwright.arrays import Floats
from stairwright.errors import InputError

Theme = Literal["dark", "light"]
Rgb = tuple[int, int, int]

# Clearance above which a collision point counts as ample, fair, thin [m]; below: critical.
AMPLE, FAIR, THIN = 0.020, 0.008, 0.0


def _rgb(text: str) -> Rgb:
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)


@dataclass(frozen=True)
class Palette:
    """One theme. `strip` runs ample, fair, thin, critical, as the page's margin strip does."""

    theme: Theme
    front: Rgb
    rear: Rgb
    com: Rgb
    force: Rgb
    error: Rgb
    accent: Rgb
    trunk: Rgb
    trim: Rgb
    tyre: Rgb
    path: Rgb
    edge: Rgb
    grid_cell: Rgb
    grid_section: Rgb
    ground: Rgb
    strip: tuple[Rgb, Rgb, Rgb, Rgb]
    ghost_opacity: float

    def clearance_colours(self, clearance: Floats) -> NDArray[np.uint8]:
        """(n, 3) strip colours of clearances (n,) in m."""
        index = np.searchsorted([THIN, FAIR, AMPLE], clearance, side="right")
        return np.array(self.strip[::-1], dtype=np.uint8)[index]

    def terrain(self, friction: float) -> tuple[Rgb, Rgb, Rgb]:
        """Treads, risers and flanks: cold for a slippery `friction`, warm for a grippy one."""
        slippery = float(np.clip((0.55 - friction) / 0.45, 0.0, 1.0))
        grippy = float(np.clip((friction - 0.65) / 0.55, 0.0, 1.0))
        base = np.array(self.ground, float)
        cold = np.array([0.62, 0.95, 1.24])
        warm = np.array([1.20, 1.02, 0.80])
        tint = 1.0 + slippery * (cold - 1.0) + grippy * (warm - 1.0)
        shades = [1.0, 0.80, 0.62] if self.theme == "dark" else [1.0, 0.84, 0.74]
        treads, risers, flanks = (
            tuple(int(round(v)) for v in np.clip(base * tint * shade, 0, 255)) for shade in shades
        )
        return treads, risers, flanks  # type: ignore[return-value]


DARK = Palette(
    theme="dark",
    front=_rgb("#5fb0f5"),
    rear=_rgb("#f2a541"),
    com=_rgb("#f2b6e6"),
    force=_rgb("#cfc65c"),
    error=_rgb("#ff7361"),
    accent=_rgb("#3fcdb6"),
    trunk=_rgb("#dfe4ea"),
    trim=_rgb("#3b444e"),
    tyre=_rgb("#3a4149"),
    path=_rgb("#c4ccd5"),
    edge=_rgb("#a9b6c4"),
    grid_cell=_rgb("#232b33"),
    grid_section=_rgb("#36414b"),
    ground=_rgb("#76838f"),
    strip=(_rgb("#3f8f88"), _rgb("#6fd0c4"), _rgb("#e8bb4e"), _rgb("#ff7361")),
    ghost_opacity=0.13,
)

LIGHT = Palette(
    theme="light",
    front=_rgb("#0f6cbd"),
    rear=_rgb("#b85f00"),
    com=_rgb("#7d2470"),
    force=_rgb("#857900"),
    error=_rgb("#c62f1d"),
    accent=_rgb("#0a7a6b"),
    trunk=_rgb("#56616d"),
    trim=_rgb("#2c343c"),
    tyre=_rgb("#2c333a"),
    path=_rgb("#3d4752"),
    edge=_rgb("#5d6b7a"),
    grid_cell=_rgb("#dfe5ea"),
    grid_section=_rgb("#cbd4dc"),
    ground=_rgb("#c3ccd5"),
    strip=(_rgb("#2f8f83"), _rgb("#4fb0a3"), _rgb("#e0a526"), _rgb("#c62f1d")),
    ghost_opacity=0.13,
)


def deep(colour: Rgb) -> Rgb:
    """The albedo that comes out as `colour`: light and tone mapping wash colours out."""
    r, g, b = (round(255 * (channel / 255) ** 1.9) for channel in colour)
    return r, g, b


def palette(theme: str | None) -> Palette:
    """The palette of a theme's name; dark by default.

    Raises:
        InputError: For an unknown name.
    """
    if theme in (None, "dark"):
        return DARK
    if theme == "light":
        return LIGHT
    raise InputError(f"unknown theme {theme!r}; there are: dark, light", ("theme",))
