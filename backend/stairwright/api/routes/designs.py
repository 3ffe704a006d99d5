"""Searches for designs: start one, see what it has found so far, stop it, remove it."""

from __future__ import annotations

import asyncio
import hashlib
import re
from functools import partial
from typing import Annotated, Any

import orjson
from fastapi import APIRouter, Depends, Path, Request, Response
from fastapi.sse import format_sse_event

from stairwright.api import event_streams
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
from stairwright.api.problems import FieldError, Problem, describe, not_found
from stairwright.api.responses import accepted_json, fresh_json, models_json, not_modified
from stairwright.api.services import Services
from stairwright.api.study_bodies import DesignAnswer, DesignDocument
from stairwright.documents import parse
from stairwright.studies.design_document import Design
from stairwright.studies.design_resolve import resolved_design
from stairwright.studies.design_result import DesignResult
from stairwright.studies.design_shelf import (
    DesignSummary,
    kept_results,
    read_result,
    summary_of,
)
from stairwright.studies.following import Following
from stairwright.studies.version import engine_of

from .studies import be_sure_of_packages

EVENTS = """Events named `design`, each with how far the search is, as in the list of searches, as
JSON and its revision as the event's id. What it has found is at its place, the link `self`."""
EVERY = 0.5  # s between looks at what is new: each reads all that was found

router = APIRouter(prefix="/designs", tags=["studies"])


def _known_form(
    design_id: Annotated[str, Path(max_length=80, examples=["d-0123456789abcdef"])],
) -> str:
    """An id, which names a file; what has another form is no search."""
    if not re.fullmatch(r"d-[0-9a-f]+", design_id):
        raise not_found("search for designs", design_id)
    return design_id


Id = Annotated[str, Depends(_known_form)]


@router.post(
    "",
    status_code=202,
    response_model=DesignDocument,
    dependencies=[JSON_BODY],
    responses=describe(409, 415, 429, 501, 503),
)
async def post_design(services: Service, owner: Owner, body: Design, once: Idempotent) -> Response:
    """Search for the best designs, or go on with it: the same document is the same search.

    What it has found by then is at its place, the link `self`.
    """
    be_sure_of_packages(services)
    design = await asyncio.to_thread(_resolved, services, body)
    following = await services.studies.submit_design(design, owner)
    once.result = following.record.id
    shown = await asyncio.to_thread(_document, services, following)
    return accepted_json(shown, shown.links["self"])


def _resolved(services: Services, body: Design) -> Design:
    terrain, robot = partial(resolve_terrain, services), partial(resolve_robot, services)
    budget = services.settings.study_cells
    try:
        return resolved_design(body, terrain, robot, budget, "STAIRWRIGHT_STUDY_CELLS")
    except Problem as problem:  # a name that is unknown; it stands in `ask`
        errors = [FieldError(field=f"ask.{e.field}", message=e.message) for e in problem.errors]
        raise Problem(
            problem.status, f"ask.{problem.detail}", kind=problem.kind, errors=errors
        ) from None


@router.get("", response_model=list[DesignDocument])
async def list_designs(
    request: Request, services: Service, limit: Limit = 100, offset: Offset = 0
) -> Response:
    """Searches of this service and of `stairwright design` in its data folder, newest first."""
    found = await asyncio.to_thread(_all, services)
    shown = found[offset : offset + limit]
    return models_json(request, shown, total=len(found), limit=limit, offset=offset)


def _all(services: Services) -> list[DesignDocument]:
    kept = {each.id: each for each in kept_results(services.store.studies.folder)}
    ours = {each.record.id: each for each in services.studies.searches()}
    begun = {
        name: summary_of(_nothing_yet(each), each.record.created)
        for name, each in ours.items()
        if name not in kept
    }
    shown = [_shown(each, ours.get(name)) for name, each in (kept | begun).items()]
    return sorted(shown, key=lambda each: -each.changed)


@router.get("/{design_id}", response_model=DesignAnswer, responses=describe(404))
async def get_design(request: Request, services: Service, design_id: Id) -> Response:
    """Every design that was tried so far, the best ones with their robots, and how far it is."""
    content = await asyncio.to_thread(read_result, services.store.studies.folder, design_id)
    following = await services.studies.find(design_id)
    if content is None and following is None:
        raise not_found("search for designs", design_id)
    answer = await asyncio.to_thread(_answer, content, following)
    digest = hashlib.sha256(answer).hexdigest()
    if not_modified(request, f'"{digest[:32]}"'):
        return Response(status_code=304)
    return await fresh_json(request, answer, digest)


