"""What stands in the scene: terrain, robot, ghosts, paths, forces, margins and the problem."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stairwright.errors import InputError
from stairwright.robot.description import Robot
from stairwright.robot.spatial import Bodies, place
from stairwright.terrain.profile import Terrain

from . import shapes
from .clearance import clearance, nearest
from .motion import Moment, Motion
from .overlays import Arrows, Bars, Instances, Plate
from .palette import DARK, Palette, deep
from .robot_nodes import RobotNodes, part_colours

Floats = NDArray[np.float64]

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
}
HALF_WIDTH = 0.5  # m, of the extruded terrain
DEPTH = 0.25  # m, of solid below its lowest point
GHOST_SPACING = 0.20  # m between trunks; nearer ghosts hide one another
MAX_GHOSTS = 20
METRES_PER_NEWTON = 0.003


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
        self._nodes: RobotNodes | None = None
        self._ghosts: RobotNodes | None = None
        self._handles: dict[str, tuple[str, Any]] = {}  # node -> (layer, handle)
        self._margins: tuple[Floats, Floats] | None = None  # time, CoM margin
        self._problem: Mapping[str, Any] | None = None
        self._problem_from = np.inf
        self._ground: object = None  # what the terrain's and the grid's nodes were drawn from
        self._grid: object = None
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
        self._keep(
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
            self._drop("terrain")
            self.draw_grid()
            return
        mu = terrain.friction if friction is None else friction
        ground = (terrain.hash, mu, self.colours)
        if ground == self._ground:
            return
        self._ground = ground
        solid = shapes.extrude(terrain.vertices, HALF_WIDTH, DEPTH)
        tints = self.colours.terrain(mu)
        for name, mesh, tint in zip(("treads", "risers", "flanks"), solid[:3], tints, strict=True):
            node = f"/terrain/{name}"
            handle = self._scene.add_mesh_simple(
                node,
                mesh.vertices,
                mesh.faces,
                color=tint,
                flat_shading=True,
                side="double",
                visible=self.layers["terrain"],
            )
            self._keep("terrain", node, handle)
        self._lines("terrain", "/terrain/edges", solid.edges, self.colours.edge, 1.4)
        self.draw_grid()

    def set_robot(self, robot: Robot) -> None:
        """Which robot is drawn from now on."""
        if robot == self._robot:
            return
        for nodes in (self._nodes, self._ghosts):
            if nodes is not None:
                nodes.remove()
        self._robot = robot
        self._nodes = RobotNodes(self._scene, "/robot", robot)
        self._ghosts = RobotNodes(self._scene, "/ghosts", robot, opacity=self.colours.ghost_opacity)

    def draw_plan(self, plan: Mapping[str, Any] | None, motion: Motion | None) -> None:
        """Ghosts of the key poses, the paths of wheel centres and CoM, and the problem."""
        self._problem, self._problem_from, self._margins = None, np.inf, None
        self._drop("problem")
        if plan is None or motion is None:
            self._drop("wheel_path")
            self._drop("com_path")
        if self._ghosts is not None and (plan is None or motion is None or not plan["critical"]):
            self._ghosts.remove()
        if plan is None or motion is None or self._robot is None:
            return
        poses = plan["poses"]
        times = np.interp([p["progress"] for p in poses], motion.progress, motion.time)
        self._margins = (times, np.array([pose["margins"]["com"] for pose in poses], float))
        bodies = place(self._robot, motion.position, motion.quaternion, motion.q)
        self._draw_paths(bodies)
        self._draw_ghosts(plan, motion, times)
        if plan.get("problem") is not None:
            self._problem = plan["problem"]
            # The paper's and the nominal method list poses beyond the one that fails.
            self._problem_from = motion.time_at(plan["problem"]["progress"]) - 1e-3
            self._draw_problem(plan["problem"])

    # --- every frame ---------------------------------------------------------------------------

    def draw_moment(self, time: float, moment: Moment | None) -> Bodies | None:
        """The robot at one moment with everything that hangs on it."""
        if moment is None or self._robot is None or self._nodes is None:
            self._clear_moment()
            return None
        if moment.forces is None:
            self._forces.remove()
        bodies = place(self._robot, moment.position, moment.quaternion, moment.q)
        self._nodes.visible = self.layers["robot"]
        self._nodes.update(bodies, self.colours)
        if self._terrain is None:
            return bodies
        feet = nearest(self._terrain.vertices, bodies.wheels[0][:, [0, 2]])
        gaps = clearance(self._terrain.vertices, bodies.points[0][:, [0, 2]])
        self._draw_points(bodies, gaps)
        self._draw_support(time, bodies, feet)
        if moment.forces is not None:
            self._draw_forces(bodies, feet, moment.forces)
        self._paint_problem(time, bodies, gaps)
        return bodies

    def show_layers(self, layers: Mapping[str, bool]) -> None:
        """Show or hide layers by name."""
        self.layers.update(layers)
        for layer, handle in self._handles.values():
            handle.visible = self.layers[layer]
        for layer, overlays in self._overlays.items():
            for overlay in overlays:
                overlay.show(self.layers[layer])
        for name, nodes in (("robot", self._nodes), ("ghosts", self._ghosts)):
            if nodes is not None:
                nodes.visible = self.layers[name]

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
        self._lines("wheel_path", "/wheel_path", _dashes(course), self.colours.path, 1.6)
        com = bodies.com.copy()
        self._lines(
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

    def _draw_points(self, bodies: Bodies, gaps: Floats) -> None:
        # Just outside the legs' sides, where they can be seen.
        points = bodies.points[0] + np.array([0.0, 0.016, 0.0]) * np.sign(bodies.points[0][:, 1:2])
        turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(points), 1))
        self._points.draw(
            points,
            turns,
            np.ones_like(points),
            self.colours.clearance_colours(gaps),
            self.layers["collision_points"],
        )

    def _draw_support(self, time: float, bodies: Bodies, feet: Floats) -> None:
        """CoM, its plumb line and the quadrilateral of the contacts, coloured by the CoM margin."""
        com = bodies.com[0]
        corners = np.column_stack([feet[:, 0], bodies.wheels[0][:, 1], feet[:, 1] + 0.003])
        fl, fr, rl, rr = corners
        lo, hi = sorted((feet[:2, 0].mean(), feet[2:, 0].mean()))
        share = (com[0] - feet[2:, 0].mean()) / max(hi - lo, 1e-6)
        below = (1 - share) * (rl + rr) / 2 + share * (fl + fr) / 2
        margin = min(com[0] - lo, hi - com[0])
        if self._margins is not None:
            margin = float(np.interp(time, *self._margins))
        tint = self._margin_colour(margin)
        outline = np.array([[fr, fl], [fl, rl], [rl, rr], [rr, fr]])
        room = np.array([margin, 0.0, 0.0])
        marks = np.array([[com, [com[0], com[1], below[2]]], [below - room, below + room]])
        width = float(fl[1] - fr[1])
        self._plate.draw((rl + rr) / 2, (fl + fr) / 2, width, tint, self.layers["support"])
        self._outline.draw(outline, _rows(tint, 4), self.layers["support"])
        self._marks.draw(marks, _rows(deep(self.colours.com), 2), self.layers["com"])
        still = np.array([[1.0, 0.0, 0.0, 0.0]])
        self._ball.draw(
            com[None], still, np.ones((1, 3)), _rows(deep(self.colours.com), 1), self.layers["com"]
        )

    def _draw_forces(self, bodies: Bodies, feet: Floats, forces: Floats) -> None:
        wheels = bodies.wheels[0]
        width = self._robot.wheel.width if self._robot is not None else 0.03
        y = wheels[:, 1] + np.sign(wheels[:, 1]) * 0.75 * width  # beside the wheel, not inside it
        start = np.column_stack([feet[:, 0], y, feet[:, 1]])
        end = start + METRES_PER_NEWTON * np.column_stack([forces[:, 0], np.zeros(4), forces[:, 1]])
        ends = np.stack([start, end], axis=1)
        self._forces.draw(ends, _rows(deep(self.colours.force), 4), self.layers["forces"])

    def _draw_problem(self, problem: Mapping[str, Any]) -> None:
        x, z = problem["at"]
        y = self._robot.hips.half_track if self._robot is not None else 0.0
        halo = shapes.ring(0.052, 0.042, 0.010, 0.002)
        both = shapes.merge(*(shapes.moved(halo, (x, side * (y + 0.03), z)) for side in (-1, 1)))
        line = np.array([[(x, -HALF_WIDTH, z), (x, HALF_WIDTH, z)]])
        self._mesh("problem", "/problem/halo", both, self.colours.error)
        self._lines("problem", "/problem/line", line, self.colours.error, 3.0)

    def _paint_problem(self, time: float, bodies: Bodies, gaps: Floats) -> None:
        """Turn red what cannot go on: the link that cuts, or the leg nearest to the place."""
        if self._nodes is None or self._robot is None:
            return
        usual = part_colours(self.colours)
        if self._problem is None or time < self._problem_from:
            for part in ("thighs", "calves", "trunk"):
                self._nodes.paint(part, usual[part])
            return
        part, pair = self._culprit(self._problem, bodies, gaps)
        red = usual[part].copy()
        red[slice(None) if part == "trunk" else [2 * pair, 2 * pair + 1]] = deep(self.colours.error)
        self._nodes.paint(part, red)

    def _culprit(self, problem: Mapping[str, Any], bodies: Bodies, gaps: Floats) -> tuple[str, int]:
        """Kind of part and leg pair (0 front, 1 rear) that the problem is about."""
        assert self._robot is not None
        layout = self._robot.collision_points
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

    def _margin_colour(self, margin: float) -> tuple[int, int, int]:
        ample, fair, thin, critical = (deep(colour) for colour in self.colours.strip)
        if margin >= 0.04:
            return ample
        if margin >= 0.02:
            return fair
        return thin if margin >= 0.005 else critical

    # --- bookkeeping ---------------------------------------------------------------------------

    def _clear_moment(self) -> None:
        for overlays in self._overlays.values():
            for overlay in overlays:
                overlay.remove()
        if self._nodes is not None:
            self._nodes.remove()

    def _keep(self, layer: str, node: str, handle: Any) -> None:
        self._handles[node] = (layer, handle)

    def _drop(self, layer: str) -> None:
        for node in [n for n, (of, _) in self._handles.items() if of == layer]:
            self._handles.pop(node)[1].remove()

    def _mesh(
        self,
        layer: str,
        node: str,
        mesh: shapes.Mesh,
        colour: tuple[int, int, int],
        opacity: float | None = None,
    ) -> None:
        if node in self._handles:
            handle = self._handles[node][1]
            handle.vertices = mesh.vertices.astype(np.float32)
            handle.color = colour
            return
        handle = self._scene.add_mesh_simple(
            node,
            mesh.vertices,
            mesh.faces,
            color=colour,
            opacity=opacity,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
            visible=self.layers[layer],
        )
        self._keep(layer, node, handle)

    def _lines(
        self,
        layer: str,
        node: str,
        segments: Floats,
        colour: tuple[int, int, int],
        pixels: float,
    ) -> None:
        if len(segments) == 0:
            segments = np.zeros((1, 2, 3))
        if node in self._handles:
            handle = self._handles[node][1]
            handle.points = segments.astype(np.float32)
            handle.colors = np.array(colour, np.uint8)
            return
        handle = self._scene.add_line_segments(
            node,
            segments.astype(np.float32),
            colour,
            thickness=pixels,
            thickness_units="screen",
            visible=self.layers[layer],
        )
        self._keep(layer, node, handle)


def _rows(colour: tuple[int, int, int], count: int) -> NDArray[np.uint8]:
    return np.tile(np.array(colour, np.uint8), (count, 1))


def _apart(moments: list[Moment], spacing: float) -> list[Moment]:
    """First and last, and of those between at most `MAX_GHOSTS` that stand `spacing` apart."""
    kept: list[Moment] = []
    for moment in moments:
        if not kept or np.linalg.norm(moment.position - kept[-1].position) >= spacing:
            kept.append(moment)
    if len(kept) > MAX_GHOSTS:
        kept = [kept[i] for i in np.linspace(0, len(kept) - 1, MAX_GHOSTS).round().astype(int)]
    return kept


def _dashes(course: Floats, dash: float = 0.022) -> Floats:
    """Every second piece (k, 2, 3) of a polyline (n, 3) cut evenly by arc length."""
    step = np.hypot(*np.diff(course[:, [0, 2]], axis=0).T)
    s = np.concatenate([[0.0], np.cumsum(step)])
    grid = np.arange(0.0, s[-1], dash)
    points = np.column_stack([np.interp(grid, s, column) for column in course.T])
    count = len(points) // 2 * 2
    return points[:count].reshape(-1, 2, 3)
