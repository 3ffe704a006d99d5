"""What hangs on the robot every frame: bars and arrows as instances of one mesh each.

Moving an instance costs the viewer a matrix; a line or a new mesh costs it a geometry.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stairwright.arrays import Floats

from . import shapes

Colours = NDArray[np.uint8]


def aim(directions: Floats) -> Floats:
    """Quaternions wxyz (n, 4) of the shortest turn from +z to unit `directions` (n, 3)."""
    w = 1.0 + directions[:, 2]
    turns = np.column_stack([w, -directions[:, 1], directions[:, 0], np.zeros(len(w))])
    turns[w < 1e-9] = (0.0, 1.0, 0.0, 0.0)  # straight down: half a turn about x
    unit: Floats = turns / np.linalg.norm(turns, axis=1, keepdims=True)
    return unit


class Instances:
    """Copies of one mesh under a fixed node, each with its own place, turn, scale and colour."""

    def __init__(self, scene: Any, node: str, mesh: shapes.Mesh, **look: Any) -> None:
        self._scene, self._node, self._mesh, self._look = scene, node, mesh, look
        self._handle: Any = None
        self._colours: Colours | None = None

    def draw(
        self, positions: Floats, turns: Floats, scales: Floats, colours: Colours, visible: bool
    ) -> None:
        """Place all copies; positions and scales (n, 3), turns (n, 4), colours (n, 3)."""
        if self._handle is None:
            self._handle = self._scene.add_batched_meshes_simple(
                self._node,
                self._mesh.vertices,
                self._mesh.faces,
                turns,
                positions,
                batched_scales=scales,
                batched_colors=colours,
                lod="off",
                cast_shadow=False,
                receive_shadow=False,
                visible=visible,
                **self._look,
            )
            self._colours = colours
            return
        self._handle.batched_positions = positions.astype(np.float32)
        self._handle.batched_wxyzs = turns.astype(np.float32)
        self._handle.batched_scales = scales.astype(np.float32)
        if not np.array_equal(self._colours, colours):  # type: ignore[arg-type]
            self._handle.batched_colors = colours
            self._colours = colours

    def show(self, visible: bool) -> None:
        """Show or hide."""
        if self._handle is not None:
            self._handle.visible = visible

    def remove(self) -> None:
        """Take it out of the scene; the next `draw` puts it back."""
        if self._handle is not None:
            self._handle.remove()
        self._handle = None


class Bars:
    """Thin straight bars between pairs of points."""

    def __init__(self, scene: Any, node: str, thickness: float) -> None:
        self._thickness = thickness
        half = 0.5
        square = np.array([(-half, -half), (half, -half), (half, half), (-half, half)])
        self._copies = Instances(scene, node, shapes.prism(square, square, 0.0, 1.0))
        self.show, self.remove = self._copies.show, self._copies.remove

    def draw(self, ends: Floats, colours: Colours, visible: bool) -> None:
        """Bars for ends (n, 2, 3) [m]."""
        span = ends[:, 1] - ends[:, 0]
        length = np.maximum(np.linalg.norm(span, axis=1), 1e-6)
        side = np.full(len(length), self._thickness)
        scales = np.column_stack([side, side, length])
        self._copies.draw(ends[:, 0], aim(span / length[:, None]), scales, colours, visible)


class Arrows:
    """Arrows of a fixed girth between pairs of points."""

    def __init__(self, scene: Any, node: str, radius: float) -> None:
        self._radius = radius
        ring = np.linspace(0.0, 2 * np.pi, 10, endpoint=False)
        circle = np.column_stack([np.cos(ring), np.sin(ring)])
        self._shafts = Instances(scene, f"{node}/shafts", shapes.prism(circle, circle, 0.0, 1.0))
        tip = shapes.prism(circle, 1e-3 * circle, 0.0, 1.0)
        self._heads = Instances(scene, f"{node}/heads", tip)

    def draw(self, ends: Floats, colours: Colours, visible: bool) -> None:
        """Arrows for ends (n, 2, 3) [m]; one shorter than its head is all head."""
        span = ends[:, 1] - ends[:, 0]
        length = np.maximum(np.linalg.norm(span, axis=1), 1e-6)
        along = span / length[:, None]
        turns = aim(along)
        head = np.minimum(length, 5.5 * self._radius)
        girth = np.minimum(1.0, length / (2 * self._radius))
        thin, wide = self._radius * girth, 2.6 * self._radius * girth
        body = np.maximum(length - head, 1e-6)
        self._shafts.draw(ends[:, 0], turns, np.column_stack([thin, thin, body]), colours, visible)
        tips = ends[:, 0] + along * (length - head)[:, None]
        self._heads.draw(tips, turns, np.column_stack([wide, wide, head]), colours, visible)

    def show(self, visible: bool) -> None:
        """Show or hide."""
        self._shafts.show(visible)
        self._heads.show(visible)

    def remove(self) -> None:
        """Take them out of the scene."""
        self._shafts.remove()
        self._heads.remove()


class Plate:
    """One translucent rectangle."""

    def __init__(self, scene: Any, node: str) -> None:
        corners = np.array([[(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)]])
        mesh = shapes.polygons(corners.astype(float))
        self._copies = Instances(scene, node, mesh, opacity=0.25, side="double")
        self.show, self.remove = self._copies.show, self._copies.remove

    def draw(self, rear: Floats, front: Floats, width: float, colour: Any, visible: bool) -> None:
        """From the middle of the rear edge (3,) to that of the front edge (3,), `width` across."""
        span = front - rear
        length = max(float(np.linalg.norm(span)), 1e-6)
        half = -np.arctan2(span[2], span[0]) / 2  # about +y a positive turn lowers the front
        turn = np.array([[np.cos(half), 0.0, np.sin(half), 0.0]])
        scales = np.array([[length, width, 1.0]])
        middle = ((rear + front) / 2)[None]
        self._copies.draw(middle, turn, scales, np.array([colour], np.uint8), visible)
