"""Whoever carries out rollouts, trials and margins: processes of this machine, or a cluster."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from stairwright.storage.artefacts import Artefacts

from . import work
from .pool import WorkerPool
from .run import Run

_WORK = {"rollout": work.simulate, "trials": work.try_out, "margins": work.find_margins}


class Simulators(Protocol):
    """Belongs to one event loop.

    Attributes:
        workers: How many rollouts are carried out at once.
        spares: How many more may be where all of those are one owner's.
        resized: Called with the new number of workers when it has changed.
    """

    workers: int
    spares: int
    resized: Callable[[int], None]

    async def start(self) -> None:
        """Begin to have somebody there, without waiting for it."""

    async def stop(self) -> None:
        """End what was started."""

    async def ready(self) -> None:
        """Wait until there is somebody to do it.

        Raises:
            Failure: If that seems not to come.
        """

    async def carry_out(self, run: Run) -> work.Product:
        """The outcome, its documents among the artefacts; progress and series go to the run.

        Cancelling the caller ends the work.

        Raises:
            InputError: If a value is bad or the plan has nothing that could be carried out.
            WorkerDied: If who was at it is gone: it may be asked again.
            Failure: If it could not be done.
        """


class PoolSimulators:
    """`Simulators` over processes of this machine."""

    def __init__(self, pool: WorkerPool, artefacts: Artefacts, deadline: float) -> None:
        """`deadline` [s] is for one rollout."""
        self.workers, self.spares = pool.workers, pool.spares
        self.resized: Callable[[int], None] = _ignore
        self._pool = pool
        self._folder = str(artefacts.folder)
        self._deadline = deadline

    async def start(self) -> None:
        """See `Simulators`."""
        await self._pool.start()

    async def stop(self) -> None:
        """See `Simulators`."""
        await self._pool.stop()

    async def ready(self) -> None:
        """See `Simulators`."""
        await self._pool.prepared.wait()

    async def carry_out(self, run: Run) -> work.Product:
        """See `Simulators`."""
        question = run.question
        return await self._pool.run(
            _WORK[question.kind],
            question.data,
            self._folder,
            run.gauge.path,
            run.live.path,
            deadline=self._deadline * question.runs,
        )


def _ignore(_: int) -> None:
    """Nobody wants to know."""
