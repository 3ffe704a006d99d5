"""Jobs on paper: every change of state is written down, in order."""

from __future__ import annotations

import asyncio
import logging

from sqlalchemy.exc import SQLAlchemyError

from stairwright.errors import InputError
from stairwright.storage.jobs import JobLog

from .job import Job
from .questions import RolloutQuestion

logger = logging.getLogger(__name__)


class Journal:
    """Between jobs and the database. Belongs to one event loop."""

    def __init__(self, log: JobLog) -> None:
        self._log = log
        self._writing = asyncio.Lock()  # a job's states reach the database in order
        self._unwritten: set[Job] = set()

    async def write(self, job: Job, question: RolloutQuestion | None = None) -> None:
        """Write a job's state down, and what it asks the first time.

        Raises:
            SQLAlchemyError: If the database cannot be written now.
        """
        async with self._writing:
            if question is None or job.finished:
                await asyncio.to_thread(self._log.put, job.record)
            else:
                asks, needs = question.data, question.needs
                await asyncio.to_thread(self._log.put, job.record, asks, needs)

    async def note(self, job: Job) -> None:
        """The same, later if the database cannot be written now: the work goes on meanwhile."""
        try:
            await self.write(job)
        except SQLAlchemyError:
            logger.exception("the state of the job %s is written down later", job.id)
            self._unwritten.add(job)
        else:
            self._unwritten.discard(job)

    async def catch_up(self) -> None:
        """Write down what could not be written before."""
        for job in list(self._unwritten):
            await self.note(job)

    async def unfinished(self) -> list[Job]:
        """Jobs that an earlier process left, in the order in which they go on."""
        return [Job.restored(record) for record in await asyncio.to_thread(self._log.unfinished)]

    async def question(self, job: Job) -> RolloutQuestion | None:
        """What a job asks; None if that is not known, or cannot be asked any more."""
        return await asyncio.to_thread(self._question, job)

    def _question(self, job: Job) -> RolloutQuestion | None:
        asks = None if job.question is None else self._log.question(job.question)
        try:
            return None if asks is None else RolloutQuestion.restored(asks)
        except InputError as error:
            logger.warning("the job %s cannot go on: %s", job.id, error)
            return None
