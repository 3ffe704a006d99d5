"""Delay and friction margin of a plan: found by rollouts, as one job."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from fastapi import APIRouter, Path, Request, Response

from stairwright.api.bodies import EntryChanges, JobDocument, Simulation, StoredEntry
from stairwright.api.deps import JSON_BODY, Idempotent, Owner, Service
from stairwright.api.problems import describe
from stairwright.api.services import Services
from stairwright.errors import InputError
from stairwright.jobs.questions import MarginsQuestion
from stairwright.simulation.margins_result import RobustMargins

from . import stored
from .simulations import accepted, settings_of, source_of

router = APIRouter(prefix="/margins", tags=["margins"])
MarginsId = Annotated[str, Path(max_length=64, examples=["m-0123456789abcdef"])]


@router.post(
    "",
    status_code=202,
    response_model=JobDocument,
    dependencies=[JSON_BODY],
    responses=describe(404, 409, 415, 429, 503),
)
async def post_margins(
    services: Service, owner: Owner, body: Simulation, once: Idempotent
) -> Response:
    """Find a plan's margins; the answer is the job. A known result makes a job that is done."""
    return await accepted(services, owner, once, partial(_question, services, body))


def _question(services: Services, body: Simulation) -> MarginsQuestion:
    if body.friction is not None and body.terrain is None:
        raise InputError("margins count from the friction that the plan has", ("friction",))
    return MarginsQuestion(source_of(services, body), None, settings_of(body), body.seed)


@router.get("", response_model=list[StoredEntry])
async def list_margins(request: Request, services: Service, listed: stored.Listing) -> Response:
    """Stored margins, newest first."""
    return await stored.listing(request, services, "margins", listed)


@router.get("/{margins_id}", response_model=RobustMargins, responses=describe(404))
async def get_margins(request: Request, services: Service, margins_id: MarginsId) -> Response:
    """The delay and the loss of friction up to which every rollout succeeds."""
    return await stored.document(request, services, "margins", margins_id)


@router.patch(
    "/{margins_id}",
    response_model=StoredEntry,
    dependencies=[JSON_BODY],
    responses=describe(404, 415),
)
async def save_margins_notes(
    services: Service, margins_id: MarginsId, changes: EntryChanges
) -> StoredEntry:
    """Name a plan's margins, note something about them, or pin them."""
    return await stored.annotate(services, "margins", margins_id, changes)


@router.delete("/{margins_id}", status_code=204, responses=describe(404))
async def delete_margins(services: Service, margins_id: MarginsId) -> None:
    """Remove a plan's margins. The plan stays."""
    await stored.delete(services, "margins", margins_id)
