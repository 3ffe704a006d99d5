"""What streams of server-sent events have in common: where a client goes on, and their answer."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Annotated, Any

from fastapi import Header
from starlette.responses import StreamingResponse

from stairwright.api.problems import describe

QUIET = 15.0  # s after which a comment keeps proxies from closing the stream
LastEventId = Annotated[str | None, Header(max_length=20)]


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


def streamed(events: AsyncIterator[bytes]) -> StreamingResponse:
    """The answer. FastAPI's own streams check nothing before it has begun; the caller has."""
    headers = {"cache-control": "no-store", "x-accel-buffering": "no"}
    return StreamingResponse(events, headers=headers, media_type="text/event-stream")
