"""Jobs: their state, its changes as server-sent events, and cancelling."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated, Literal, cast

from fastapi import APIRouter, Depends, Path, Query, Request, Response
from fastapi.sse import format_sse_event

from stairwright.api import event_streams
from stairwright.api.bodies import JobDocument
from stairwright.api.deps import Limit, Offset, Service
from stairwright.api.problems import describe, not_found
from stairwright.api.responses import models_json
from stairwright.jobs.job import Job, State
from stairwright.jobs.live import EVERY, LiveSeries

EVENTS = """Events named `job`, each with the job as JSON and its revision as the event's id; and,
while a rollout runs, events named `series` without an id, about ten a second, each with the samples
that are new since the last one: `{"from": number of the first, "time": [n], "pitch": [n],
"pitch_desired": [n], "progress": [n], "q": [n][12], "q_desired": [n][12],
"base_position": [n][3], "base_quaternion": [n][4]}`, at 25 samples a simulated second, rounded to
1e-5. A stream that is opened late or again begins with all samples so far. A rollout whose worker
died begins anew: its job is queued again, and its series from sample 0."""

router = APIRouter(prefix="/jobs", tags=["jobs"])

Kind = Literal["rollout", "trials", "margins"]


def job_document(job: Job) -> JobDocument:
    """A job as clients see it."""
    here = f"/api/v1/jobs/{job.id}"
    links = {"self": here, "events": f"{here}/events"}
    if job.result:
        links["result"] = job.result
    return JobDocument(
        id=job.id,
        kind=cast(Kind, job.kind),
        state=job.state,
        progress=round(job.progress, 4),
        created=job.created,
        eta=job.eta,
        result=job.result,
        error=dict(job.error) if job.error else None,
        links=links,
    )


@router.get("", response_model=list[JobDocument])
async def list_jobs(
    request: Request,
    services: Service,
    state: Annotated[list[State], Query(max_length=5, description="only in these states")] = [],  # noqa: B006
    kind: Annotated[list[Kind], Query(max_length=5, description="only of these kinds")] = [],  # noqa: B006
    limit: Limit = 100,
    offset: Offset = 0,
) -> Response:
    """Jobs, newest first; `state` and `kind` may be given several times."""
    page = services.store.jobs.page
    records, total = await asyncio.to_thread(page, limit, offset, state, kind)
    found = [services.rollouts.known(record.id) or Job.restored(record) for record in records]
    shown = [job_document(job) for job in found if not state or job.state in state]
    return models_json(request, shown, total=total, limit=limit, offset=offset)


async def find_job(
    services: Service, job_id: Annotated[str, Path(max_length=64, examples=["j-0123456789"])]
) -> Job:
    """The job that the path names.

    Raises:
        Problem: 404 if there is none.
    """
    job = await services.rollouts.get(job_id)
    if job is None:
        raise not_found("job", job_id)
    return job


FoundJob = Annotated[Job, Depends(find_job)]


@router.get("/{job_id}", responses=describe(404))
async def get_job(job: FoundJob) -> JobDocument:
    """A job's state."""
    return job_document(job)


@router.delete("/{job_id}", responses=describe(404))
async def cancel_job(services: Service, job: FoundJob) -> JobDocument:
    """Cancel a job; one that is finished stays as it is."""
    await services.rollouts.cancel(job)
    return job_document(job)


@router.get(
    "/{job_id}/events",
    response_class=Response,
    responses=event_streams.described(EVENTS),
)
async def job_events(
    job: FoundJob,
    last_event_id: event_streams.LastEventId = None,
    series: Annotated[bool, Query(description="events named `series` as well")] = True,
) -> Response:
    """The job now and at every change until it is finished, and its series as it grows."""
    seen = event_streams.revision_seen(last_event_id)
    changes = job.changes(seen if seen < job.revision else 0)
    events = _events(job, changes, job.live if series else None)
    return event_streams.streamed(job, seen, events)


async def _events(
    job: Job, changes: AsyncIterator[int], live: LiveSeries | None
) -> event_streams.Events:
    offset = 0
    look_every = event_streams.QUIET if live is None else EVERY
    while True:
        following = asyncio.ensure_future(anext(changes, None))
        try:
            done: set[asyncio.Future[int | None]] = set()
            while not done:
                done, _ = await asyncio.wait({following}, timeout=look_every)
                chunks, offset = ([], 0) if live is None else live.after(offset)
                for chunk in chunks:
                    yield format_sse_event(data_str=chunk.decode(), event="series")
                if not chunks:
                    yield None
        except BaseException:
            following.cancel()
            raise
        revision = following.result()
        if revision is None:
            return
        state = job_document(job).model_dump_json()
        yield format_sse_event(data_str=state, event="job", id=str(revision))
