"""What rollouts and sets of trials have in common: what they ask, and how they are accepted."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import orjson
from fastapi import Response

from stairwright.api.bodies import JobDocument, PlanRequest, Simulation
from stairwright.api.deps import JSON_BODY, Idempotency
from stairwright.api.problems import describe, not_found
from stairwright.api.responses import accepted_json
from stairwright.api.services import Services
from stairwright.control.settings import ControllerSettings
from stairwright.documents import content_hash, parse
from stairwright.errors import InputError
from stairwright.jobs.questions import PlanQuestion, RolloutQuestion
from stairwright.planning.plan import Plan

from .jobs import job_document
from .plans import plan_question

STARTS_A_JOB: dict[str, Any] = {  # such a route in the API's description
    "status_code": 202,
    "response_model": JobDocument,
    "dependencies": [JSON_BODY],
    "responses": describe(404, 409, 415, 429, 503),
}


async def accepted(
    services: Services, owner: str, once: Idempotency, question: Callable[[], RolloutQuestion]
) -> Response:
    """Start a job, or find that of an earlier request with the same key; 202 and the job."""
    job = await services.rollouts.get(once.earlier) if once.earlier else None
    if job is None or await services.rollouts.lost(job):  # a lost job must not stick to its key
        asked = await asyncio.to_thread(question)
        job = await services.rollouts.submit(asked, owner)
        once.result = job.id
    shown = job_document(job)
    return accepted_json(shown, shown.links["self"])


def settings_of(body: Simulation) -> dict[str, Any]:
    """The controller's settings in full.

    Raises:
        InputError: If one is unknown or out of bounds.
    """
    try:
        return parse(ControllerSettings, dict(body.controller or {})).model_dump(mode="json")
    except InputError as error:
        raise error.within("controller") from None


def source_of(services: Services, body: Simulation) -> PlanQuestion | Plan | str:
    """What is to be carried out: a stored plan's digest, a whole plan, or what to plan first.

    Raises:
        InputError: If not exactly one of them is given.
        Problem: 404 if there is no such plan.
    """
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
        names = (
            "terrain", "robot", "friction", "method", "weights", "timing", "tolerance", "facing",
        )  # fmt: skip
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
