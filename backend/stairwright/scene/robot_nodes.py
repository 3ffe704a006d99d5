"""The robot in viser: a handful of batched nodes, so that a frame costs few messages."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stairwright.arrays import Floats
from stairwright.robot.description import Robot
from stairwright.robot.spatial import Bodies

from . import shapes
from .palette import Palette, deep

PARTS = ("trunk", "trim", "thighs", "calves", "motors", "knees", "tyres", "rims")


def part_meshes(robot: Robot) -> dict[str, shapes.Mesh]:
    """One mesh per kind of part, in the part's own frame; thighs and calves are the front ones."""
    leg = robot.legs[0]
    width = min(0.9 * robot.wheel.width, 0.028)
    return {
        "trunk": shapes.trunk(robot),
        "trim": shapes.trunk_trim(robot),
        "thighs": shapes.limb(leg.thigh, width),
        "calves": shapes.limb(leg.calf, 0.8 * width),
        "motors": shapes.joint(max(1.7 * leg.thigh.radius, 0.02), 1.25 * width),
        "knees": shapes.joint(max(1.25 * leg.thigh.radius, 0.015), 1.1 * width),
        "tyres": shapes.tyre(robot),
        "rims": shapes.rim(robot),
    }


def part_scales(robot: Robot) -> dict[str, Floats]:
    """Scales (4, 3) that make the legs' own thighs and calves of the front ones."""
    front, rear = robot.legs
    scales = {}
    for part, name in (("thighs", "thigh"), ("calves", "calf")):
        ratio = getattr(rear, name).length / getattr(front, name).length
        scales[part] = np.array([[1, 1, 1], [1, 1, 1], [1, 1, ratio], [1, 1, ratio]], float)
    return scales


def part_places(bodies: Bodies) -> dict[str, tuple[Floats, Floats]]:
    """Positions (k, 3) and quaternions wxyz (k, 4) of every part, legs FL, FR, RL, RR in turn."""
    flat = (-1, 3)
    turns = (-1, 4)
    return {
        "trunk": (bodies.trunk, bodies.trunk_turn),
        "trim": (bodies.trunk, bodies.trunk_turn),
        "thighs": (bodies.hips.reshape(flat), bodies.thigh_turn.reshape(turns)),
        "calves": (bodies.knees.reshape(flat), bodies.calf_turn.reshape(turns)),
        "motors": (bodies.hips.reshape(flat), bodies.thigh_turn.reshape(turns)),
        "knees": (bodies.knees.reshape(flat), bodies.calf_turn.reshape(turns)),
        "tyres": (bodies.wheels.reshape(flat), bodies.wheel_turn.reshape(turns)),
        "rims": (bodies.wheels.reshape(flat), bodies.wheel_turn.reshape(turns)),
    }


def part_colours(colours: Palette, count: int = 1) -> dict[str, NDArray[np.uint8]]:
    """(k, 3) colours for `count` robots: a leg keeps its colour in editor, scene and plots."""
    front, rear = deep(colours.front), deep(colours.rear)
    legs = np.array([front, front, rear, rear], np.uint8)
    shade = (0.82 * legs).astype(np.uint8)

    def tiled(rows: object) -> NDArray[np.uint8]:
        return np.tile(np.asarray(rows, np.uint8).reshape(-1, 3), (count, 1))

    return {
        "trunk": tiled(colours.trunk if count == 1 else colours.trim),
        "trim": tiled(colours.trim),
        "thighs": tiled(legs),
        "calves": tiled(legs),
        "motors": tiled(shade),
        "knees": tiled(shade),
        "tyres": tiled([colours.tyre] * 4),
        "rims": tiled(legs),
    }


class RobotNodes:
    """`count` robots of one kind under a viser node, moved together by `update`."""

    def __init__(self, scene: Any, root: str, robot: Robot, opacity: float | None = None) -> None:
        self._scene, self._root, self._opacity = scene, root, opacity
        self._meshes, self._scales = part_meshes(robot), part_scales(robot)
        self._parts = [p for p in PARTS if opacity is None or p not in ("trim", "rims", "motors")]
        self._handles: dict[str, Any] = {}
        self._count = 0
        self._colours: dict[str, NDArray[np.uint8]] = {}
        self._visible = True

    def update(self, bodies: Bodies, colours: Palette) -> None:
        """Move all parts; nodes are made anew only when the number of robots changes."""
        count = len(bodies.trunk)
        wanted = part_colours(colours, count)
        places = part_places(bodies)
        for part in self._parts:
            positions, turns = places[part]
            if count != self._count:
                self._make(part, positions, turns, wanted[part])
                continue
            handle = self._handles[part]
            handle.batched_positions = positions.astype(np.float32)
            handle.batched_wxyzs = turns.astype(np.float32)
            if part not in self._colours or not np.array_equal(self._colours[part], wanted[part]):
                handle.batched_colors = wanted[part]
        self._count, self._colours = count, wanted

    def paint(self, part: str, colours: NDArray[np.uint8]) -> None:
        """Override the colours (k, 3) of one kind of part until the next change."""
        if part in self._handles and not np.array_equal(self._colours[part], colours):
            self._handles[part].batched_colors = colours
            self._colours = {**self._colours, part: colours}

    @property
    def visible(self) -> bool:
        """Whether the nodes are shown."""
        return self._visible

    @visible.setter
    def visible(self, value: bool) -> None:
        self._visible = value
        for handle in self._handles.values():
            handle.visible = value

    def remove(self) -> None:
        """Take the nodes out of the scene."""
        for handle in self._handles.values():
            handle.remove()
        self._handles, self._count, self._colours = {}, 0, {}

    def _make(self, part: str, positions: Floats, turns: Floats, colours: Any) -> None:
        mesh, scales = self._meshes[part], self._scales.get(part)
        self._handles[part] = self._scene.add_batched_meshes_simple(
            f"{self._root}/{part}",
            mesh.vertices,
            mesh.faces,
            turns,
            positions,
            batched_colors=colours,
            batched_scales=None if scales is None else np.tile(scales, (len(turns) // 4, 1)),
            opacity=self._opacity,
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
            visible=self._visible,
        )
