"""One browser session's scene: a viser server of its own, what it shows, and its playback."""

from __future__ import annotations

import logging
import threading
import time as clock
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import rich

from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.library import load_robot
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

from . import camera as cameras
from . import client_page
from .motion import Moment, Motion, from_plan, from_rollout
from .palette import palette
from .panel import Panel
from .player import Player
from .private_server import PrivateServer
from .stage import Stage, check_layers
from .viewers import Viewers

log = logging.getLogger(__name__)
Replan = Callable[[dict[str, float]], None]

_END = 0.05  # s before its last sample, from when on a rollout that failed is marked


class SceneSession:
    """A 3-D scene of one user. Thread-safe; every method returns at once.

    Attributes:
        id: Name of the session.
        last_used: Monotonic time of the last call [s], for closing idle sessions.
    """

    def __init__(self, session_id: str, replan: Replan | None = None) -> None:
        """Start the scene's own server.

        Args:
            session_id: Names the session.
            replan: Called with the weights when a slider of the scene's own panel was moved.
        """
        self.id = session_id
        self.last_used = clock.monotonic()
        self._lock = threading.RLock()
        self._plan: Mapping[str, Any] | None = None
        self._rollout: Mapping[str, Any] | None = None
        self._compared: Mapping[str, Any] | None = None
        self._motion: Motion | None = None
        self._terrain_name: str | None = None
        self._closed = False
        # viser announces each server on the terminal; a service that opens many must not.
        rich.get_console().quiet = True
        self._private = PrivateServer("Stairwright")
        self._server = self._private.viser
        self._server.scene.world_axes.visible = False
        self._stage = Stage(self._server.scene)
        self._player = Player(self._frame)
        self._panel = Panel(self._server, self, replan)
        self._apply_theme("dark")
        self._viewers = Viewers(self._server)

    @property
    def address(self) -> Path:
        """The Unix socket that the proxy connects to."""
        return self._private.address

    @property
    def clients(self) -> int:
        """Number of connected viewers."""
        return len(self._viewers)

    @property
    def player(self) -> Player:
        """The clock."""
        return self._player

    def client_html(self, base_path: str) -> str:
        """Viser's client for this session, to be served at `base_path` (with a closing slash).

        Raises:
            InputError: If the path would make the client look for its WebSocket elsewhere.
        """
        if not (base_path.startswith("/") and base_path.endswith("/")):
            raise InputError(f"must start and end with a slash, got {base_path!r}", ("base_path",))
        self._touch()
        return client_page.client_html("Stairwright scene")

    def show(
        self,
        plan: Mapping[str, Any] | None = None,
        rollout: Mapping[str, Any] | None = None,
        theme: str | None = None,
        layers: Mapping[str, bool] | None = None,
    ) -> None:
        """Show a plan, a rollout, or both (the rollout moves, the plan's ghosts and paths stand).

        Args:
            plan: Plan document; None shows none, unless the rollout brings its own.
            rollout: Rollout document.
            theme: ``dark`` or ``light``; None keeps the present one.
            layers: Layers to show or hide; those left out stay as they are.

        Raises:
            InputError: For an unknown theme or layer.
        """
        colours = palette(theme) if theme is not None else None
        wanted = check_layers(layers or {})
        self._touch()
        with self._lock, self._server.atomic():
            if colours is not None and colours != self._stage.colours:
                self._apply_theme(colours.theme)
                self._draw_compared()
            self._stage.show_layers(wanted)
            if plan is None and rollout is not None:
                plan = rollout.get("plan")
            self._plan, self._rollout = plan, rollout
            self._redraw()
            duration = 0.0 if self._motion is None else self._motion.duration
            # With the plan, in one batch: viewers draw once, and never one plan's robot on another.
            self._draw_moment(min(self._player.time, duration))
            self._panel.show(plan, rollout, self._motion, self._stage.colours)
            self._panel.show_layers(wanted)
        self._player.set(duration=duration)

    def compare(self, plan: Mapping[str, Any] | None) -> None:
        """Show a second plan's robot beside the first, at the same place; None shows none."""
        self._touch()
        with self._lock, self._server.atomic():
            self._compared = plan
            self._draw_compared()
        self._player.set()  # draws the present moment anew

    @property
    def plan(self) -> Mapping[str, Any] | None:
        """The plan that is shown."""
        return self._plan

    @property
    def compared(self) -> str | None:
        """Id of the second plan."""
        return None if self._compared is None else str(self._compared["id"])

    def set_view(self, theme: str | None = None, layers: Mapping[str, bool] | None = None) -> None:
        """Change theme or layers and keep what is shown."""
        self.show(self._plan, self._rollout, theme, layers)

    def set_layers(self, layers: Mapping[str, bool]) -> None:
        """Show or hide layers and leave everything else.

        Raises:
            InputError: For an unknown layer.
        """
        wanted = check_layers(layers)
        self._touch()
        with self._lock, self._server.atomic():
            self._stage.show_layers(wanted)
            self._panel.show_layers(wanted)

    def playback(
        self,
        time: float | None = None,
        progress: float | None = None,
        playing: bool | None = None,
        speed: float | None = None,
    ) -> None:
        """Set the clock; what is None stays. Between calls the scene plays on by itself.

        Args:
            time: Time of the motion [s].
            progress: Place along the course [m], instead of a time.
            playing: Run or hold.
            speed: Factor on real time, above 0 and at most 20.

        Raises:
            InputError: For a value that is not finite or a speed out of bounds.
        """
        for name, value in (("time", time), ("progress", progress), ("speed", speed)):
            if value is not None and not np.isfinite(value):
                raise InputError("must be a finite number", (name,))
        if speed is not None and not 0.0 < speed <= 20.0:
            raise InputError("must be above 0 and at most 20", ("speed",))
        self._touch()
        with self._lock:
            motion = self._motion
        if time is None and progress is not None and motion is not None:
            time = motion.time_at(progress)
        self._player.set(time=time, playing=playing, speed=speed)

    def camera(self, name: str) -> None:
        """Move every viewer's camera to a preset: ``side``, ``iso``, ``front`` or ``follow``.

        Raises:
            InputError: For an unknown preset.
        """
        preset = cameras.check(name)
        self._touch()
        with self._lock:
            motion = self._motion
        self._viewers.look(preset, None if motion is None else motion.position)

    def close(self) -> None:
        """Stop playback and the server; the session cannot be used again."""
        with self._lock:
            if self._closed:
                return
            self._closed = True
        self._viewers.close()
        self._player.close()
        self._private.close()

    # -------------------------------------------------------------------------------------------

    def _touch(self) -> None:
        self.last_used = clock.monotonic()

    def _apply_theme(self, theme: str) -> None:
        colours = palette(theme)
        self._stage.repaint(colours)
        self._server.gui.configure_theme(
            dark_mode=theme == "dark",
            show_logo=False,
            show_share_button=False,
            brand_color=colours.accent,
        )

    def _draw_compared(self) -> None:
        plan = self._compared
        robot = None if plan is None else _robot_of(plan)
        motion = None if plan is None or robot is None else from_plan(plan, robot)
        self._stage.draw_rival(robot, motion)

    def _redraw(self) -> None:
        plan, rollout = self._plan, self._rollout
        source = plan or rollout
        if source is None:
            self._motion = None
            self._stage.draw_terrain(None)
            self._stage.draw_plan(None, None)
            return
        terrain = parse(Terrain, source["terrain"])
        robot = _robot_of(source)
        self._stage.draw_terrain(terrain, source.get("friction"))
        self._viewers.floor = float(terrain.vertices[:, 1].min())
        self._stage.set_robot(robot)
        planned = None if plan is None else from_plan(plan, robot)
        run = None if rollout is None else from_rollout(rollout)
        self._motion = run or planned
        self._stage.draw_plan(plan, planned)
        if terrain.name != self._terrain_name:
            # A new course is looked at afresh; an edited one keeps the user's camera.
            self._look_at_course(terrain, plan)

    def _look_at_course(self, terrain: Terrain, plan: Mapping[str, Any] | None) -> None:
        if self._motion is not None:
            course = self._motion.position
            robot = self._motion.at(self._player.time).position
        elif plan is not None and plan.get("problem") is not None:
            x, z = plan["problem"]["at"]  # no pose was found: where one should be
            robot = np.array([x, 0.0, z])
            course = robot[None]
        else:
            return
        self._terrain_name = terrain.name
        self._viewers.look_afresh(robot, cameras.following_direction(course, terrain.vertices))

    def _frame(self, time: float) -> None:
        """Draw one moment; runs on the player's thread."""
        with self._lock:
            if self._closed:
                return
            with self._server.atomic():
                moment = self._draw_moment(time)
            if moment is not None:
                self._viewers.follow(moment.position)
            self._panel.tick(time)

    def _draw_moment(self, time: float) -> Moment | None:
        motion = self._motion
        moment = None if motion is None else motion.at(time)
        progress = 0.0 if motion is None else motion.progress_at(time)
        self._stage.draw_moment(progress, moment, self._failed_by(time))
        return moment

    def _failed_by(self, time: float) -> bool:
        """Whether the rollout that is shown has ended by `time` [s] without success."""
        if self._rollout is None or self._motion is None:
            return False
        return self._rollout["outcome"] != "success" and time >= self._motion.duration - _END


def _robot_of(document: Mapping[str, Any]) -> Robot:
    """The robot that a document was made with: embedded, else by name."""
    embedded = document.get("robot_description")
    return parse(Robot, embedded) if embedded is not None else load_robot(document["robot"])
