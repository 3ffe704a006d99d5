"""Playback: a clock and one thread that asks for frames while the clock runs or was moved."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable

log = logging.getLogger(__name__)

FRAMES_PER_SECOND = 40.0


class Player:
    """Calls `draw(time)` at up to 40 Hz while playing, once after each change, never else.

    The page is the authority: it may set the time at any moment; between those the clock runs on
    at `speed`. At the end of the motion it stops.
    """

    def __init__(self, draw: Callable[[float], None]) -> None:
        self._draw = draw
        self._change = threading.Condition()
        self._time = 0.0
        self._since = time.monotonic()
        self._duration = 0.0
        self._playing = False
        self._speed = 1.0
        self._dirty = False
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="scene-player", daemon=True)
        self._thread.start()

    @property
    def time(self) -> float:
        """Time of the motion now [s]."""
        with self._change:
            return self._now()

    @property
    def playing(self) -> bool:
        """Whether the clock runs."""
        with self._change:
            return self._playing

    @property
    def duration(self) -> float:
        """Length of the motion [s]."""
        with self._change:
            return self._duration

    def set(
        self,
        *,
        time: float | None = None,
        playing: bool | None = None,
        speed: float | None = None,
        duration: float | None = None,
    ) -> None:
        """Change the clock; what is None stays. A frame follows in any case."""
        with self._change:
            if time is None:
                time = self._now() if self._running else self._time
            self._move(time)
            if duration is not None:
                self._duration = duration
            if speed is not None:
                self._speed = speed
            if playing is not None:
                if playing and not self._playing and 0.0 < self._duration <= self._now():
                    self._move(0.0)  # play at the end starts again
                self._playing = playing
            self._dirty = True
            self._change.notify()

    def close(self) -> None:
        """Stop the thread and wait for it."""
        with self._change:
            self._closed = True
            self._change.notify()
        if threading.current_thread() is not self._thread:
            self._thread.join(timeout=5.0)

    def _move(self, to: float) -> None:
        # Not held inside the motion here: a time may be asked for before its motion is shown.
        self._time = max(0.0, to)
        self._since = time.monotonic()

    @property
    def _running(self) -> bool:
        return self._playing and self._duration > 0.0

    def _now(self) -> float:
        ran = self._speed * (time.monotonic() - self._since) if self._running else 0.0
        return min(self._time + ran, self._duration)

    def _run(self) -> None:
        while True:
            with self._change:
                while not (self._running or self._dirty or self._closed):
                    self._change.wait()
                if self._closed:
                    return
                now = self._now()
                if self._running and now >= self._duration:
                    self._playing = False
                    self._move(self._duration)
                self._dirty = False
            begun = time.monotonic()
            try:
                self._draw(now)
            except Exception:  # a frame that fails must not end playback; the log says why
                log.exception("drawing a frame at %.3f s failed", now)
            rest = 1.0 / FRAMES_PER_SECOND - (time.monotonic() - begun)
            if rest > 0:
                time.sleep(rest)
