"""Delay and friction margin of a plan: found by rollouts, as one job."""

from __future__ import annotations

from functools import partial

from fastapi import APIRouter, Response

from stairwright.api.bodies import Simulation
from stairwright.api.deps import Idempotent, Owner, Service
from stairwright.api.services import Services
from stairwright.errors import InputError
from stairwright.jobs.questions import MarginsQuestion
from stairwright.simulation.margins_result import RobustMargins

from . import stored
from .simulations import STARTS_A_JOB, accepted, settings_of, source_of

router = APIRouter(prefix="/margins", tags=["margins"])


@router.post("", **STARTS_A_JOB)
async def post_margins(
    services: Service, owner: Owner, body: Simulation, once: Idempotent
) -> Response:
    """Find a plan's margins; the answer is the job. A known result makes a job that is done."""
    return await accepted(services, owner, once, partial(_question, services, body))


def _question(services: Services, body: Simulation) -> MarginsQuestion:
    if body.friction is not None and body.terrain is None:
        raise InputError("margins count from the friction that the plan has", ("friction",))
    return MarginsQuestion(source_of(services, body), None, settings_of(body), body.seed)


stored.serve(
    router,
    "margins",
    RobustMargins,
    some="margins",
    get="The delay and the loss of friction up to which every rollout succeeds.",
    save="Name a plan's margins, note something about them, or pin them.",
    delete="Remove a plan's margins. The plan stays.",
)
