"""One browser session's scene: a viser server of its own, what it shows, and its playback."""

from __future__ import annotations

import threading
import time as clock
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import rich

from stairwright.errors import InputError
from stairwright.terrain.profile import Terrain

from . import camera as cameras
from . import client_page
from .palette import palette
from .panel import Panel
from .player import Player
from .private_server import PrivateServer
from .shown import Document, Shown
from .stage import Stage, check_layers
from .viewers import Viewers

Replan = Callable[[dict[str, float]], None]


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
        self._shown = Shown()
        self._compared: Document | None = None
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
        self._server.on_client_connect(lambda _: self._player.set())

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
        plan: Document | None = None,
        rollout: Document | None = None,
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
            self._shown = shown = Shown(plan, rollout)
            self._redraw()
            duration = 0.0 if shown.motion is None else shown.motion.duration
            # With the plan, in one batch: viewers draw once, and never one plan's robot on another.
            self._draw_moment(min(self._player.time, duration))
            self._panel.show(shown.plan, rollout, shown.motion, self._stage.colours)
            self._panel.show_layers(wanted)
        self._player.set(duration=duration)

    def compare(self, plan: Document | None) -> None:
        """Show a second plan's robot beside the first, at the same place; None shows none."""
        self._touch()
        with self._lock, self._server.atomic():
            self._compared = plan
            self._draw_compared()
        self._player.set()  # draws the present moment anew

    @property
    def plan(self) -> Document | None:
        """The plan that is shown."""
        return self._shown.plan

    @property
    def compared(self) -> str | None:
        """Id of the second plan."""
        return None if self._compared is None else str(self._compared["id"])

    def set_view(self, theme: str | None = None, layers: Mapping[str, bool] | None = None) -> None:
        """Change theme or layers and keep what is shown."""
        self.show(self._shown.plan, self._shown.rollout, theme, layers)

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
            motion = self._shown.motion
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
            motion = self._shown.motion
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
        rival = Shown(self._compared)
        self._stage.draw_rival(rival.robot, rival.planned)

    def _redraw(self) -> None:
        shown, stage = self._shown, self._stage
        stage.draw_terrain(shown.terrain, shown.friction)
        if shown.terrain is not None:
            self._viewers.floor = float(shown.terrain.vertices[:, 1].min())
        if shown.robot is not None:
            stage.set_robot(shown.robot)
        stage.draw_plan(shown.plan, shown.planned)
        if shown.terrain is not None and shown.terrain.name != self._terrain_name:
            # A new course is looked at afresh; an edited one keeps the user's camera.
            self._look_at_course(shown.terrain)

    def _look_at_course(self, terrain: Terrain) -> None:
        robot, motion = self._shown.place(self._player.time), self._shown.motion
        if robot is None:
            return
        course = robot[None] if motion is None else motion.position
        self._terrain_name = terrain.name
        self._viewers.look_afresh(robot, cameras.following_direction(course, terrain.vertices))

    def _frame(self, time: float) -> None:
        """Draw one moment if somebody looks; runs on the player's thread."""
        with self._lock:
            if self._closed:
                return
            motion = self._shown.motion
            if motion is not None:
                self._viewers.follow(motion.at(time).position)
            if not self._viewers:  # who comes has the player draw anew
                return
            with self._server.atomic():
                self._draw_moment(time)
            self._panel.tick(time)

    def _draw_moment(self, time: float) -> None:
        motion = self._shown.motion
        moment = None if motion is None else motion.at(time)
        progress = 0.0 if motion is None else motion.progress_at(time)
        self._stage.draw_moment(progress, moment, self._shown.failed_by(time))
