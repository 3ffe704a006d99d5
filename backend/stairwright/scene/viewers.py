"""The cameras of a scene's viewers: aimed together, following the robot unless a view is chosen."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np

from stairwright.arrays import Floats

from . import camera as cameras


class Viewers:
    """All browsers that look at one server's scene. Thread-safe; `len()` counts them.

    Attributes:
        floor: The lowest ground [m], which no camera goes below.
    """

    def __init__(self, server: Any) -> None:
        self.floor = 0.0
        self._server = server
        self._lock = threading.RLock()
        self._robot = np.array([0.0, 0.0, 0.33])
        self._following = True
        self._from: Floats | None = None
        self._closed = False
        self.look_afresh(self._robot)
        server.on_client_connect(self._welcome)

    def __len__(self) -> int:
        return len(self._server.get_clients())

    def look_afresh(self, robot: Floats, direction: Floats | None = None) -> None:
        """Follow the robot, which is at (3,) now [m]; from the unit `direction` if given."""
        with self._lock:
            self._robot, self._from = robot.copy(), direction
            self.look("follow")

    def look(self, preset: cameras.Preset, course: Floats | None = None) -> None:
        """Move every camera to a preset; ``iso`` shows the whole course (n, 3) [m], if given."""
        with self._lock:
            self._following = preset == "follow"
            if preset == "iso" and course is not None:
                self._aim(cameras.course_view(course))
            else:
                direction = self._from if self._following else None
                self._aim(cameras.view(preset, self._robot, direction))

    def follow(self, robot: Floats) -> None:
        """The robot is at (3,) now [m]."""
        with self._lock:
            moved = float(np.abs(robot - self._robot).max()) > 1e-6
            self._robot = robot.copy()
            if self._following and moved:
                self._move(cameras.keep_in_view, self._server.get_clients().values(), self._robot)

    def close(self) -> None:
        """Move no camera any more."""
        with self._lock:
            self._closed = True

    def _aim(self, view: cameras.View) -> None:
        start = self._server.initial_camera
        start.fov = cameras.FIELD_OF_VIEW
        start.position, start.look_at = view.position, view.look_at
        for client in self._server.get_clients().values():
            self._move(cameras.point, client, view)

    def _welcome(self, client: Any) -> None:
        """A viewer that comes while the camera follows starts where the robot is by now.

        Its camera never stays below the ground.
        """
        with self._lock:
            if self._following and not self._closed:
                self._move(cameras.point, client, cameras.view("follow", self._robot, self._from))

        @client.camera.on_update
        def _(_camera: Any) -> None:
            if not self._closed:
                self._move(cameras.keep_above, client, self.floor)

    def _move(self, move: Callable[..., None], *arguments: Any) -> None:
        """Move cameras on viser's own thread.

        There no viewer's report comes between two writes; between them, it would leave the old
        position beside the new aim, and the camera would drift as it follows.
        """
        self._server.get_event_loop().call_soon_threadsafe(move, *arguments)
