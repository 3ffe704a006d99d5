"""Rollouts: start one as a job, look at the result, take it along."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Annotated, Any, Literal

import orjson
from fastapi import APIRouter, Path, Query, Request, Response

from stairwright.api.bodies import JobDocument, PlanRequest, RolloutRequest, StoredEntry
from stairwright.api.deps import JSON_BODY, Idempotent, Limit, Offset, Owner, Service
from stairwright.api.problems import describe, not_found
from stairwright.api.services import Services
from stairwright.control.settings import ControllerSettings
from stairwright.documents import content_hash, parse
from stairwright.errors import InputError
from stairwright.export.table import ROLLOUT_FORMATS
from stairwright.jobs.questions import PlanQuestion, RolloutQuestion
from stairwright.planning.plan import Plan
from stairwright.simulation.result import Rollout

from . import stored
from .jobs import job_document
from .plans import plan_question

router = APIRouter(prefix="/rollouts", tags=["rollouts"])
if TYPE_CHECKING:
    RolloutFormat = str
else:
    RolloutFormat = Literal[tuple(ROLLOUT_FORMATS)]
RolloutId = Annotated[str, Path(max_length=64, examples=["r-0123456789abcdef"])]


@router.post(
    "",
    status_code=202,
    response_model=JobDocument,
    dependencies=[JSON_BODY],
    responses=describe(404, 409, 415, 429, 503),
)
async def post_rollout(
    services: Service, owner: Owner, body: RolloutRequest, once: Idempotent
) -> Response:
    """Start a rollout; the answer is its job. A known result makes a job that is done."""
    job = await services.rollouts.get(once.earlier) if once.earlier else None
    if job is None or await services.rollouts.lost(job):  # a lost job must not stick to its key
        question = await asyncio.to_thread(_question, services, body)
        job = await services.rollouts.submit(question, owner)
        once.result = job.id
    shown = job_document(job)
    headers = {"location": shown.links["self"], "retry-after": "1"}
    return Response(shown.model_dump_json(), 202, headers=headers, media_type="application/json")


def _question(services: Services, body: RolloutRequest) -> RolloutQuestion:
    try:
        settings = parse(ControllerSettings, dict(body.controller or {}))
    except InputError as error:
        raise error.within("controller") from None
    controller = settings.model_dump(mode="json")
    deviations = body.disturbance.model_dump(exclude_defaults=True) if body.disturbance else {}
    source = _source(services, body)
    return RolloutQuestion(source, body.friction, controller, body.seed, deviations)


def _source(services: Services, body: RolloutRequest) -> PlanQuestion | Plan | str:
    given: dict[str, Any] = {
        name: value
        for name in ("plan_id", "plan", "terrain")
        if (value := getattr(body, name)) is not None
    }
    if len(given) != 1:
        message = "give exactly one of plan_id, plan and terrain"
        raise InputError(message, (list(given)[-1] if given else "plan_id",))
    if body.plan is not None:
        return _under_its_own_id(services, body.plan)
    if body.terrain is not None:
        names = ("terrain", "robot", "friction", "method", "weights")
        values = {name: getattr(body, name) for name in names}
        return plan_question(services, PlanRequest.model_construct(**values))
    entry = services.store.documents.get("plan", str(body.plan_id))
    if entry is None or not services.store.artefacts.intact(entry.digest):
        raise not_found("plan", str(body.plan_id), field="plan_id")
    return entry.digest


def _under_its_own_id(services: Services, plan: Plan) -> Plan:
    """The plan; a changed copy of a stored one gets another id, and so does its rollout."""
    stored = _stored_plan(services, plan.id)
    by_the_way = {"solve_time": plan.solve_time, "certificate": plan.certificate}
    if stored is None or stored.model_copy(update=by_the_way) == plan:
        return plan
    return plan.model_copy(update={"id": "p-" + content_hash(plan).removeprefix("sha256:")})


def _stored_plan(services: Services, plan_id: str) -> Plan | None:
    entry = services.store.documents.get("plan", plan_id)
    if entry is None:
        return None
    try:
        content = services.store.artefacts.content(entry.digest)
    except FileNotFoundError:  # removed in the meantime
        return None
    return parse(Plan, orjson.loads(content))


@router.get("", response_model=list[StoredEntry])
async def list_rollouts(
    request: Request, services: Service, limit: Limit = 100, offset: Offset = 0
) -> Response:
    """Stored rollouts, newest first."""
    return await stored.listing(request, services, "rollout", limit, offset)


@router.get("/{rollout_id}", response_model=Rollout, responses=describe(404))
async def get_rollout(request: Request, services: Service, rollout_id: RolloutId) -> Response:
    """One rollout with all its series; may be several MB."""
    return await stored.document(request, services, "rollout", rollout_id)


@router.delete("/{rollout_id}", status_code=204, responses=describe(404))
async def delete_rollout(services: Service, rollout_id: RolloutId) -> None:
    """Remove a rollout. Its plan stays; asked again, it is simulated anew."""
    await stored.delete(services, "rollout", rollout_id)


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
