"""Tells in the log when the system's clock is odd or jumps. Nothing else comes of it."""

from __future__ import annotations

import asyncio
import logging

from stairwright.storage.clock import ClockWatch, doubt, duration

logger = logging.getLogger(__name__)

LOOK_EVERY = 2.0  # s


async def watch_clock(last_written: float | None) -> None:
    """Until cancelled; `last_written` is when the data was last written, as `Store` found it."""
    watch = ClockWatch()
    odd = doubt(last_written)
    if odd is not None:
        logger.warning("%s; nothing is removed for its age", odd)
    while True:
        await asyncio.sleep(LOOK_EVERY)
        jump = watch.jump()
        if jump:
            where = "forward" if jump > 0.0 else "back"
            logger.warning("the clock was set %s by %s", where, duration(abs(jump)))
