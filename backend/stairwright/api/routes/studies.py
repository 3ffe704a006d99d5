"""Studies: ask one, see how far it is, stop it, go on with it, remove it."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import Annotated

import orjson
from fastapi import APIRouter, Depends, Path, Query, Request, Response

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
from stairwright.api.responses import accepted_json, models_json
from stairwright.api.services import Services
from stairwright.api.study_bodies import AxisDocument, StudyDocument
from stairwright.documents import parse
from stairwright.studies.document import Study, check_budget
from stairwright.studies.following import Following
from stairwright.studies.packages import absent, missing
from stairwright.studies.question import Questions, check_axes
from stairwright.studies.resolve import resolve
from stairwright.studies.targets import target
from stairwright.studies.version import engine_of

router = APIRouter(prefix="/studies", tags=["studies"])


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
        done=following.progress.done,
        total=following.progress.total,
        progress=1.0 if job.state == "done" else round(min(1.0, following.progress.share), 4),
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
    return accepted_json(shown, shown.links["self"])


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
