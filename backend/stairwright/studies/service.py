"""Studies of a service, and searches for designs: queued, carried out one after the other,
followed, cancelled, gone on with.

The work is done by a process of its own (`runner`), started with the first study and ended when
there was none for a while; its cluster stays warm in between.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections import OrderedDict
from dataclasses import replace

import orjson
from sqlalchemy.exc import SQLAlchemyError

from stairwright.errors import Cancelled
from stairwright.jobs.failures import Interrupted, QueueFull, WorkerDied, problem_of
from stairwright.storage.store import Store
from stairwright.storage.studies import StudyRecord

from .design_document import Design, design_id
from .document import Study, study_id
from .following import Following
from .packages import INSTALLING, Installer, NotInstalled, absent
from .process import RunnerProcess
from .version import engine_of

logger = logging.getLogger(__name__)

IDLE = 600.0  # s without a study after which the processes end
MOST_DEATHS = 3  # of the process at one study
MOST_LOSSES = 20  # of the service while a study ran
_LOOK = 0.2  # s between looks whether it is cancelled
_KEPT = 32  # finished studies in memory


class Studies:
    """All studies of one service. Belongs to one event loop."""

    def __init__(
        self, store: Store, workers: int, scheduler: str, queue_limit: int, setup: str = ""
    ) -> None:
        self._store, self._workers, self._scheduler = store, workers, scheduler
        self._limit = queue_limit
        self._installer = Installer(setup) if setup else None
        self._known: OrderedDict[str, Following] = OrderedDict()
        self._waiting: asyncio.Queue[Following] = asyncio.Queue()
        self._current: Following | None = None
        self._process: RunnerProcess | None = None
        self._task: asyncio.Task[None] | None = None

    async def start(self) -> None:
        """Go on with what an earlier process left unfinished."""
        for record in await asyncio.to_thread(self._store.studies.unfinished):
            lost = replace(record, losses=record.losses + (record.state == "running"))
            following = self._known[record.id] = Following(lost)
            if lost.losses >= MOST_LOSSES:
                why = Interrupted(f"given up: the service ended {lost.losses} times meanwhile")
                following.job.finish("failed", error=problem_of(why))
                await self._note(following)
            else:
                self._enqueue(following)

    async def stop(self) -> None:
        """End; what is unfinished goes on after the next start."""
        if self._task is not None:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._task
        if self._current is not None and not self._current.job.finished:
            self._current.job.requeue()
            await self._note(self._current)
        await self._end_process()

    async def submit(self, study: Study, owner: str, *, retry: bool = False) -> Following:
        """Carry a study out, or follow it where it is known already.

        Raises:
            QueueFull: If too many wait.
        """
        engine = await asyncio.to_thread(engine_of, study)
        name, document = study_id(study, engine), study.model_dump_json()
        record = StudyRecord(name, study.name, document, engine, owner=owner, total=study.cells)
        return await self._submit(record, retry)

    async def submit_design(self, design: Design, owner: str) -> Following:
        """Carry a search for designs out, or follow it where it is known already.

        Raises:
            QueueFull: If too many wait.
        """
        engine = await asyncio.to_thread(engine_of, design.ask)
        name, document = design_id(design, engine), design.model_dump_json()
        record = StudyRecord(name, design.name, document, engine, owner=owner, total=design.designs)
        return await self._submit(record)

    async def _submit(self, record: StudyRecord, retry: bool = False) -> Following:
        known = await self.find(record.id)
        if known is not None and (
            not known.job.finished or (known.job.state == "done" and not retry)
        ):
            return known
        waiting = sum(not each.job.finished for each in self._known.values())
        if waiting > self._limit:
            raise QueueFull(f"{waiting - 1} studies are waiting already", retry_after=10.0)
        following = Following(
            record if known is None else replace(record, done=known.progress.done)
        )
        following.retry = retry
        await asyncio.to_thread(self._store.studies.put, record)
        self._known[record.id] = following
        self._enqueue(following)
        return following

    async def find(self, name: str) -> Following | None:
        """A study or search by its id."""
        if name in self._known:
            return self._known[name]
        record = await asyncio.to_thread(self._store.studies.get, name)
        return None if record is None else Following(record)

    def searches(self) -> list[Following]:
        """All searches for designs; reads the database."""
        records = self._store.studies.searches()
        return [self._known.get(record.id) or Following(record) for record in records]

    async def cancel(self, following: Following) -> None:
        """Stop it; its cells so far stay."""
        if following.job.finished:
            return
        following.job.finish("cancelled", error=problem_of(Cancelled()))
        await self._note(following)
        if following is self._current and self._process is not None:
            await self._process.order({"cancel": following.record.id})

    async def delete(self, following: Following) -> None:
        """Remove it with its cells."""
        await self.cancel(following)
        while following is self._current:  # it is written to no more after this
            await asyncio.sleep(0.05)
        self._known.pop(following.record.id, None)
        await asyncio.to_thread(self._store.studies.delete, following.record.id)

    def counts(self) -> dict[str, int]:
        """Studies in memory by state."""
        counts: dict[str, int] = {}
        for each in self._known.values():
            counts[each.job.state] = counts.get(each.job.state, 0) + 1
        return counts

    def _enqueue(self, following: Following) -> None:
        self._waiting.put_nowait(following)
        if self._task is None or self._task.done():
            self._task = asyncio.create_task(self._serve())

    async def _serve(self) -> None:
        while True:
            try:
                following = await asyncio.wait_for(self._waiting.get(), IDLE)
            except TimeoutError:
                await self._end_process()
                return
            if following.job.finished:  # cancelled while it waited
                continue
            self._current = following
            await self._see_to(following)
            self._current = None  # `delete` waits for this: what is written later would come back
            self._forget_some()

    async def _see_to(self, following: Following) -> None:
        """Carry it out and write down how it ended."""
        try:
            await self._carry_out(following)
        except NotInstalled as error:
            logger.warning("a study was not begun: %s", error)
            following.job.finish("failed", error=problem_of(error))
        except Exception as error:  # whatever it is, who follows it must learn of it
            logger.exception("a study failed")
            following.job.finish("failed", error=problem_of(error))
        try:
            await self._note(following)
            await asyncio.to_thread(self._store.studies.measure, following.record.id)
        except (SQLAlchemyError, OSError):  # as on a full disk; those that wait have their turn
            logger.exception("how a study ended could not be written down")

    async def _carry_out(self, following: Following) -> None:
        """Have the runner do it, again where the runner dies."""
        while True:
            if self._process is None:
                await self._install(following)
                if following.job.finished:
                    return
                self._process = await RunnerProcess.start(self._workers, self._scheduler)
            following.job.start()
            await self._note(following)
            name = following.record.id
            await self._process.order(
                {
                    "run": name,
                    following.job.kind: orjson.loads(following.record.document),
                    "path": str(self._store.studies.path(name)),
                    "retry": following.retry,
                }
            )
            if await self._followed(following, self._process):
                return
            await self._end_process()
            if following.job.finished:
                return
            following.deaths += 1
            if following.deaths >= MOST_DEATHS:
                why = f"given up: the process for studies has died {following.deaths} times at it"
                following.job.finish("failed", error=problem_of(WorkerDied(why)))
                return
            logger.warning("a study goes on: the process that was at it died")
            following.blocks.clear()  # all known cells come again
            following.job.requeue()

    async def _install(self, following: Following) -> None:
        """Wait for packages that are missing, unless the study is cancelled meanwhile.

        Raises:
            NotInstalled: If they cannot be installed.
        """
        if self._installer is None or not absent():
            return
        following.stage = INSTALLING
        following.job.start()
        installed = self._installer.started()
        while not (installed.done() or following.job.finished):
            await asyncio.wait({installed}, timeout=_LOOK)
        following.stage = ""
        if not following.job.finished:
            installed.result()

    async def _followed(self, following: Following, process: RunnerProcess) -> bool:
        """Take its reports in until it has ended with the study; False if the process died."""
        async for report in process.reports():
            if report["id"] != following.record.id:
                continue
            if "state" not in report:
                following.hear(report)
                continue
            if report["state"] == "done":
                progress = following.progress
                following.progress = replace(progress, total=progress.done)
            following.job.finish(report["state"], error=report["error"])
            return True
        return False

    async def _end_process(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            await process.end()

    async def _note(self, following: Following) -> None:
        await asyncio.to_thread(self._store.studies.put, following.as_record())

    def _forget_some(self) -> None:
        finished = [name for name, each in self._known.items() if each.job.finished]
        for name in finished[: max(0, len(finished) - _KEPT)]:
            del self._known[name]
        for name in finished[:-1]:
            if name in self._known:
                self._known[name].blocks = []  # they are read from the store from now on
