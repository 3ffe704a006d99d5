"""3D scenes, one a browser session; each has a viser server of its own on loopback."""

from __future__ import annotations

import asyncio
import importlib
import logging
import secrets
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from starlette.concurrency import run_in_threadpool

from .problems import Problem, not_found
from .replanning import Replanning

if TYPE_CHECKING:
    from stairwright.scene.session import SceneSession

logger = logging.getLogger(__name__)

LOOK_EVERY = 15.0  # s between looks for idle scenes


class Sessions:
    """Open scenes by id. An id cannot be guessed, and knowing it is what gives access."""

    def __init__(self, limit: int, idle: float, replanning: Replanning) -> None:
        self._replanning = replanning
        self._limit = limit
        self._idle = idle
        self._scenes: dict[str, SceneSession] = {}
        self._opening = 0

    def __len__(self) -> int:
        return len(self._scenes)

    def __contains__(self, name: str) -> bool:
        return name in self._scenes

    async def open(self) -> str:
        """A new scene's id.

        Raises:
            Problem: If too many are open, or scenes are not available.
        """
        if len(self._scenes) + self._opening >= self._limit:
            await self._close_unwatched()
        if len(self._scenes) + self._opening >= self._limit:
            headers = {"retry-after": "60"}
            raise Problem(429, "too many 3D scenes are open", kind="sessions", headers=headers)
        name = secrets.token_urlsafe(18)
        self._opening += 1
        try:
            replan = self._replanning.for_scene(partial(self.get, name), name)
            self._scenes[name] = await run_in_threadpool(_new_scene, name, replan)
        finally:
            self._opening -= 1
        return name

    def get(self, name: str) -> SceneSession:
        """An open scene.

        Raises:
            Problem: 404 if there is none.
        """
        if name not in self._scenes:
            raise not_found("session", name)
        return self._scenes[name]

    async def close(self, name: str) -> None:
        """Close a scene.

        Raises:
            Problem: 404 if there is none.
        """
        scene = self.get(name)
        del self._scenes[name]
        await run_in_threadpool(scene.close)

    async def close_all(self) -> None:
        """Close every scene."""
        for name in list(self._scenes):
            await self.close(name)

    async def close_idle_forever(self) -> None:
        """Close scenes that nobody has used or watched for the idle time, again and again."""
        while True:
            await asyncio.sleep(min(LOOK_EVERY, self._idle))
            before = time.monotonic() - self._idle
            for name, scene in list(self._scenes.items()):
                if scene.last_used < before and scene.clients == 0:
                    logger.info("closing an idle scene")
                    await self.close(name)

    async def _close_unwatched(self) -> None:
        """Make room: close the scene that has gone unwatched and unused for longest."""
        unwatched = [item for item in self._scenes.items() if item[1].clients == 0]
        before = time.monotonic() - LOOK_EVERY
        for name, scene in sorted(unwatched, key=lambda item: item[1].last_used)[:1]:
            if scene.last_used < before:
                await self.close(name)


def load_scenes() -> None:
    """Import viser in the background, before somebody waits for it."""
    name = "stairwright.scene.session"
    threading.Thread(target=importlib.import_module, args=(name,), daemon=True).start()


def _new_scene(name: str, replan: Callable[[dict[str, float]], None]) -> SceneSession:
    try:
        from stairwright.scene.session import SceneSession
    except ImportError:
        logger.exception("the 3D scene cannot be loaded")
        raise Problem(503, "this service has no 3D scene", kind="no-scene") from None
    return SceneSession(name, replan)
