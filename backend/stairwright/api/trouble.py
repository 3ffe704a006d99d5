"""Something that fails again and again is told when it begins and when it is over."""

from __future__ import annotations

import logging


class Trouble:
    """One thing that is tried every now and then."""

    def __init__(self, logger: logging.Logger, what: str) -> None:
        """`what` completes the sentences "... failed" and "... works again"."""
        self._logger = logger
        self._what = what
        self._last: str | None = None

    def failed(self, error: Exception) -> None:
        """Tell it, unless it was told last time."""
        # The system's errors name files, which may be others each time.
        why = error.strerror if isinstance(error, OSError) else str(error)
        told = f"{type(error).__name__}: {why}"
        if told != self._last:
            self._last = told
            self._logger.error("%s failed, and is tried again", self._what, exc_info=error)

    def worked(self) -> None:
        """Tell that it is over, if it was told to have begun."""
        if self._last is not None:
            self._last = None
            self._logger.info("%s works again", self._what)
