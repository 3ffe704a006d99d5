"""What stands in the scene: terrain, robot, ghosts, paths, forces, margins and the problem."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError
from stairwright.robot.description import Robot
from stairwright.robot.spatial import Bodies, place
from stairwright.terrain.profile import Terrain

from . import shapes
from .moment_view import MomentView
from .motion import Moment, Motion
from .nodes import Nodes
from .palette import DARK, Palette
from .rival import Rival
from .robot_nodes import RobotNodes

LAYERS = {
    "terrain": True,
    "grid": True,
    "robot": True,
    "ghosts": True,
    "collision_points": True,
    "wheel_path": True,
    "com_path": True,
    "com": True,
    "support": True,
    "forces": True,
    "problem": True,
    "compare": True,
}
DEPTH = 0.25  # m, of solid below its lowest point
GHOST_SPACING = 0.20  # m between trunks; nearer ghosts hide one another
MAX_GHOSTS = 20
DASH = 0.022  # m


def check_layers(layers: Mapping[str, Any]) -> dict[str, bool]:
    """Layer names and whether they are shown.

    Raises:
        InputError: For an unknown name or a value that is not a truth value.
    """
    for name, shown in layers.items():
        if name not in LAYERS:
            raise InputError(f"unknown layer; there are: {', '.join(LAYERS)}", ("layers", name))
        if not isinstance(shown, bool):
            raise InputError("must be true or false", ("layers", name))
    return dict(layers)


class Stage:
    """Draws into one viser scene. Not thread-safe: the session holds the lock.

    Node names are fixed, so that drawing again replaces; unique names would leave tombstones.
    """

    def __init__(self, scene: Any) -> None:
        self._scene = scene
        self.colours: Palette = DARK
        self.layers = dict(LAYERS)
        self._terrain: Terrain | None = None
        self._robot: Robot | None = None
        self._nodes = Nodes(scene, self.layers)
        self._view: MomentView | None = None
        self._ghosts: RobotNodes | None = None
        self._rival: Rival | None = None
        self._margins: tuple[Floats, Floats] | None = None  # progress, CoM margin
        self._problem: Mapping[str, Any] | None = None
        self._problem_from = np.inf
        self._ground: object = None  # what the terrain's and the grid's nodes were drawn from
        self._grid: object = None
        self.draw_lights()
        self.draw_grid()

    # --- what rarely changes -------------------------------------------------------------------

    def draw_lights(self) -> None:
        """Three lights without shadows, and the sky's.

        viser's default light casts cascaded shadows whose borders show on large plain faces, and
        shadows and environment maps cost most of a frame where there is no graphics card.
        """
        dark = self.colours.theme == "dark"
        self._scene.configure_default_lights(enabled=False)
        self._scene.configure_environment_map(None)
        for name, position, strength in (
            ("key", (-1.0, -1.2, 4.0), 1.7 if dark else 2.2),
            ("fill", (-3.0, -4.0, 1.6), 0.9 if dark else 1.3),
        ):
            self._scene.add_light_directional(
                f"/lights/{name}", intensity=strength, position=position, cast_shadow=False
            )
        self._scene.add_light_hemisphere(
            "/lights/sky",
            sky_color=(255, 255, 255),
            ground_color=(150, 160, 175),
            intensity=0.8 if dark else 1.2,
        )

    def draw_grid(self) -> None:
        """The floor grid, below the terrain."""
        c = self.colours
        floor = 0.0
        if self._terrain is not None:
            floor = float(self._terrain.vertices[:, 1].min()) - DEPTH
        centre = 0.0 if self._terrain is None else round(float(self._terrain.vertices[:, 0].mean()))
        drawn = (c, floor, centre)
        if drawn == self._grid:
            return
        self._grid = drawn
        self._nodes.keep(
            "grid",
            "/grid",
            self._scene.add_grid(
                "/grid",
                width=24.0,
                height=24.0,
                cell_size=0.25,
                section_size=1.0,
                cell_color=c.grid_cell,
                section_color=c.grid_section,
                cell_thickness=0.8,
                section_thickness=1.0,
                fade_distance=9.0,
                fade_strength=1.6,
                shadow_opacity=0.18,
                position=(centre, 0.0, floor),
                visible=self.layers["grid"],
            ),
        )

    def draw_terrain(self, terrain: Terrain | None, friction: float | None = None) -> None:
        """The extruded profile, its faces tinted by friction; None clears it."""
        self._terrain = terrain
        if terrain is None:
            self._ground = None
            self._nodes.drop("terrain")
            self.draw_grid()
            return
        mu = terrain.friction if friction is None else friction
        ground = (terrain.hash, mu, self.colours)
        if ground == self._ground:
            return
        self._ground = ground
        solid = shapes.extrude(terrain.vertices, shapes.HALF_WIDTH, DEPTH)
        tints = self.colours.terrain(mu)
        for name, mesh, tint in zip(("treads", "risers", "flanks"), solid[:3], tints, strict=True):
            self._nodes.mesh("terrain", f"/terrain/{name}", mesh, tint, flat=True)
        self._nodes.lines("terrain", "/terrain/edges", solid.edges, self.colours.edge, 1.4)
        self.draw_grid()

    def set_robot(self, robot: Robot) -> None:
        """Which robot is drawn from now on."""
        if robot == self._robot:
            return
        if self._view is not None and self._ghosts is not None:
            self._view.clear()
            self._ghosts.remove()
        self._robot = robot
        self._view = MomentView(self._scene, robot, self.layers)
        self._ghosts = RobotNodes(self._scene, "/ghosts", robot, opacity=self.colours.ghost_opacity)

    def draw_plan(self, plan: Mapping[str, Any] | None, motion: Motion | None) -> None:
        """Ghosts of the key poses, the paths of wheel centres and CoM, and the problem."""
        self._problem, self._problem_from, self._margins = None, np.inf, None
        self._nodes.drop("problem")
        if plan is None or motion is None:
            self._nodes.drop("wheel_path")
            self._nodes.drop("com_path")
        if self._ghosts is not None and (plan is None or motion is None or not plan["critical"]):
            self._ghosts.remove()
        problem = None if plan is None else plan.get("problem")
        if problem is not None:
            self._draw_problem(problem)
        if plan is None or motion is None or self._robot is None:
            return
        poses = plan["poses"]
        progress = np.array([pose["progress"] for pose in poses], float)
        times = np.interp(progress, motion.progress, motion.time)
        self._margins = (progress, np.array([pose["margins"]["com"] for pose in poses], float))
        bodies = place(self._robot, motion.position, motion.quaternion, motion.q)
        self._draw_paths(bodies)
        self._draw_ghosts(plan, motion, times)
        if problem is not None:
            self._problem = problem
            # The paper's and the nominal method list poses beyond the one that fails.
            self._problem_from = min(problem["progress"], progress[-1]) - 1e-4

    def draw_rival(self, robot: Robot | None, motion: Motion | None) -> None:
        """A second plan's robot beside the first; None takes it away."""
        if self._rival is not None:
            self._rival.remove()
            self._rival = None
        if robot is not None and motion is not None:
            self._rival = Rival(self._scene, self._nodes, robot, motion)
            self._rival.draw_path(self.colours)

    # --- every frame ---------------------------------------------------------------------------

    def draw_moment(self, progress: float, moment: Moment | None, failed: bool = False) -> None:
        """The robot at one moment, `progress` [m] along the course; red where it `failed`."""
        if self._rival is not None:
            self._rival.draw_at(progress, self.colours, self.layers["compare"])
        if self._view is None:
            return
        if moment is None or self._terrain is None:
            self._view.clear()
            return
        margin = None if self._margins is None else float(np.interp(progress, *self._margins))
        failing = self._problem if progress >= self._problem_from else None
        colours = replace(self.colours, trunk=self.colours.error) if failed else self.colours
        self._view.draw(moment, self._terrain, colours, margin, failing)

    def show_layers(self, layers: Mapping[str, bool]) -> None:
        """Show or hide layers by name."""
        self.layers.update(layers)
        self._nodes.show()
        if self._view is not None:
            self._view.show()
        if self._ghosts is not None:
            self._ghosts.visible = self.layers["ghosts"]
        if self._rival is not None:
            self._rival.show(self.layers["compare"])

    def repaint(self, colours: Palette) -> None:
        """Take another palette; what hangs on it must be drawn again by the caller."""
        self.colours = colours
        self.draw_lights()
        if self._robot is not None and self._ghosts is not None:
            self._ghosts.remove()
            self._ghosts = RobotNodes(
                self._scene, "/ghosts", self._robot, opacity=colours.ghost_opacity
            )

    # --- parts ---------------------------------------------------------------------------------

    def _draw_paths(self, bodies: Bodies) -> None:
        y = self._robot.hips.half_track if self._robot is not None else 0.0
        width = self._robot.wheel.width if self._robot is not None else 0.0
        # Beside the wheels, on the camera's side, where nothing covers them.
        path = bodies.wheels[:, 1].copy()
        rear = bodies.wheels[:, 3].copy()
        course = np.concatenate([rear[rear[:, 0] < path[0, 0]], path])
        course[:, 1] = -y - 0.7 * width
        self._nodes.lines("wheel_path", "/wheel_path", _dashes(course), self.colours.path, 1.6)
        com = bodies.com.copy()
        self._nodes.lines(
            "com_path", "/com_path", np.stack([com[:-1], com[1:]], 1), self.colours.com, 2.0
        )

    def _draw_ghosts(self, plan: Mapping[str, Any], motion: Motion, times: Floats) -> None:
        if self._robot is None or self._ghosts is None or not plan["critical"]:
            return
        moments = _apart([motion.at(float(times[k])) for k in plan["critical"]], GHOST_SPACING)
        bodies = place(
            self._robot,
            np.array([m.position for m in moments]),
            np.array([m.quaternion for m in moments]),
            np.array([m.q for m in moments]),
        )
        self._ghosts.visible = self.layers["ghosts"]
        self._ghosts.update(bodies, self.colours)

    def _draw_problem(self, problem: Mapping[str, Any]) -> None:
        x, z = problem["at"]
        y = self._robot.hips.half_track if self._robot is not None else 0.0
        halo = shapes.ring(0.052, 0.042, 0.010, 0.002)
        both = shapes.merge(*(shapes.moved(halo, (x, side * (y + 0.03), z)) for side in (-1, 1)))
        line = np.array([[(x, side * shapes.HALF_WIDTH, z) for side in (-1, 1)]])
        self._nodes.mesh("problem", "/problem/halo", both, self.colours.error)
        self._nodes.lines("problem", "/problem/line", line, self.colours.error, 3.0)


def _apart(moments: list[Moment], spacing: float) -> list[Moment]:
    """First and last, and of those between at most `MAX_GHOSTS` that stand `spacing` apart."""
    kept: list[Moment] = []
    for moment in moments:
        if not kept or np.linalg.norm(moment.position - kept[-1].position) >= spacing:
            kept.append(moment)
    if len(kept) > MAX_GHOSTS:
        kept = [kept[i] for i in np.linspace(0, len(kept) - 1, MAX_GHOSTS).round().astype(int)]
    return kept


def _dashes(course: Floats) -> Floats:
    """Every second piece (k, 2, 3) of a polyline (n, 3) cut evenly by arc length."""
    step = np.hypot(*np.diff(course[:, [0, 2]], axis=0).T)
    s = np.concatenate([[0.0], np.cumsum(step)])
    grid = np.arange(0.0, s[-1], DASH)
    points = np.column_stack([np.interp(grid, s, column) for column in course.T])
    count = len(points) // 2 * 2
    return points[:count].reshape(-1, 2, 3)