@router.get(
    "/{design_id}/events",
    response_class=Response,
    responses=event_streams.described(EVENTS),
)
async def design_events(
    services: Service,
    design_id: Id,
    last_event_id: event_streams.LastEventId = None,
) -> Response:
    """How far a search is, now and at every change until it is finished."""
    following = await services.studies.find(design_id)
    if following is None:
        raise not_found("search of this service", design_id)
    seen = event_streams.revision_seen(last_event_id)
    return event_streams.streamed(following.job, seen, _events(services, following))


async def _events(services: Services, following: Following) -> event_streams.Events:
    told = (0, -1)
    while True:
        now, finished = (following.job.revision, following.progress.done), following.job.finished
        if now != told:
            told = now
            shown = await asyncio.to_thread(_document, services, following)
            event = shown.model_dump_json()
            yield format_sse_event(data_str=event, event="design", id=str(now[0]))
        if finished:
            return
        yield None
        await asyncio.sleep(EVERY)


@router.post("/{design_id}/cancel", responses=describe(404, 409))
async def cancel_design(services: Service, design_id: Id) -> DesignDocument:
    """Stop a search; what it has found stays, and posting it again goes on with it."""
    following = await services.studies.find(design_id)
    if following is None:
        if await asyncio.to_thread(services.store.studies.path(design_id).exists):
            raise Problem(
                409, "this search is of `stairwright design`: stop it there", kind="not-ours"
            )
        raise not_found("search for designs", design_id)
    await services.studies.cancel(following)
    return await asyncio.to_thread(_document, services, following)


@router.delete("/{design_id}", status_code=204, responses=describe(404))
async def delete_design(services: Service, design_id: Id) -> None:
    """Remove a search with all that it has tried."""
    following, shelf = await services.studies.find(design_id), services.store.studies
    if following is not None:
        await services.studies.delete(following)
    elif await asyncio.to_thread(shelf.path(design_id).exists):
        await asyncio.to_thread(shelf.delete, design_id)
    else:
        raise not_found("search for designs", design_id)


def _document(services: Services, following: Following) -> DesignDocument:
    """A search of ours, as it is now."""
    content = read_result(services.store.studies.folder, following.record.id)
    known = orjson.loads(content) if content else _nothing_yet(following)
    return _shown(summary_of(known, following.record.created), following)


def _shown(summary: DesignSummary, following: Following | None) -> DesignDocument:
    return DesignDocument(**dict(summary), **_state(summary, following))


def _answer(content: bytes | None, following: Following | None) -> bytes:
    if content is not None:
        known = orjson.loads(content)
    else:
        assert following is not None
        known = _nothing_yet(following)
    return orjson.dumps(known | _state(summary_of(known, 0.0), following))


def _nothing_yet(following: Following) -> dict[str, Any]:
    result = DesignResult(
        id=following.record.id, design=_asked(following), complete=False, candidates=[]
    )
    return result.model_dump(mode="json")


def _asked(following: Following) -> Design:
    return parse(Design, orjson.loads(following.record.document))


def _state(summary: DesignSummary, following: Following | None) -> dict[str, Any]:
    """How far a search is; without `following` it is of `stairwright design`."""
    here = f"/api/v1/designs/{summary.id}"
    links = {"self": here, "events": f"{here}/events", "cancel": f"{here}/cancel"}
    share = min(1.0, summary.tried / summary.designs)
    if following is None:
        state = {"state": "done" if summary.complete else None, "progress": share, "eta": None}
        return state | {"stage": "", "outdated": False, "error": None, "links": links}
    job = following.job
    return {
        "state": job.state,
        # A search that goes on counts what is replayed, too.
        "progress": round(min(1.0, max(share, following.progress.share)), 4),
        "eta": following.eta,
        "stage": following.stage,
        "outdated": following.record.engine != engine_of(_asked(following).ask),
        "error": dict(job.error) if job.error else None,
        "links": links,
    }
