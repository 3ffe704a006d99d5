"""Plans: ask for one, look it up, take it along."""

from __future__ import annotations

import asyncio
import gzip
from typing import TYPE_CHECKING, Annotated, Literal

import orjson
from fastapi import APIRouter, Path, Query, Request, Response

from stairwright.api.bodies import PlanRequest
from stairwright.api.deps import (
    JSON_BODY,
    Idempotent,
    Owner,
    Service,
    resolve_robot,
    resolve_terrain,
)
from stairwright.api.disconnect import CLIENT_GONE, unless_gone
from stairwright.api.problems import describe
from stairwright.api.responses import fresh_json, stored_json
from stairwright.api.services import Services
from stairwright.export.table import LEAST_RATE, MOST_RATE, PLAN_FORMATS, USUAL_RATE
from stairwright.jobs.planning import Answer
from stairwright.jobs.questions import PlanQuestion
from stairwright.planning.plan import Plan
from stairwright.robot.description import Robot
from stairwright.robot.turning import turned
from stairwright.terrain.profile import Terrain

from . import stored

router = APIRouter(prefix="/plans", tags=["plans"])
PlanId = Annotated[str, Path(max_length=64, examples=["p-0123456789abcdef"])]
if TYPE_CHECKING:
    PlanFormat = str
else:
    PlanFormat = Literal[tuple(PLAN_FORMATS)]
Rate = Annotated[
    float | None,
    Query(
        ge=LEAST_RATE,
        le=MOST_RATE,
        description=f"of the joint commands in mcap [Hz]; {USUAL_RATE:g} if empty",
    ),
]
AT_ONCE = 200  # points of a terrain that is ready sooner than a thread would be


def plan_question(services: Services, body: PlanRequest) -> PlanQuestion:
    """The question behind a request, names resolved and defaults filled in."""
    terrain = resolve_terrain(services, body.terrain)
    robot = resolve_robot(services, body.robot)
    asked = (body.friction, body.method, body.weights, body.timing, body.tolerance, body.facing)
    return PlanQuestion.of(terrain, robot, *asked)


@router.post(
    "",
    response_model=Plan,
    dependencies=[JSON_BODY],
    responses=describe(409, 415, 429, 503),
)
async def post_plan(
    request: Request, services: Service, owner: Owner, body: PlanRequest, once: Idempotent
) -> Response:
    """Plan; the answer is the plan, an infeasible one too. The same question has the same id."""
    answer = await unless_gone(request, answered(services, body, owner))
    if answer is None:
        return Response(status_code=CLIENT_GONE)
    once.result = answer.entry.id
    headers = {"content-location": f"/api/v1/plans/{answer.entry.id}"}
    send = stored_json if answer.cached else fresh_json
    return await send(request, answer.content, answer.entry.digest, headers)


async def answered(services: Services, body: PlanRequest, owner: str) -> Answer:
    """The stored answer to a question, else a new one."""
    question, answer = await asyncio.to_thread(_look_up, services, body)
    if answer is None:
        answer = await services.planning.solve(question, owner)
    services.metrics.plans.labels(str(answer.cached).lower()).inc()
    return answer


async def previewed(services: Services, body: PlanRequest, owner: str) -> bytes:
    """The JSON of a new answer that is not stored."""
    if isinstance(body.terrain, Terrain) and len(body.terrain.points) <= AT_ONCE:
        question = plan_question(services, body)
    else:
        question = await asyncio.to_thread(plan_question, services, body)
    content = await services.planning.preview(question, owner)
    services.metrics.plans.labels("false").inc()
    return content


def _look_up(services: Services, body: PlanRequest) -> tuple[PlanQuestion, Answer | None]:
    question = plan_question(services, body)
    return question, services.planning.stored(question)


stored.serve(
    router,
    "plan",
    Plan,
    some="plans",
    get="One plan.",
    save="Name a plan, note something about it, or pin it.",
    delete="Remove a plan. Its rollouts stay, those that wait go on; asked again, it is planned "
    "anew.",
)


@router.get("/{plan_id}/robot", responses=describe(404))
async def get_plan_robot(services: Service, plan_id: PlanId) -> Robot:
    """The robot of a plan as its own file has it, also where its rear leads."""
    _, packed = await stored.load(services, "plan", plan_id)
    plan = await asyncio.to_thread(lambda: orjson.loads(gzip.decompress(packed)))
    robot = Robot.model_validate(plan["robot_description"])
    return turned(robot) if plan.get("facing") == "backward" else robot


@router.get(
    "/{plan_id}/export",
    response_class=Response,
    responses={**stored.files(PLAN_FORMATS), **describe(404, 429, 503)},
)
async def export_plan(
    request: Request,
    services: Service,
    plan_id: PlanId,
    format_name: Annotated[PlanFormat, Query(alias="format")] = "json",
    rate: Rate = None,
) -> Response:
    """One plan as a file; urdf is its robot."""
    return await stored.export(request, services, "plan", plan_id, format_name, rate)
