"""What a study has found: its cells as they come and one by one, and the dataset as a file."""

from __future__ import annotations

import asyncio
import hashlib
from typing import TYPE_CHECKING, Annotated, Any, Literal

import orjson
from fastapi import APIRouter, Path, Query, Response
from fastapi.sse import format_sse_event

from stairwright.api import event_streams
from stairwright.api.deps import Service
from stairwright.api.problems import describe, not_found
from stairwright.api.services import EXPORT_DEADLINE, Services
from stairwright.api.study_bodies import CellDocument
from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.studies.document import Study
from stairwright.studies.following import Following
from stairwright.studies.formats import FORMATS
from stairwright.studies.grid import point
from stairwright.studies.question import Questions

from .studies import FoundStudy, study_document

EVENTS = """Events named `study`, each with the study's state as JSON and its revision as the
event's id; and events named `cells` without an id, each with the cells that are new since the last
one: `{"cell": [n], "state": [n], "feasible": [n], ...}`, a list for each variable of the dataset.
`cell` is the cell's number: axes in the document's order, the last one fastest. A stream that is
opened late or again begins with all cells so far; where the process that was at the study died,
they come again. Numbers that there are none of are null."""

router = APIRouter(prefix="/studies", tags=["studies"])
EVERY = 0.1  # s between looks at what is new
if TYPE_CHECKING:
    StudyFormat = str
else:
    StudyFormat = Literal[tuple(FORMATS)]


@router.get(
    "/{study_id}/cells",
    response_class=Response,
    responses={
        200: {
            "description": "A list for each variable, as in the events named `cells`",
            "content": {"application/json": {"schema": {"type": "object"}}},
        },
        **describe(404, 429, 503),
    },
)
async def get_cells(services: Service, following: FoundStudy) -> Response:
    """All cells that are known by now."""
    content = await _asked(services, following, "cells")
    return Response(content, media_type="application/json")


@router.get("/{study_id}/cells/{cell}", responses=describe(404, 429, 503))
async def get_cell(
    services: Service, following: FoundStudy, cell: Annotated[int, Path(ge=0, le=10**9)]
) -> CellDocument:
    """One cell: its values, what is known of it, and the question that POST /plans takes."""
    study = parse(Study, orjson.loads(following.record.document))
    if cell >= study.cells:
        raise not_found("cell", str(cell), by="number")
    values = point(study, cell)
    try:
        plan: dict[str, Any] | None = (await asyncio.to_thread(Questions(study).at, values)).plan
    except InputError:  # its record says why
        plan = None
    record = orjson.loads(await _asked(services, following, "record", cell))
    named = {axis.name: value for axis, value in zip(study.axes, values, strict=True)}
    return CellDocument(cell=cell, values=named, plan=plan, record=record)


@router.get(
    "/{study_id}/export",
    response_class=Response,
    responses={
        200: {
            "description": "The file",
            "content": {
                kind.split(";")[0]: {"schema": {"type": "string", "format": "binary"}}
                for kind, _ in FORMATS.values()
            },
        },
        **describe(404, 429, 503),
    },
)
async def export_study(
    services: Service,
    following: FoundStudy,
    format_name: Annotated[StudyFormat, Query(alias="format")] = "netcdf",
) -> Response:
    """The dataset as a file; cells that are pending have no values yet."""
    content = await _asked(services, following, "export", format_name)
    kind, ending = FORMATS[format_name]
    headers = {
        "etag": f'"{hashlib.sha256(content).hexdigest()[:32]}"',
        "cache-control": "no-cache",
        "content-disposition": f'attachment; filename="{following.record.id}{ending}"',
        "x-content-type-options": "nosniff",
    }
    return Response(content, headers=headers, media_type=kind)


async def _asked(services: Services, following: Following, what: str, *args: Any) -> bytes:
    """What a worker process reads from the study's store."""
    path = services.store.studies.path(following.record.id)
    if not path.exists():
        raise not_found("result of a study", following.record.id)
    async with services.planning.queue.slot("export"):
        content: bytes = await services.plan_pool.run(
            _read_store, what, str(path), *args, deadline=EXPORT_DEADLINE
        )
    return content


def _read_store(what: str, path: str, *args: Any) -> bytes:
    from stairwright.studies import exporting

    reading: dict[str, Any] = {
        "cells": exporting.cells, "record": exporting.record, "export": exporting.export
    }  # fmt: skip
    content: bytes = reading[what](path, *args)
    return content


@router.get(
    "/{study_id}/events",
    response_class=Response,
    responses=event_streams.described(EVENTS),
)
async def study_events(
    services: Service,
    following: FoundStudy,
    last_event_id: event_streams.LastEventId = None,
) -> Response:
    """The study now and at every change until it is finished, and its cells as they come."""
    seen = event_streams.revision_seen(last_event_id)
    return event_streams.streamed(following.job, seen, _events(services, following))


async def _events(services: Services, following: Following) -> event_streams.Events:
    if following.job.finished and not following.blocks:
        path = services.store.studies.path(following.record.id)
        if path.exists():
            block = await _asked(services, following, "cells")
            yield format_sse_event(data_str=block.decode(), event="cells")
        yield _state(following)
        return
    sent, told = 0, (0, -1)
    while True:
        now = (following.job.revision, following.progress.done)
        finished = following.job.finished  # before the cells are looked at, not after
        if len(following.blocks) < sent:
            sent = 0  # they come again
        fresh, sent = following.blocks[sent:], len(following.blocks)
        for block in fresh:
            yield format_sse_event(data_str=block.decode(), event="cells")
        if now != told:
            told = now
            yield _state(following)
        if finished:
            return
        yield None
        await asyncio.sleep(EVERY)


def _state(following: Following) -> bytes:
    shown = study_document(following).model_dump_json(exclude={"axes"})
    return format_sse_event(data_str=shown, event="study", id=str(following.job.revision))
