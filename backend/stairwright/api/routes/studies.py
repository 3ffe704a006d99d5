"""Studies: ask one, follow its cells as they come, look at one of them, take the dataset along."""

from __future__ import annotations

import asyncio
import hashlib
import time
from collections.abc import AsyncIterator
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import orjson
from fastapi import APIRouter, Depends, Path, Query, Request, Response
from fastapi.sse import KEEPALIVE_COMMENT, format_sse_event

from stairwright.api.deps import (
    JSON_BODY,
    Idempotent,
    Limit,
    Offset,
    Owner,
    Service,
    resolve_robot,
    resolve_terrain,
)
from stairwright.api.problems import Problem, describe, not_found
from stairwright.api.responses import models_json
from stairwright.api.services import EXPORT_DEADLINE, Services
from stairwright.api.study_bodies import AxisDocument, CellDocument, StudyDocument
from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.studies.document import Study, check_budget
from stairwright.studies.formats import FORMATS
from stairwright.studies.grid import point
from stairwright.studies.packages import absent, missing
from stairwright.studies.question import Questions, check_axes
from stairwright.studies.resolve import resolve
from stairwright.studies.service import Following
from stairwright.studies.targets import target
from stairwright.studies.version import engine_of

from . import event_streams

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


def study_document(following: Following) -> StudyDocument:
    """A study as clients see it."""
    record, job = following.record, following.job
    study = parse(Study, orjson.loads(record.document))
    here = f"/api/v1/studies/{record.id}"
    axes = [
        AxisDocument(
            name=axis.name,
            unit=target(axis.name, study.method).unit,
            values=list(axis.points),
            boundary=axis.boundary is not None,
        )
        for axis in study.axes
    ]
    return StudyDocument(
        id=record.id,
        name=study.name,
        state=job.state,
        done=following.done,
        total=following.total,
        progress=1.0 if job.state == "done" else round(min(1.0, following.share), 4),
        eta=following.eta,
        stage=following.stage,
        created=record.created,
        outdated=record.engine != engine_of(study),
        error=dict(job.error) if job.error else None,
        axes=axes,
        compute=study.compute,
        links={
            "self": here,
            "events": f"{here}/events",
            "cells": f"{here}/cells",
            "export": f"{here}/export",
        },
    )


@router.post(
    "",
    status_code=202,
    response_model=StudyDocument,
    dependencies=[JSON_BODY],
    responses=describe(409, 415, 429, 501, 503),
)
async def post_study(
    services: Service,
    owner: Owner,
    body: Study,
    once: Idempotent,
    retry: Annotated[bool, Query(description="try cells again that failed")] = False,
) -> Response:
    """Start a study, or go on with it: the same document is the same study.

    Its cells are followed at the link `events`; a finished one is there at once.
    """
    be_sure_of_packages(services)
    study = await asyncio.to_thread(_resolved, services, body)
    following = await services.studies.submit(study, owner, retry=retry)
    once.result = following.record.id
    shown = study_document(following)
    headers = {"location": shown.links["self"], "retry-after": "1"}
    return Response(shown.model_dump_json(), 202, headers=headers, media_type="application/json")


def be_sure_of_packages(services: Services) -> None:
    """Packages that studies need are there, or are installed before the first one.

    Raises:
        Problem: 501 with what to install.
    """
    if not services.settings.studies_setup and (names := absent()):
        raise Problem(501, f"{missing()}; not there: {', '.join(names)}", kind="missing")


def _resolved(services: Services, body: Study) -> Study:
    study = resolve(body, partial(resolve_terrain, services), partial(resolve_robot, services))
    check_budget(study, services.settings.study_cells, "STAIRWRIGHT_STUDY_CELLS")
    check_axes(Questions(study))
    return study


@router.get("", response_model=list[StudyDocument])
async def list_studies(
    request: Request, services: Service, limit: Limit = 100, offset: Offset = 0
) -> Response:
    """Studies, newest first."""
    records, total = await asyncio.to_thread(services.store.studies.page, limit, offset)
    found = [await services.studies.find(record.id) for record in records]
    shown = [study_document(each) for each in found if each is not None]
    return models_json(request, shown, total=total, limit=limit, offset=offset)


async def find_study(
    services: Service,
    study_id: Annotated[str, Path(max_length=64, pattern=r"^[\w-]+$", examples=["s-0123456789"])],
) -> Following:
    """The study that the path names.

    Raises:
        Problem: 404 if there is none.
    """
    following = await services.studies.find(study_id)
    if following is None or following.record.is_search:
        raise not_found("study", study_id)
    return following


FoundStudy = Annotated[Following, Depends(find_study)]


@router.get("/{study_id}", responses=describe(404))
async def get_study(following: FoundStudy) -> StudyDocument:
    """How far a study is, and its axes with all their values."""
    return study_document(following)


@router.get("/{study_id}/document", responses=describe(404))
async def get_study_document(following: FoundStudy) -> Study:
    """What was asked, names resolved: posted again it is the same study."""
    return parse(Study, orjson.loads(following.record.document))


@router.post("/{study_id}/cancel", responses=describe(404))
async def cancel_study(services: Service, following: FoundStudy) -> StudyDocument:
    """Stop a study; its cells so far stay, and posting it again goes on with it."""
    await services.studies.cancel(following)
    return study_document(following)


@router.delete("/{study_id}", status_code=204, responses=describe(404))
async def delete_study(services: Service, following: FoundStudy) -> None:
    """Remove a study with its cells."""
    await services.studies.delete(following)


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
        raise not_found("cell", str(cell))
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
        raise not_found("result of the study", following.record.id)
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
    if following.job.finished and seen >= following.job.revision:
        return Response(status_code=204)  # tells an EventSource not to come back
    return event_streams.streamed(_events(services, following))


async def _events(services: Services, following: Following) -> AsyncIterator[bytes]:
    if following.job.finished and not following.blocks:
        path = services.store.studies.path(following.record.id)
        if path.exists():
            block = await _asked(services, following, "cells")
            yield format_sse_event(data_str=block.decode(), event="cells")
        yield _state(following)
        return
    sent, told, spoken = 0, (0, -1), time.monotonic()
    while True:
        now = (following.job.revision, following.done)
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
        if fresh:
            spoken = time.monotonic()
        elif time.monotonic() - spoken >= event_streams.QUIET:
            spoken = time.monotonic()
            yield KEEPALIVE_COMMENT
        await asyncio.sleep(EVERY)


def _state(following: Following) -> bytes:
    shown = study_document(following).model_dump_json(exclude={"axes"})
    return format_sse_event(data_str=shown, event="study", id=str(following.job.revision))
