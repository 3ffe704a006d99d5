"""A second plan to compare with: its robot at the same place, translucent, its path dashed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from stairwright.robot.description import Robot
from stairwright.robot.spatial import place

from .motion import Motion
from .nodes import Nodes
from .palette import Palette
from .robot_nodes import RobotNodes

OPACITY = 0.5
LAYER = "compare"


class Rival:
    """Draws the other plan's robot and the path of its CoM."""

    def __init__(self, scene: Any, nodes: Nodes, robot: Robot, motion: Motion) -> None:
        self._nodes, self._robot, self._motion = nodes, robot, motion
        self._figure = RobotNodes(scene, "/compare/robot", robot, opacity=OPACITY)

    def draw_path(self, colours: Palette) -> None:
        """The path of its CoM; once, and again when the palette changes."""
        m = self._motion
        com = place(self._robot, m.position, m.quaternion, m.q).com
        dashes = np.stack([com[:-1], com[1:]], 1)[::2]
        self._nodes.lines(LAYER, "/compare/com_path", dashes, colours.com, 2.0)

    def draw_at(self, progress: float, colours: Palette, shown: bool) -> None:
        """The robot where it would be at `progress` [m] along the course."""
        moment = self._motion.at(self._motion.time_at(progress))
        bodies = place(self._robot, moment.position, moment.quaternion, moment.q)
        self._figure.visible = shown
        self._figure.update(bodies, replace(colours, trunk=colours.com))

    def show(self, shown: bool) -> None:
        """Show or hide."""
        self._figure.visible = shown

    def remove(self) -> None:
        """Take it out of the scene."""
        self._figure.remove()
        self._nodes.drop(LAYER)
