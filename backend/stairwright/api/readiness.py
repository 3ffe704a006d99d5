"""Whether a plan would be answered now, and if not, what is being done about it."""

from __future__ import annotations

import asyncio
import logging
import time

from stairwright.jobs import launch, warming
from stairwright.jobs.pool import WorkerPool

from .trouble import Trouble

logger = logging.getLogger(__name__)

REHEARSAL_DEADLINE = 300.0  # s, once there is a worker
RETRY = 5.0  # s
TELL_EVERY = 10.0  # s


class Readiness:
    """Ready when a plan was answered, never before."""

    def __init__(self, pool: WorkerPool) -> None:
        self._pool = pool
        self._begun = time.monotonic()
        self._trouble = ""
        self.ready = False
        self.tried = asyncio.Event()  # set after the first attempt

    @property
    def text(self) -> str:
        """What is being done, in a sentence."""
        spent = f"starting for {time.monotonic() - self._begun:.0f} s"
        return f"{spent}: {self._trouble or launch.stage() or 'starting workers'}"

    async def rehearse(self) -> None:
        """Return when a worker has answered a plan; try again as long as none has."""
        teller = asyncio.create_task(self._tell())
        trouble = Trouble(logger, "a trial plan")
        try:
            while not self.ready:
                try:
                    await self._pool.run(warming.rehearse, deadline=REHEARSAL_DEADLINE)
                except Exception as error:  # noqa: BLE001 - it is told, and tried again
                    trouble.failed(error)
                    self._trouble = f"a trial plan failed ({error}); the log says more"
                    self.tried.set()
                    await asyncio.sleep(RETRY)
                else:
                    trouble.worked()
                    self.ready = True
            self.tried.set()
        finally:
            teller.cancel()
            launch.told()

    async def _tell(self) -> None:
        while True:
            await asyncio.sleep(TELL_EVERY)
            logger.info("%s", self.text)
