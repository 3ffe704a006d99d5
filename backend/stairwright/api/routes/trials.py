"""Sets of trials: many rollouts under random deviations as one job, and what came of them."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from fastapi import APIRouter, Path, Request, Response

from stairwright.api.bodies import EntryChanges, JobDocument, StoredEntry, TrialsRequest
from stairwright.api.deps import JSON_BODY, Idempotent, Owner, Service
from stairwright.api.problems import describe
from stairwright.api.services import Services
from stairwright.jobs.questions import TrialsQuestion
from stairwright.simulation.ranges import chosen_ranges
from stairwright.simulation.trials_result import Trials

from . import stored
from .simulations import accepted, settings_of, source_of

router = APIRouter(prefix="/trials", tags=["trials"])
TrialsId = Annotated[str, Path(max_length=64, examples=["t-0123456789abcdef"])]


@router.post(
    "",
    status_code=202,
    response_model=JobDocument,
    dependencies=[JSON_BODY],
    responses=describe(404, 409, 415, 429, 503),
)
async def post_trials(
    services: Service, owner: Owner, body: TrialsRequest, once: Idempotent
) -> Response:
    """Start a set of trials; the answer is its job. A known result makes a job that is done."""
    return await accepted(services, owner, once, partial(_question, services, body))


def _question(services: Services, body: TrialsRequest) -> TrialsQuestion:
    ranges = chosen_ranges(body.ranges, body.bundle).model_dump(mode="json")
    source, settings = source_of(services, body), settings_of(body)
    return TrialsQuestion(
        source, body.friction, settings, body.seed, count=body.count, ranges=ranges
    )


@router.get("", response_model=list[StoredEntry])
async def list_trials(request: Request, services: Service, listed: stored.Listing) -> Response:
    """Stored sets of trials, newest first."""
    return await stored.listing(request, services, "trials", listed)


@router.get("/{trials_id}", response_model=Trials, responses=describe(404))
async def get_trials(request: Request, services: Service, trials_id: TrialsId) -> Response:
    """One set: successes with their interval, and every trial with its seed and deviations.

    A rollout of the same plan with a trial's seed and `disturbance` replays it.
    """
    return await stored.document(request, services, "trials", trials_id)


@router.patch(
    "/{trials_id}",
    response_model=StoredEntry,
    dependencies=[JSON_BODY],
    responses=describe(404, 415),
)
async def save_trials_notes(
    services: Service, trials_id: TrialsId, changes: EntryChanges
) -> StoredEntry:
    """Name a set of trials, note something about it, or pin it."""
    return await stored.annotate(services, "trials", trials_id, changes)


@router.delete("/{trials_id}", status_code=204, responses=describe(404))
async def delete_trials(services: Service, trials_id: TrialsId) -> None:
    """Remove a set of trials. Its plan stays."""
    await stored.delete(services, "trials", trials_id)
