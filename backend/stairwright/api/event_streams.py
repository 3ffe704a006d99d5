"""Streams of server-sent events: where a client goes on, and how one is answered and kept open."""

from __future__ import annotations

import time
from collections.abc import AsyncGenerator, AsyncIterator
from contextlib import aclosing
from typing import Annotated, Any

from fastapi import Header, Response
from fastapi.sse import KEEPALIVE_COMMENT
from starlette.responses import StreamingResponse

from stairwright.api.problems import describe
from stairwright.jobs.job import Job

QUIET = 15.0  # s after which a comment keeps proxies from closing the stream
LastEventId = Annotated[str | None, Header(max_length=20)]
Events = AsyncGenerator[bytes | None, None]  # None: looked, and there is nothing new


def described(events: str) -> dict[int | str, dict[str, Any]]:
    """OpenAPI's word for a stream of `events`."""
    return {
        200: {
            "description": events,
            "content": {"text/event-stream": {"schema": {"type": "string"}}},
        },
        204: {"description": "Nothing will change after the event that was seen last"},
        **describe(404),
    }


def revision_seen(last_event_id: str | None) -> int:
    """The revision that a client saw last, 0 for none."""
    told = last_event_id is not None and last_event_id.isascii() and last_event_id.isdigit()
    return int(last_event_id or 0) if told else 0


def streamed(job: Job, seen: int, events: Events) -> Response:
    """The answer: `events` about a job, of which the client has seen the revision `seen`.

    FastAPI's own streams check nothing before the answer has begun; the caller has.
    """
    if job.finished and seen >= job.revision:
        return Response(status_code=204)  # tells an EventSource not to come back
    headers = {"cache-control": "no-store", "x-accel-buffering": "no"}
    return StreamingResponse(_kept_open(events), headers=headers, media_type="text/event-stream")


async def _kept_open(events: Events) -> AsyncIterator[bytes]:
    """The events, and a comment wherever there was none for QUIET."""
    spoken = time.monotonic()
    async with aclosing(events):
        async for event in events:
            now = time.monotonic()
            if event is None and now - spoken < QUIET:
                continue
            spoken = now
            yield KEEPALIVE_COMMENT if event is None else event
