"""The robot at one moment and all that hangs on it: drawn anew every frame."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stairwright.arrays import Floats
from stairwright.robot.description import Robot
from stairwright.robot.spatial import Bodies, place
from stairwright.terrain.profile import Terrain

from . import shapes
from .clearance import clearance, nearest
from .motion import Moment
from .overlays import Arrows, Bars, Instances, Plate
from .palette import Palette, Rgb, deep
from .robot_nodes import RobotNodes, part_colours

METRES_PER_NEWTON = 0.003


class MomentView:
    """Robot, collision points, CoM, support and forces. `layers` is shared with the stage."""

    def __init__(self, scene: Any, robot: Robot, layers: Mapping[str, bool]) -> None:
        self._robot, self._layers = robot, layers
        self._nodes = RobotNodes(scene, "/robot", robot)
        self._points = Instances(scene, "/collision_points", shapes.sphere(0.0075, 6, 8))
        self._ball = Instances(scene, "/com/ball", shapes.sphere(0.017, 8, 14))
        self._marks = Bars(scene, "/com/marks", 0.004)
        self._outline = Bars(scene, "/support/outline", 0.004)
        self._plate = Plate(scene, "/support/area")
        self._forces = Arrows(scene, "/forces", 0.006)
        self._overlays: dict[str, list[Any]] = {
            "collision_points": [self._points],
            "com": [self._ball, self._marks],
            "support": [self._outline, self._plate],
            "forces": [self._forces],
        }

    def show(self) -> None:
        """Follow the layers."""
        self._nodes.visible = self._layers["robot"]
        for layer, overlays in self._overlays.items():
            for overlay in overlays:
                overlay.show(self._layers[layer])

    def clear(self) -> None:
        """Take everything out of the scene."""
        for overlays in self._overlays.values():
            for overlay in overlays:
                overlay.remove()
        self._nodes.remove()

    def draw(
        self,
        moment: Moment,
        terrain: Terrain,
        colours: Palette,
        margin: float | None,
        problem: Mapping[str, Any] | None,
    ) -> None:
        """Draw one moment.

        Args:
            moment: The robot's state.
            terrain: What it stands on.
            colours: The theme.
            margin: CoM margin that the plan states here [m]; None takes the contacts' distance.
            problem: What stops the robot here, if it does; the part that fails turns red.
        """
        bodies = place(self._robot, moment.position, moment.quaternion, moment.q)
        self._nodes.visible = self._layers["robot"]
        self._nodes.update(bodies, colours)
        feet = nearest(terrain.vertices, bodies.wheels[0][:, [0, 2]])
        gaps = clearance(terrain.vertices, bodies.points[0][:, [0, 2]])
        self._paint(bodies, gaps, colours, problem)
        self._draw_points(bodies, gaps, colours)
        self._draw_support(bodies, feet, colours, margin)
        if moment.forces is None:
            self._forces.remove()
        else:
            self._draw_forces(bodies, feet, moment.forces, colours)

    def _draw_points(self, bodies: Bodies, gaps: Floats, colours: Palette) -> None:
        # Just outside the legs' sides, where they can be seen.
        points = bodies.points[0] + np.array([0.0, 0.016, 0.0]) * np.sign(bodies.points[0][:, 1:2])
        turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(points), 1))
        self._points.draw(
            points,
            turns,
            np.ones_like(points),
            colours.clearance_colours(gaps),
            self._layers["collision_points"],
        )

    def _draw_support(
        self, bodies: Bodies, feet: Floats, colours: Palette, margin: float | None
    ) -> None:
        """CoM, its plumb line and the quadrilateral of the contacts, coloured by the CoM margin."""
        com = bodies.com[0]
        corners = np.column_stack([feet[:, 0], bodies.wheels[0][:, 1], feet[:, 1] + 0.003])
        fl, fr, rl, rr = corners
        lo, hi = sorted((feet[:2, 0].mean(), feet[2:, 0].mean()))
        share = (com[0] - feet[2:, 0].mean()) / max(hi - lo, 1e-6)
        below = (1 - share) * (rl + rr) / 2 + share * (fl + fr) / 2
        if margin is None:
            margin = float(min(com[0] - lo, hi - com[0]))
        tint = _margin_colour(margin, colours)
        outline = np.array([[fr, fl], [fl, rl], [rl, rr], [rr, fr]])
        room = np.array([margin, 0.0, 0.0])
        marks = np.array([[com, [com[0], com[1], below[2]]], [below - room, below + room]])
        width = float(fl[1] - fr[1])
        self._plate.draw((rl + rr) / 2, (fl + fr) / 2, width, tint, self._layers["support"])
        self._outline.draw(outline, _rows(tint, 4), self._layers["support"])
        self._marks.draw(marks, _rows(deep(colours.com), 2), self._layers["com"])
        still = np.array([[1.0, 0.0, 0.0, 0.0]])
        self._ball.draw(
            com[None], still, np.ones((1, 3)), _rows(deep(colours.com), 1), self._layers["com"]
        )

    def _draw_forces(self, bodies: Bodies, feet: Floats, forces: Floats, colours: Palette) -> None:
        wheels = bodies.wheels[0]
        width = self._robot.wheel.width
        y = wheels[:, 1] + np.sign(wheels[:, 1]) * 0.75 * width  # beside the wheel, not inside it
        start = np.column_stack([feet[:, 0], y, feet[:, 1]])
        end = start + METRES_PER_NEWTON * np.column_stack([forces[:, 0], np.zeros(4), forces[:, 1]])
        ends = np.stack([start, end], axis=1)
        self._forces.draw(ends, _rows(deep(colours.force), 4), self._layers["forces"])

    def _paint(
        self,
        bodies: Bodies,
        gaps: Floats,
        colours: Palette,
        problem: Mapping[str, Any] | None,
    ) -> None:
        if problem is None:
            return
        part, pair = _culprit(problem, self._robot, bodies, gaps)
        red = part_colours(colours)[part].copy()
        red[slice(None) if part == "trunk" else [2 * pair, 2 * pair + 1]] = deep(colours.error)
        self._nodes.paint(part, red)


def _culprit(
    problem: Mapping[str, Any], robot: Robot, bodies: Bodies, gaps: Floats
) -> tuple[str, int]:
    """Kind of part and leg pair (0 front, 1 rear) that the problem is about."""
    layout = robot.points
    if problem["kind"] == "clearance":
        k = int(np.argmin(gaps[: layout.count]))
        if k < len(layout.trunk):
            return "trunk", 0
        pair, k = divmod(k - len(layout.trunk), len(layout.thigh) + len(layout.calf))
        return ("thighs" if k < len(layout.thigh) else "calves"), pair
    if problem["kind"] == "statics":
        return "trunk", 0
    away = np.hypot(*(bodies.wheels[0][[0, 2]][:, [0, 2]] - problem["at"]).T)
    return "calves", int(np.argmin(away))


def _margin_colour(margin: float, colours: Palette) -> Rgb:
    ample, fair, thin, critical = (deep(colour) for colour in colours.strip)
    if margin >= 0.04:
        return ample
    if margin >= 0.02:
        return fair
    return thin if margin >= 0.005 else critical


def _rows(colour: Rgb, count: int) -> NDArray[np.uint8]:
    return np.tile(np.array(colour, np.uint8), (count, 1))
