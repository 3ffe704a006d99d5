"""Rollouts: start one as a job, look at the result, take it along."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import APIRouter, Path, Query, Request, Response

from stairwright.api.bodies import RolloutRequest
from stairwright.api.deps import Idempotent, Owner, Service
from stairwright.api.problems import describe
from stairwright.api.services import Services
from stairwright.export.table import ROLLOUT_FORMATS
from stairwright.jobs.questions import RolloutQuestion
from stairwright.simulation.result import Rollout

from . import stored
from .simulations import STARTS_A_JOB, accepted, settings_of, source_of

router = APIRouter(prefix="/rollouts", tags=["rollouts"])
if TYPE_CHECKING:
    RolloutFormat = str
else:
    RolloutFormat = Literal[tuple(ROLLOUT_FORMATS)]
RolloutId = Annotated[str, Path(max_length=64, examples=["r-0123456789abcdef"])]


@router.post("", **STARTS_A_JOB)
async def post_rollout(
    services: Service, owner: Owner, body: RolloutRequest, once: Idempotent
) -> Response:
    """Start a rollout; the answer is its job. A known result makes a job that is done."""
    return await accepted(services, owner, once, partial(_question, services, body))


def _question(services: Services, body: RolloutRequest) -> RolloutQuestion:
    deviations = body.disturbance.model_dump(exclude_defaults=True) if body.disturbance else {}
    source, settings = source_of(services, body), settings_of(body)
    return RolloutQuestion(source, body.friction, settings, body.seed, deviations)


stored.serve(
    router,
    "rollout",
    Rollout,
    some="rollouts",
    get="One rollout with all its series; may be several MB.",
    save="Name a rollout, note something about it, or pin it.",
    delete="Remove a rollout. Its plan stays; asked again, it is simulated anew.",
)


@router.get(
    "/{rollout_id}/export",
    response_class=Response,
    responses={**stored.files(ROLLOUT_FORMATS), **describe(404, 429, 503)},
)
async def export_rollout(
    request: Request,
    services: Service,
    rollout_id: RolloutId,
    format_name: Annotated[RolloutFormat, Query(alias="format")] = "json",
) -> Response:
    """One rollout as a file; html replays it in 3D without a server."""
    return await stored.export(request, services, "rollout", rollout_id, format_name)
