"""Sets of trials: many rollouts under random deviations as one job, and what came of them."""

from __future__ import annotations

from functools import partial

from fastapi import APIRouter, Response

from stairwright.api.bodies import TrialsRequest
from stairwright.api.deps import Idempotent, Owner, Service
from stairwright.api.services import Services
from stairwright.jobs.questions import TrialsQuestion
from stairwright.simulation.ranges import chosen_ranges
from stairwright.simulation.trials_result import Trials

from . import stored
from .simulations import STARTS_A_JOB, accepted, settings_of, source_of

router = APIRouter(prefix="/trials", tags=["trials"])


@router.post("", **STARTS_A_JOB)
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


stored.serve(
    router,
    "trials",
    Trials,
    some="sets of trials",
    get="One set: successes with their interval, and every trial with its seed and deviations.\n\n"
    "A rollout of the same plan with a trial's seed and `disturbance` replays it.",
    save="Name a set of trials, note something about it, or pin it.",
    delete="Remove a set of trials. Its plan stays.",
)
