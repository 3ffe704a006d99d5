"""Jobs: their state, its changes as server-sent events, and cancelling."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Depends, Header, Path, Response
from fastapi.sse import KEEPALIVE_COMMENT, format_sse_event
from starlette.responses import StreamingResponse

from stairwright.api.bodies import JobDocument
from stairwright.api.deps import Service
from stairwright.api.problems import describe, not_found
from stairwright.jobs.job import Job

router = APIRouter(prefix="/jobs", tags=["jobs"])

QUIET = 15.0  # s after which a comment keeps proxies from closing the stream


def job_document(job: Job) -> JobDocument:
    """A job as clients see it."""
    here = f"/api/v1/jobs/{job.id}"
    links = {"self": here, "events": f"{here}/events"}
    if job.result:
        links["result"] = job.result
    return JobDocument(
        id=job.id,
        kind="rollout",
        state=job.state,
        progress=round(job.progress, 4),
        eta=job.eta,
        result=job.result,
        error=dict(job.error) if job.error else None,
        links=links,
    )


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
    responses={
        200: {
            "description": "Events named `job`, each with the job as JSON",
            "content": {"text/event-stream": {}},
        },
        204: {"description": "Nothing will change after the event that was seen last"},
        **describe(404),
    },
)
async def job_events(
    job: FoundJob, last_event_id: Annotated[str | None, Header(max_length=20)] = None
) -> Response:
    """The job now and at every change until it is finished."""
    seen = 0
    if last_event_id and last_event_id.isascii() and last_event_id.isdigit():
        seen = int(last_event_id)
    if job.finished and seen >= job.revision:
        return Response(status_code=204)  # tells an EventSource not to come back
    headers = {"cache-control": "no-store", "x-accel-buffering": "no"}
    # FastAPI's own event streams check nothing before the answer has begun; this one has.
    stream = _events(job, seen if seen < job.revision else 0)
    return StreamingResponse(stream, headers=headers, media_type="text/event-stream")


async def _events(job: Job, seen: int) -> AsyncIterator[bytes]:
    changes = job.changes(seen)
    while True:
        following = asyncio.ensure_future(anext(changes, None))
        try:
            while not (await asyncio.wait({following}, timeout=QUIET))[0]:
                yield KEEPALIVE_COMMENT
        except BaseException:
            following.cancel()
            raise
        revision = following.result()
        if revision is None:
            return
        state = job_document(job).model_dump_json()
        yield format_sse_event(data_str=state, event="job", id=str(revision))
